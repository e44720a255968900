// SPDX-License-Identifier: BSD-3-Clause
// Radiance pictures (.hdr), as environment maps come.
#pragma once

#include <petzval/render/textures/picture_file.h>

#include <string_view>

namespace petzval::render {

/// A picture in the format of Ward's Radiance, "Real pixels" (Graphics Gems II, 1991): RGB with a common
/// exponent, rows from the top, with or without run lengths; divided by its EXPOSURE. \param name  for
/// messages. \throws InputError if it is damaged, of XYZE, or lies otherwise.
PictureFile parse_radiance_picture(std::string_view bytes, const std::string& name);

}  // namespace petzval::render
