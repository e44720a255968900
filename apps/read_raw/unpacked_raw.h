// SPDX-License-Identifier: BSD-3-Clause
// A camera's raw file as LibRaw unpacks it.
#pragma once

#include <petzval/sensor/raw_image.h>

#include <string>

namespace petzval {

/// The visible pixels as they are stored, the black levels of the colours made one, with the camera's matrix
/// for D65 where LibRaw knows it. \throws InputError for a file that LibRaw does not take, or without one
/// number a pixel.
RawImage unpacked_raw(const std::string& path);

}  // namespace petzval
