// SPDX-License-Identifier: BSD-3-Clause
// From the sums of a film to a picture without most of its noise.
#pragma once

#include <petzval/render/film/film.h>
#include <petzval/render/passes.h>

namespace petzval::render {

/// Puts the light of both halves of a film, denoised (film/denoise.h), in the place of a picture's light;
/// says so in it. A film that has but one pass leaves the picture as it is. \param picture  of the film's
/// window. \throws Cancelled.
void denoise_picture(const Film& film, const WavelengthGroups& groups, const Passes& passes,
                     Rendering& picture);

}  // namespace petzval::render
