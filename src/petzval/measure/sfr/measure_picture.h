// SPDX-License-Identifier: BSD-3-Clause
// Spatial frequency responses of the edges in a picture.
#pragma once

#include <petzval/base/context.h>
#include <petzval/measure/sfr/edge_samples.h>
#include <petzval/measure/sfr/iso_esfr.h>
#include <petzval/measure/sfr/measure_edge.h>
#include <petzval/measure/sfr/picture_planes.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

struct SfrRequest {
  std::vector<PixelBox> rois = {};    ///< one edge each; empty: every straight edge that stands out
  std::string channel = "luminance";  ///< "luminance", "red", "green", "blue" or "all"
  std::string bayer = {};  ///< "rggb", "bggr", "grbg" or "gbrg": the picture is a mosaic, each colour for
                           ///< itself; empty: as it says
  int edge_order = 0;      ///< as in SfrOptions
  bool iso = false;        ///< iso_esfr() too
  /// Width and height [mm] of the printed chart (printed_chart) that the picture shows; absent: of none.
  std::optional<std::array<double, 2>> chart_mm = {};
};

/// Where an edge stands on the chart.
struct EdgeOnChart {
  double x_mm = 0, y_mm = 0;  ///< its middle, from the upper left corner
  double per_mm = 0;          ///< cycles per mm across it for each cycle per pixel in the picture
};

struct MeasuredEdge {
  std::string channel;  ///< empty for luminance
  PixelBox roi;
  EdgeMeasurement exact;
  std::optional<IsoEsfr> iso;                ///< if that was asked for
  std::optional<double> lateral_offset_px;   ///< from green, along the normal, with all channels
  std::optional<EdgeOnChart> on_chart = {};  ///< with SfrRequest::chart_mm

  const std::vector<double>& frequencies() const {
    return iso ? iso->frequencies_cpp : exact.frequencies_cpp;
  }
  const std::vector<double>& sfr() const { return iso ? iso->sfr : exact.sfr; }
  double mtf50() const { return iso ? iso->mtf50_cpp : exact.mtf50().frequency_cpp; }
  double angle_deg() const { return iso ? iso->angle_deg : exact.line.angle_deg(); }
};

/// The edges in the order of the ROIs, or in which they are found; the channels of each one after the other.
/// Of edges that are found, those that cannot be measured are left out, with a note. \param name  of the
/// picture, for messages. \throws InputError when there is no edge to be measured, for an ROI without one,
/// for a channel that the picture has not, and where the
/// marks of a chart are not seen; Cancelled.
std::vector<MeasuredEdge> measure_sfr(const PicturePlanes& picture, const SfrRequest& request = {},
                                      const std::string& name = "the picture", const Context& context = {});

}  // namespace petzval
