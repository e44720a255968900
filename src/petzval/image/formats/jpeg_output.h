// SPDX-License-Identifier: BSD-3-Clause
// Pictures as JPEG, with what a camera notes in them.
#pragma once

#include <petzval/image/camera_facts.h>
#include <petzval/image/formats/jpeg.h>

#include <string>

namespace petzval {

struct JpegOptions {
  int quality = 95;  ///< 1 to 100, as libjpeg counts
  CameraFacts facts = {};
  std::string description = {};
  bool srgb = true;  ///< whether the colour space of EXIF is sRGB; else that of the profile
};

/// EXIF 2.32, little-endian, from the TIFF header on: description, camera, exposure time, f-number,
/// ISO speed, focal length, lens, date and time, colour space, size. Text is cut to 1,000 bytes.
std::string exif_of(int columns, int rows, const JpegOptions& options);

/// Writes a picture, baseline, colours at full resolution (4:4:4), with its ICC profile if it has one.
/// \throws InputError for a quality out of range, sizes above 65,500 pixels, and as WholeFile; Failure.
void write_jpeg(const std::string& path, const JpegImage& image, const JpegOptions& options = {});

}  // namespace petzval
