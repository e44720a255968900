// SPDX-License-Identifier: BSD-3-Clause
// Developed pictures in linear light, for digital negatives.
#pragma once

#include <petzval/isp/colour_rendering.h>
#include <petzval/sensor/formats/linear_dng.h>

#include <string>

namespace petzval {

/// Three planes of light of a display's primaries in 16 bits, cut at 0 and 1.
LinearPicture linear_picture(const Planes& planes, DisplaySpace space, const std::string& provenance,
                             const CameraFacts& facts);

}  // namespace petzval
