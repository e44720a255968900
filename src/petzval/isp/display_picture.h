// SPDX-License-Identifier: BSD-3-Clause
// Developed pictures in files.
#pragma once

#include <petzval/image/formats/jpeg_output.h>
#include <petzval/isp/colour_rendering.h>

#include <string>
#include <vector>

namespace petzval {

/// The extensions that write_display_picture takes.
const std::vector<std::string>& display_picture_extensions();

/// Writes linear light of a display's primaries: .png and .tif with its transfer curve and ICC profile
/// (values outside [0, 1] are cut; 8 or 16 bits; of rec2100_pq .png alone, 16 bits with a chunk cICP, up to
/// 10,000 cd/m²), .png with EXIF where the exposure is known; .jpg the same in 8 bits; .exr (R, G, B) and
/// .npy (rows × columns × 3, float32) linear and uncut; .dng (LinearRaw of 16 bits, which programs that do
/// not know the sensor's mosaic read) linear, cut at 0 and 1. One plane is written as grey, without profile;
/// other numbers of planes than one and three only as .exr and .npy. \throws InputError for another
/// extension, and as the writers; Failure.
void write_display_picture(const std::string& path, const Planes& planes, DisplaySpace space, int bits,
                           const std::string& provenance, const CameraFacts& facts = {});

}  // namespace petzval
