// SPDX-License-Identifier: BSD-3-Clause
// Raw files of cameras, whatever their format.
#pragma once

#include <petzval/sensor/raw_image.h>

#include <string>
#include <vector>

namespace petzval {

/// The extensions of cameras' raw files: ".dng", ".nef", ".cr2", ….
const std::vector<std::string>& camera_raw_extensions();

/// Reads a raw file: a .dng by read_dng(), what that does not take and the files of other cameras by LibRaw,
/// in the helper program petzval-read-raw. Of those files: the visible pixels as the camera stored them,
/// turned or not, one black level, and a matrix for D65. \throws InputError for what neither takes and for
/// damaged files, also where LibRaw crashes or finds no end; Failure.
RawImage read_raw(const std::string& path);

/// The same by LibRaw alone.
RawImage read_camera_raw(const std::string& path);

}  // namespace petzval
