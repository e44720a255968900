// SPDX-License-Identifier: BSD-3-Clause
// The layout of a lens in the y-z plane, as SVG.
#pragma once

#include <petzval/lens/lens.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// A meridional ray as it is drawn: points (z, y) in lens space [mm], from the object side to the image. A
/// point that is not finite breaks the line.
struct DrawnRay {
  std::vector<std::array<double, 2>> zy_mm;
  std::string colour{};  ///< "#rrggbb", by field or by wavelength; empty: ink
  /// A class of its own for the line, whose length then counts as 1: a handle for the style of a page.
  std::string style_class{};
};

struct LegendLabel {
  std::string text, colour;
};

struct LensDrawingOptions {
  std::string title;
  std::vector<LegendLabel> legend;  ///< what the colours of the rays mean
  double width_px = 900, tallest_px = 560;
  std::optional<double> px_per_mm;  ///< in place of a size
  bool surface_numbers = true;      ///< counted from 0, as in `surfaces[0]` of the lens file and of --set
  /// For surfaces whose clear aperture the lens does not give, by surface; 0 or missing: see
  /// drawn_semi_diameters_mm.
  std::vector<double> semi_diameters_mm;
  std::optional<double> image_half_height_mm;  ///< absent: where the rays end
  double azimuth_deg = 0;                      ///< of the y-z plane that is drawn, as FieldTracer has it
  std::optional<double> lead_mm;  ///< object space shown in front of the lens; absent: a fifth of it
};

/// How far from the axis each surface is drawn [mm]: the clear semi-diameter of the lens; else that of the
/// options; else what the rays need and 4 % more (the stop: exactly what they need); else that of the nearest
/// surface that has one. Never beyond the rim of a sphere.
std::vector<double> drawn_semi_diameters_mm(const Lens& lens, const std::vector<DrawnRay>& rays,
                                            const LensDrawingOptions& options);

/// Glass filled between its two surfaces, their rims joined at the larger of both semi-diameters; the stop,
/// the axis, the image surface, the rays, surface numbers and a scale bar in mm.
///
///     LensDrawingOptions options;
///     options.title = lens.name;
///     write_whole_file("layout.svg", draw_lens(lens, rays, options));
///
/// \throws InputError if the lens has no surfaces.
std::string draw_lens(const Lens& lens, const std::vector<DrawnRay>& rays,
                      const LensDrawingOptions& options = {});

/// A lens in one of its states, as draw_lens() takes it.
struct DrawnState {
  Lens lens;
  std::vector<DrawnRay> rays;
  LensDrawingOptions options;
};

/// States beneath each other, at one scale, their sensors in one line. \throws InputError without any.
std::string draw_states(const std::vector<DrawnState>& states);

}  // namespace petzval
