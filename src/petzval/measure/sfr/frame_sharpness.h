// SPDX-License-Identifier: BSD-3-Clause
// What the edges of one picture say about the lens over the frame.
#pragma once

#include <petzval/measure/sfr/measure_picture.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// Which way an edge blurs, seen from the middle of the frame: across it for edges along circles
/// (meridional), along circles for edges that point to the middle (sagittal), or neither within 30°.
enum class EdgeDirection { meridional, sagittal, oblique };

/// An edge by its place, seen from the middle of the frame.
struct EdgeInFrame {
  double x_px = 0, y_px = 0;  ///< of its middle, right and up
  double height_px = 0;       ///< distance from the middle of the frame
  EdgeDirection direction = EdgeDirection::oblique;
  double outward = 0;  ///< cosine between the normal, dark to bright, and the way out
  double mtf50_cpp = 0, deviation_cpp = 0;
  std::string channel;
  std::optional<double> lateral_offset_px;  ///< MeasuredEdge::lateral_offset_px
};

/// Those whose MTF50 is known. \param columns, rows  of the picture.
std::vector<EdgeInFrame> edges_in_frame(std::span<const MeasuredEdge> edges, int columns, int rows);

/// MTF50 on a grid over the frame, row-major from the top; NaN where no edges are near.
struct SharpnessSurface {
  int columns = 0, rows = 0;
  std::vector<float> mtf50_cpp;
};

/// At each place the plane that fits the edges about it best, those nearer counting more (W. S. Cleveland, J.
/// Am. Stat. Assoc. 74, 829, 1979). \param columns, rows  of the picture. \throws InputError for a picture
/// without pixels.
SharpnessSurface sharpness_surface(std::span<const EdgeInFrame> edges, int columns, int rows);

/// MTF50 at `heights_px` by straight lines fitted in the same way; NaN where no edges are near.
std::vector<double> sharpness_over_height(std::span<const EdgeInFrame> edges,
                                          std::span<const double> heights_px);

/// How far a colour's picture lies from green's, outwards: linear · h + cubic · h³ over the half diagonal h
/// = 1.
struct LateralColour {
  double linear_px = 0, cubic_px = 0;
  double rms_residual_px = 0;
  std::size_t edges = 0;
  double at(double share_of_half_diagonal) const {
    const double h = share_of_half_diagonal;
    return h * (linear_px + h * h * cubic_px);
  }
};

/// From all edges of a channel, each of which sees the part of it along its normal; nothing with fewer than
/// four.
std::optional<LateralColour> lateral_colour(std::span<const EdgeInFrame> edges, const std::string& channel,
                                            double half_diagonal_px);

}  // namespace petzval
