// SPDX-License-Identifier: BSD-3-Clause
// The lens files of pbrt's realistic camera: rows "radius thickness index-after aperture-diameter", front to
// back.
#pragma once

#include <petzval/lens/lens_file.h>

#include <string>

namespace petzval {

/// \param file  for error messages.
LensFile read_pbrt(const std::string& text, const std::string& file);

/// \throws InputError for what a row cannot say: dispersion, aspheres, flat glass, a stop on glass, no
/// aperture.
std::string pbrt_text(const Lens& lens);

}  // namespace petzval
