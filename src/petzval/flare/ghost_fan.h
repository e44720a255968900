// SPDX-License-Identifier: BSD-3-Clause
// Rays of one ghost, for drawings.
#pragma once

#include <petzval/flare/ghost_way.h>
#include <petzval/flare/source_beam.h>

#include <array>
#include <vector>

namespace petzval {

/// Points (z, y) of one ray [mm], from the object side to the sensor, in lens space.
using GhostRay = std::vector<std::array<double, 2>>;

/// `count` rays of a source in the y-z plane that pass on the way of a pair, from rim to rim evenly where
/// they cross the plane of the first vertex. Each begins `lead_mm` in front of it. The rims are found on
/// 2,000 rays; parts that lie apart count as one. Empty where none passes.
std::vector<GhostRay> ghost_fan(const GhostTracer& tracer, const GhostPair& pair, const SourceBeam& beam,
                                int count, double lead_mm);

}  // namespace petzval
