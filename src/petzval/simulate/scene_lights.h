// SPDX-License-Identifier: BSD-3-Clause
// The lights of a three-dimensional scene as a lens sees them.
#pragma once

#include <petzval/flare/scene_sources.h>
#include <petzval/render/world.h>

namespace petzval {

/// Where a lens stands in a scene.
struct LensPlace {
  render::Transform world_from_camera;  ///< the camera looks along +z, x to the right, y up
  double vertex = 0;                    ///< z of the first vertex in its space [scene units]
  double unit_mm = 1000;
};

/// Surfaces that shine and small lamps, each one source of what of it is seen from the first vertex and not
/// more than 80 degrees from the axis: one point after the other of each surface, without chance. Light from
/// all around is none. \param most  of them are kept, those with the most light.
SourcesFound lights_seen(const render::World& world, const LensPlace& place, int most);

/// Whether nothing stands between the first vertex and a source at infinity.
bool is_seen(const render::World& world, const LensPlace& place, const BrightSource& far_source);

}  // namespace petzval
