// SPDX-License-Identifier: BSD-3-Clause
// A picture file as planes that are linear in light.
#pragma once

#include <petzval/measure/sfr/edge_samples.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

enum class PictureTransfer {
  stated,  ///< as the file says; sRGB where a JPEG, a PNG or an integer TIFF says nothing
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
  std::vector<double> code_levels = {};
  /// Of a JPEG, what the coefficients of blocks are rounded to (RoundedBlocks); empty for other formats.
  std::vector<int> coefficient_steps = {};

  /// Of a mosaic the letters of its two rows, "rggb" and so on; empty for full planes.
  std::string bayer = {};
  int bits = 0;          ///< of a sample, in formats of whole numbers; else 0
  bool srgb = false;     ///< the code values were taken for sRGB's, else for linear light
  bool assumed = false;  ///< neither the file nor the caller said which

  /// 0.2126 R + 0.7152 G + 0.0722 B for RGB, the mean of the planes else.
  Plane luminance() const;
};

/// The names of files that read_picture_planes() takes: ".png" and so on.
const std::vector<std::string>& measurable_extensions();

/// Reads .png, .jpg, .tif, .npy (rows × columns or rows × columns × bands), .exr (spectral), .dng or another
/// raw file (read_raw), as they are stored, not turned upright. Alpha and colour profiles are left aside. Raw
/// files are linear between their black level, 0, and their white level, 1. \param demosaic  a mosaic becomes
/// full planes of the sensor's colours by usual_demosaic_method(); else it stays one plane, and must be a
/// Bayer mosaic. \throws InputError for another extension, shape or mosaic, values that are not finite, and
/// as the readers.
PicturePlanes read_picture_planes(const std::string& path, PictureTransfer transfer = PictureTransfer::stated,
                                  bool demosaic = false);

}  // namespace petzval
