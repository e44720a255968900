// SPDX-License-Identifier: BSD-3-Clause
// Pictures as JPEG, with what a camera notes in them.
#pragma once

#include <petzval/image/formats/jpeg.h>

#include <string>

namespace petzval {

/// What a camera writes into its pictures; 0 and empty: not known.
struct CameraFacts {
  double exposure_s = 0, f_number = 0, focal_length_mm = 0, iso = 0;
  std::string camera = {}, lens = {};
};

struct JpegOptions {
  int quality = 95;  ///< 1 to 100, as libjpeg counts
  CameraFacts facts = {};
  std::string description = {};
  bool srgb = true;  ///< whether the colour space of EXIF is sRGB; else that of the profile
};

/// EXIF 2.32, little-endian, from the TIFF header on: description, camera, exposure time, f-number,
/// ISO speed, focal length, lens, colour space, size. Text is cut to 1,000 bytes. No time stamp is written.
std::string exif_of(int columns, int rows, const JpegOptions& options);

/// Writes a picture, baseline, colours at full resolution (4:4:4), with its ICC profile if it has one.
/// \throws InputError for a quality out of range, sizes above 65,500 pixels, and as WholeFile; Failure.
void write_jpeg(const std::string& path, const JpegImage& image, const JpegOptions& options = {});

}  // namespace petzval
