// SPDX-License-Identifier: BSD-3-Clause
// Light on its way through a lens, in two views, as one page that moves.
#pragma once

#include <petzval/analysis/ray_steps.h>
#include <petzval/lens/lens.h>
#include <petzval/report/table.h>

#include <string>
#include <vector>

namespace petzval {

/// One ray of the animation.
struct AnimatedRay {
  std::vector<RayStep> steps;
  std::string colour;  ///< "#rrggbb"
};

/// A page with the lens in the y-z plane and in the x-z plane, in which all rays set out together from a
/// plane in front of the lens at right angles to their beam, and advance at the speed that the index of each
/// glass leaves them: their ends form the wavefront. A table lists every step of the ray `listed`. No script,
/// nothing from outside; where nothing moves (on paper), the rays are whole.
/// \throws InputError without rays, or if a ray has no steps.
std::string ray_animation_html(const Lens& lens, const std::vector<AnimatedRay>& rays, std::size_t listed);

/// A row a surface: point, normal, directions, indices, angles and paths.
Table ray_steps_table(const std::vector<RayStep>& steps);

}  // namespace petzval
