// SPDX-License-Identifier: BSD-3-Clause
// Raw images in files, the format chosen by the extension.
#pragma once

#include <petzval/sensor/raw_image.h>

#include <string>
#include <vector>

namespace petzval {

/// The extensions that write_raw takes.
const std::vector<std::string>& raw_extensions();

/// Writes .dng (with everything that is known of the image), .tif (16 bits, as stored), .npy (float32, rows ×
/// columns) or .exr (channel Y, float32), the latter two in linear values: black level and gain are
/// attributes of the .exr. \throws InputError for another extension, and as the writers; Failure.
void write_raw(const std::string& path, const RawImage& raw);

}  // namespace petzval
