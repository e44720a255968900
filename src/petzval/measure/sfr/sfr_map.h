// SPDX-License-Identifier: BSD-3-Clause
// What `sfr` has measured over a picture, as other parts of the program take it up again.
#pragma once

#include <petzval/measure/sfr/measure_picture.h>

#include <array>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// One edge of a map: where it stands, which way it blurs, and what is left of contrast.
struct MapEdge {
  double x_px = 0, y_px = 0;  ///< its middle, from the upper left corner of the picture
  double normal_rad = 0;      ///< direction from dark to bright, from +x towards +y
  double half_length_px = 0;
  std::string channel = {};  ///< empty for luminance
  double mtf50_cpp = 0;
  /// Contrast at some frequencies [cycles/pixel], and standard deviations of it.
  std::vector<double> frequencies_cpp = {}, contrast = {}, deviation = {};
  /// Correlations of their errors, row-major; empty: they are independent.
  std::vector<double> correlation = {};
};

/// The edges of one picture.
struct SfrMap {
  std::string picture = {};
  int columns = 0, rows = 0;
  std::vector<MapEdge> edges = {};
};

/// The edges whose MTF50 is known: contrast at MTF80, MTF50 and MTF20 with the stated deviations and their
/// correlations, or at MTF50 alone where one of the others is not reached.
SfrMap sfr_map(std::span<const MeasuredEdge> edges, int columns, int rows, const std::string& picture = {});

/// Reads what `petzval sfr --json` prints: one map for each of its pictures. An edge has to state `line`
/// (`x_px`, `y_px`, `normal_deg` and, unless 0, `half_length_px`), and either a curve (`frequencies_cpp`,
/// `sfr`, `sfr_deviation`) or `mtf50_cpp` and `mtf50_deviation_cpp`; other keys are passed over. \throws
/// InputError naming the file, the edge and what would be right.
std::vector<SfrMap> read_sfr_maps(const std::string& path);
/// The same of a text. \param name  of it, for messages.
std::vector<SfrMap> parse_sfr_maps(const std::string& text, const std::string& name);

}  // namespace petzval
