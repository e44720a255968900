// SPDX-License-Identifier: BSD-3-Clause
// What a camera sees of its scene, and what of that is sharp.
#pragma once

#include <petzval/simulate/depth_of_field.h>
#include <petzval/simulate/frame_view.h>
#include <petzval/simulate/render.h>

namespace petzval {

/// A camera with a lens in front of a three-dimensional scene.
struct Framing {
  double film_width_mm = 0, film_height_mm = 0;
  double efl_mm = 0, f_number = 0, working_f_number = 0;
  FrameView view;            ///< in degrees; NaN where the lens gives the edge of the film no light
  double distance_m = 0;     ///< from the film to what is sharp; infinite for infinity and beyond
  DepthOfField sharp;        ///< blur of at most one pixel
  double lit_circle_mm = 0;  ///< diameter of what the lens lights on the film, up to the film's diagonal
};

/// \throws InputError for a camera without a lens.
Framing framing(const PreparedScene& scene);

/// Whether the lens lights so little of the film that another film, or another lens, is what is wanted: a
/// circle less than half as wide as the film's shorter side.
bool lights_too_little(const Framing& framing);

}  // namespace petzval
