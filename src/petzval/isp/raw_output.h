// SPDX-License-Identifier: BSD-3-Clause
// Raw images in files that other programs develop, whatever the mosaic.
#pragma once

#include <petzval/sensor/raw_image.h>

#include <string>

namespace petzval {

/// As write_raw(). A .dng of a mosaic that other programs do not know (neither Bayer's nor X-Trans) holds a
/// picture in linear light for them, and the mosaic as the original raw file, which read_dng() reads.
/// \throws as write_raw().
void write_raw_output(const std::string& path, const RawImage& raw);

}  // namespace petzval
