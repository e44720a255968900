// SPDX-License-Identifier: BSD-3-Clause
// Small matrices as pictures: point-spread functions, irradiance maps.
#pragma once

#include <petzval/report/colours.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace petzval {

struct HeatMapOptions {
  ColourMap map = ColourMap::inferno;
  /// Value of the darkest colour; absent: 0, or the smallest value if that is below 0.
  std::optional<double> black{};
  /// Value of the lightest colour; absent: the largest value.
  std::optional<double> white{};
  /// Colour = ((value − black)/(white − black))^(1/gamma): 2 lifts faint wings.
  double gamma = 1;
  bool first_row_on_top = true;
};

/// A matrix (row-major, rows × columns) as PNG bytes, one pixel a value; values that are not finite are grey.
/// \throws InputError unless the sizes agree, or if gamma is not positive.
std::string heat_map_png(std::span<const float> values, int columns, int rows,
                         const HeatMapOptions& options = {});

/// One frame of a strip.
struct StripFrame {
  std::string png;
  std::string caption;  ///< beneath the frame; '\n' begins a second line
};

struct ImageStripOptions {
  double frame_px = 120;
  int frames_per_row = 8;
  double frame_width = 0;  ///< what the width of a frame stands for, for the scale bar; 0: no bar
  std::string unit{};      ///< of frame_width: "µm"
};

/// Square frames side by side, pixels unsmoothed, with a scale bar in the first one, as SVG.
std::string image_strip_svg(const std::vector<StripFrame>& frames, const ImageStripOptions& options,
                            const std::string& description);

}  // namespace petzval
