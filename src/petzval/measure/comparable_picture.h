// SPDX-License-Identifier: BSD-3-Clause
// What files of different formats have in common when pictures are compared.
#pragma once

#include <petzval/base/large_floats.h>

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

namespace petzval {

/// Numbers on a grid of pixels, with as much about their meaning as the file says.
struct ComparablePicture {
  std::string name;  ///< for messages
  int columns = 0, rows = 0;
  std::size_t bands = 0;
  std::vector<double> wavelengths_nm;  ///< of the bands; empty if the file does not say
  std::string units;                   ///< empty if the file does not say
  double pitch_um = 0;                 ///< 0 if the file does not say
  bool display = false;                ///< PNG, TIFF, JPEG: values are code values over full scale
  /// Plane after plane, or, if `interleaved`, pixel after pixel.
  std::variant<LargeFloats, std::vector<double>> values;
  bool interleaved = false;

  std::size_t pixels() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  double at(std::size_t band, std::size_t pixel) const {
    const std::size_t index = interleaved ? pixel * bands + band : band * pixels() + pixel;
    const auto* floats = std::get_if<LargeFloats>(&values);
    return floats != nullptr ? double(floats->all()[index]) : std::get<std::vector<double>>(values)[index];
  }
};

/// Reads .exr (spectral), .npy (rows × columns or rows × columns × bands), .png, .tif or .jpg.
/// \throws InputError for another extension, another shape, values that are not finite, and as the readers.
ComparablePicture read_comparable_picture(const std::string& path);

/// Leaves the last channel of a picture for display out, if it is an opacity (of two channels or four) and
/// full everywhere. \returns whether it did.
bool drop_full_opacity(ComparablePicture& picture);

}  // namespace petzval
