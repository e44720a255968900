// SPDX-License-Identifier: BSD-3-Clause
// A board to paint charts on, in reflectances.
#pragma once

#include <petzval/scene/scene.h>
#include <petzval/scene/shape.h>

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// Size, colours and light of a chart.
struct ChartOptions {
  int columns = 768, rows = 576;
  std::vector<double> wavelengths_nm;  ///< empty: 400 to 700 nm every 10 nm
  double horizontal_angle_deg = 40;
  std::optional<double> distance_m;          ///< absent: at infinity
  std::string illuminant = "D65";            ///< a name or file, as petzval::illuminant() takes it
  double mean_luminance_cd_m2 = 100;         ///< of the whole chart, over its whole spectrum
  std::optional<double> band_width_nm = {};  ///< as band_light() takes it
};

/// Wavelengths from one to another [nm]; all unless told.
struct WavelengthRange {
  double from = 0, to = std::numeric_limits<double>::infinity();
};

/// A reflectance at the wavelengths of a canvas, and what the eye sees of it under the canvas's light.
struct Paint {
  std::vector<float> reflectance;
  float luminous_reflectance = 0;
  WavelengthRange known_nm;  ///< where the reflectance was measured; beyond it is that of the nearest end
};

/// A chart in the making: a scene whose bands hold reflectances until it is lit. Shapes are painted one over
/// the other; a pixel that a shape covers in part becomes a mixture by area. A ground with shapes on it is
/// kept as the scene's drawing(), too.
class ChartCanvas {
 public:
  /// Black. \throws InputError as Scene, for an unknown illuminant, or one without light at any of the
  /// wavelengths.
  explicit ChartCanvas(const ChartOptions& options);

  int columns() const { return scene_.columns(); }
  int rows() const { return scene_.rows(); }

  Paint paint(const Spectrum& reflectance) const;
  /// The same reflectance at all wavelengths.
  Paint flat_paint(double reflectance) const;

  void fill(const Paint& paint);
  void draw(const Shape& shape, const Paint& paint);
  /// Sets every pixel to `paint` times a factor: factor(row, factors of the row's pixels).
  void modulate(const Paint& paint, const std::function<void(int row, std::span<double> factors)>& factor);

  /// The scene: reflectance × band_light(), the illuminant so strong that the mean luminance is what the
  /// options say. The level is found from the whole visible spectrum, whichever wavelengths are asked for; of
  /// light that no eye sees it is invisible_level(). A note names the bands for which a reflectance was not
  /// measured.
  /// \throws InputError if all is black.
  Scene lit() &&;

 private:
  void use(const Paint& paint);
  void set_ground(const Paint& paint, const std::function<void(int row, std::span<double> factors)>& factor);
  void mix(const Shape& shape, const Paint& paint);
  void note_unmeasured_bands();

  ChartOptions options_;
  Spectrum illuminant_;
  std::vector<double> light_;  ///< in the bands
  Spectrum seen_;              ///< the illuminant times ȳ, every nanometre
  Scene scene_;
  std::vector<float> luminous_reflectance_;
  WavelengthRange known_nm_;  ///< of all paints used
  SceneDrawing drawing_;      ///< in reflectances
};

}  // namespace petzval
