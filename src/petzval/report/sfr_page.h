// SPDX-License-Identifier: BSD-3-Clause
// What the edges of a picture say, drawn and as a page to print.
#pragma once

#include <petzval/measure/sfr/frame_sharpness.h>
#include <petzval/measure/sfr/picture_planes.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// One measured picture.
struct SfrPage {
  std::string title;  ///< of the picture
  int columns = 0, rows = 0;
  std::optional<double> pitch_um;
  std::vector<MeasuredEdge> edges;
  std::string annotated_svg;  ///< the picture with its edges; may be empty
};

/// The picture with its edges and the MTF50 of each [cycles/pixel]. \param luminance  linear, 0 to 1.
std::string annotated_edges_svg(const std::vector<MeasuredEdge>& edges, const Plane& luminance);

/// MTF50 over the frame: across circles, along them, and of all edges, as pictures with the edges in them.
std::string sharpness_map_svg(const SfrPage& page);
/// MTF50 over the image height: edges and the line through them, meridional and sagittal.
std::string sharpness_profile_svg(const SfrPage& page);
/// Where red and blue lie from green over the image height; empty without colours.
std::string lateral_colour_svg(const SfrPage& page);

/// A page of all that: numbers, map, profile, lateral colour, curves, and a table of the edges.
std::string sfr_page_html(const SfrPage& page);

}  // namespace petzval
