// SPDX-License-Identifier: BSD-3-Clause
// A picture file as planes that are linear in light.
#pragma once

#include <petzval/measure/sfr/edge_samples.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

enum class PictureTransfer {
  stated,  ///< as the file says; sRGB where a PNG or an integer TIFF says nothing
  srgb,
  linear
};

struct PicturePlanes {
  int columns = 0, rows = 0;
  std::vector<Plane> planes;  ///< one, or red, green and blue, or one a wavelength
  bool rgb = false;
  /// Values at which the file's numbers end; only formats with whole numbers have them.
  std::optional<double> clip_low, clip_high;
  /// The light of each of their code values; empty for other formats.
  std::vector<double> code_levels;

  /// 0.2126 R + 0.7152 G + 0.0722 B for RGB, the mean of the planes else.
  Plane luminance() const;
};

/// Reads .png, .tif, .npy (rows × columns or rows × columns × bands) or .exr (spectral). Alpha is left aside.
/// \throws InputError for another extension or shape, values that are not finite, and as the readers.
PicturePlanes read_picture_planes(const std::string& path,
                                  PictureTransfer transfer = PictureTransfer::stated);

}  // namespace petzval
