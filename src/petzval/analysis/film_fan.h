// SPDX-License-Identifier: BSD-3-Clause
// Rays from a point of the film out through the lens, for drawings.
#pragma once

#include <petzval/trace/tracer.h>

#include <array>
#include <vector>

namespace petzval {

/// Which rays of a film point, and from which side they are drawn.
enum class FilmSection {
  meridional,  ///< in the plane through the axis and the point, seen from the side: points (z, y)
  sagittal     ///< across it, through the middle of the meridional ones, seen from above: points (z, x)
};

/// Points of one ray [mm], from the object side to the film, in lens space.
using FilmRay = std::vector<std::array<double, 2>>;

/// `count` rays that pass, from rim to rim evenly in direction cosine, of a film point at (0, height_mm).
/// Each begins `lead_mm` in front of surface 0. The rims are found on 4,000 directions, then by halving;
/// parts of a pupil that lie apart count as one. Empty where no light arrives.
std::vector<FilmRay> film_fan(const Tracer& tracer, double height_mm, FilmSection section, int count,
                              double lead_mm);

}  // namespace petzval
