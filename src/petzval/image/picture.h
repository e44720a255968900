// SPDX-License-Identifier: BSD-3-Clause
// From irradiance on the sensor to a picture that a person can look at.
#pragma once

#include <petzval/colour/display.h>
#include <petzval/colour/spectrum.h>
#include <petzval/image/formats/png.h>
#include <petzval/image/picture_inset.h>
#include <petzval/image/spectral_image.h>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// A frame drawn into a picture: its outermost pixels [left, right) × [top, bottom), in yellow.
struct PictureFrame {
  int left = 0, top = 0, right = 0, bottom = 0;

  bool holds(int column, int row) const {
    return column >= left && column < right && row >= top && row < bottom;
  }
  bool is_on_rim(int column, int row) const {
    return holds(column, row) && (column == left || column + 1 == right || row == top || row + 1 == bottom);
  }
};

/// Linear red, green and blue of frames.
inline constexpr std::array<float, 3> frame_colour = {1, 0.8F, 0};

/// How irradiance becomes sRGB. The level of a pixel is its illuminance [lx] (683 lm/W · Y of its
/// irradiance); in an image without visible light (all bands outside 370 to 730 nm) it is its irradiance
/// [W·m⁻²]. Pixels that show a lamp of the scene (SpectralImage::lamps) are not metered, unless there is no
/// other.
struct PictureOptions {
  enum class Exposure {
    /// The level that `percentile` % of the pixels do not exceed becomes white; of lights in darkness, which
    /// fill less than a quarter of the picture, `percentile` % of the lit pixels.
    percentile,
    mean_grey,  ///< the mean level becomes `grey` times white
    fixed       ///< the level `white_level` becomes white
  };
  Exposure exposure = Exposure::percentile;
  double percentile = 99.5;
  /// Of lights in darkness: how bright the darkness may be beside the brightest pixel.
  double dark_share = 1e-5;
  double grey = 0.18;
  double white_level = 0;
  double compensation_ev = 0;  ///< +1 halves the level that is shown as white

  /// How levels below white are shown. The light of a star falls by thousands within a few pixels: `gamma`
  /// shows the square root of a level, `log` its logarithm, three decades from black to white, evenly in the
  /// values of the picture.
  enum class Display { linear, gamma, log };
  Display display = Display::linear;

  /// Spectrum of the light of the scene, on any scale: a white surface under it is shown as display white, by
  /// Bradford adaptation. It is taken at the wavelengths of the image, so that the white is right for few
  /// bands too. Without it nothing is adapted: light of D65 is white.
  std::optional<Spectrum> scene_white = {};

  /// An image of a single band has no colour but that of the band. It is shown in grey, or, if this is set,
  /// in the colour of the wavelength as far as sRGB can show it (what lies outside the gamut is clipped).
  bool monochrome_in_colour = false;

  /// An image without visible light is shown in grey, from nothing to the white level, or, if this is set, in
  /// false colours (ColourMap::inferno). With the exposure `percentile` these run from the level that
  /// 100 − percentile % of the pixels do not reach: a warm scene has little contrast over much light.
  bool false_colour = false;

  std::vector<PictureFrame> frames = {};  ///< drawn over the picture
  std::vector<PictureInset> insets = {};  ///< drawn beside it by srgb_picture() and write_picture()
};

/// An image made ready to be shown: the exposure is settled, rows come out one by one. It refers to the
/// image.
class PictureRenderer {
 public:
  /// \throws InputError for NaN in the image, options out of range, or a scene white that no eye takes for
  /// white.
  PictureRenderer(const SpectralImage& image, const PictureOptions& options);

  /// The level that is shown as white; 1 for an image without light.
  double white_level() const { return white_level_; }
  /// In one line: "white is 12.3 lx, the 99.5th percentile".
  const std::string& description() const { return description_; }
  /// Linear sRGB of one row, not clipped.
  void linear_row(int row, std::span<LinearRgb> pixels) const;

 private:
  void level_row(int row, std::span<float> levels) const;
  double level_for(const PictureOptions& options, std::vector<float> levels);

  const SpectralImage& image_;
  bool visible_ = true, grey_ = false, false_colour_ = false;
  std::vector<PictureFrame> frames_;
  std::vector<Xyz> weights_;  ///< of each band, in the unit of the level
  ColourMatrix display_from_xyz_{};
  PictureOptions::Display display_ = PictureOptions::Display::linear;
  double white_level_ = 1;
  double black_level_ = 0;  ///< of false colours
  std::string description_;
};

/// The whole picture with its insets, sRGB-encoded, clipped (display.h) and rounded to `bits` = 8 or 16.
PngImage srgb_picture(const SpectralImage& image, const PictureOptions& options = {}, int bits = 8);

/// Writes it as PNG, row by row, with exposure and provenance in its text chunks.
/// \returns the description of the exposure.
std::string write_picture(const std::string& path, const SpectralImage& image,
                          const PictureOptions& options = {}, int bits = 8);

}  // namespace petzval
