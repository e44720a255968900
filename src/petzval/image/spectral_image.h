// SPDX-License-Identifier: BSD-3-Clause
// The waist of the program: everything above makes a SpectralImage, everything below reads it.
#pragma once

#include <petzval/base/large_floats.h>
#include <petzval/colour/spectrum.h>
#include <petzval/image/camera_facts.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// What a pixel value stands for: the irradiance at the pixel's centre, its mean over a square of one pitch,
/// or its mean over the photosite of the sensor that it is made for.
enum class PixelAperture { point, box, photosite };

/// Spectral irradiance on the sensor [W·m⁻²·nm⁻¹]: `bands` planes of `rows` × `columns`, upright (the optical
/// inversion is undone), row 0 on top, pixel centres at half-integers. With image-space x', y' of the real
/// (inverted) image and pitch p: column = columns/2 − x'/p, row = rows/2 + y'/p.
class SpectralImage {
 public:
  /// 8 GiB of values; more is refused before anything is allocated.
  static constexpr std::size_t max_values = std::size_t{1} << 31;

  SpectralImage() = default;
  /// All zero. \throws InputError on sizes below 1, wavelengths that do not increase, a pitch that is not
  /// positive, or more than `max_values` values.
  SpectralImage(int columns, int rows, std::vector<double> wavelengths_nm, double pitch_um,
                PixelAperture aperture = PixelAperture::box);

  /// \throws InputError for sizes and wavelengths that no image has: what the constructor refuses.
  static void check(int columns, int rows, const std::vector<double>& wavelengths_nm, double pitch_um);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int bands() const { return static_cast<int>(wavelengths_nm_.size()); }
  const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }
  double pitch_um() const { return pitch_um_; }
  PixelAperture pixel_aperture() const { return aperture_; }
  std::size_t band_size() const {
    return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  }

  /// One plane, row-major, [W·m⁻²·nm⁻¹].
  std::span<float> band(int index);
  std::span<const float> band(int index) const;
  /// Puts a plane in its place, without the memory that band() takes of a large image.
  /// \throws InputError if it has another size.
  void store_band(int index, std::span<const float> plane);
  /// Gives up a band of a large image, whose values are kept in a file, and the room that it takes; it is not
  /// to be looked at again. \throws InputError if there is no such band.
  void give_up_band(int index);
  float& at(int band_index, int row, int column);
  float at(int band_index, int row, int column) const;
  /// All planes, one after the other.
  std::span<const float> values() const { return values_.all(); }
  /// Between bands or rows of a large image, whose values are kept in a file (LargeFloats): gives back the
  /// memory that those seen so far take.
  void release_memory() const { values_.release_memory(); }

  /// \throws InputError at the first value that is NaN or infinite, naming band, row and column. (A transform
  /// may leave −1e-9 where there is no light: negative values are no fault.)
  void validate() const;

  /// How the picture came about, in one line; stored in files.
  std::string provenance;
  /// What the photosite is like (Photosite::text), if the pixel aperture is one.
  std::string photosite;
  /// What else is known of it; stored in files.
  std::optional<LensFacts> lens;
  std::optional<Spectrum> illuminant = {};  ///< the light of the scene, on any scale
  /// 1 for pixels that show a lamp of the scene itself, by which nobody meters. Empty: none, or not known.
  std::vector<std::uint8_t> lamps = {};

 private:
  int columns_ = 0, rows_ = 0;
  std::vector<double> wavelengths_nm_;
  double pitch_um_ = 0;
  PixelAperture aperture_ = PixelAperture::box;
  LargeFloats values_;
};

}  // namespace petzval
