// SPDX-License-Identifier: BSD-3-Clause
// The list of ghosts of lenses that are not round about an axis: rays close beside a real one.
#pragma once

#include <petzval/analysis/ghosts.h>

#include <vector>

namespace petzval {

/// A ghost, and where it lies.
struct PosedGhost {
  Ghost ghost;
  double x_mm = 0,
         y_mm = 0;  ///< of its chief ray on the sensor, from that of the image, in the sensor's axes
};

/// What ghosts() finds by paraxial rays about the axis, by differences of real rays about the chief ray: the
/// ray from the point of the object on the axis through the middle of the stop where light first comes to it.
/// Areas stand for diameters where a ghost is not round, and the place where its light is narrowest for its
/// focus. Transmittances are those of the chief ray. A ghost whose chief ray misses a surface is left out;
/// one whose chief ray an aperture stops has no light in its middle. \throws InputError as ghosts() and
/// GhostTracer, and where no light of the object passes the middle of the stop.
std::vector<PosedGhost> ghosts_about_chief_ray(const Lens& lens, const GhostOptions& options = {});

}  // namespace petzval
