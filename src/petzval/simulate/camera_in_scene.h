// SPDX-License-Identifier: BSD-3-Clause
// Where the camera stands in its scene.
#pragma once

#include <petzval/base/context.h>
#include <petzval/lens/lens.h>
#include <petzval/simulate/prepared_world.h>

#include <optional>

namespace petzval {

/// Puts the camera of a world where the request wants it; where the scene has no camera and the request names
/// no place, so far back that all of the scene is in the picture, which a note tells. \param lens  that it
/// looks through, if any. \throws InputError for a place and an aim that are one, and for a field of view
/// that a lens has.
void place_camera(const RenderRequest& request, const std::optional<Lens>& lens, PreparedWorld& world,
                  const Context& context);

}  // namespace petzval
