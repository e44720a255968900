// SPDX-License-Identifier: BSD-3-Clause
// Meridional rays for drawings, and clear apertures solved from the fields.
#pragma once

#include <petzval/analysis/field_tracer.h>

#include <array>
#include <vector>

namespace petzval {

/// Points (z, y) of one meridional ray [mm] at every surface and the image, in lens space.
using MeridionalPath = std::vector<std::array<double, 2>>;

/// `count` rays of a field across its vignetted pupil in the y-z plane, from rim to rim (one: the chief ray),
/// each beginning `lead_mm` in front of vertex 1 (or at a nearer object; light from the side or from behind
/// twice as far from the lens). Empty where no ray passes.
std::vector<MeridionalPath> meridional_fan(FieldTracer& tracer, double object_field, int count,
                                           double lead_mm);

/// The lens with every missing clear semi-diameter set to what the rays of its own fields and wavelengths
/// through the full stop need. \throws InputError if a field of the lens has no chief ray.
Lens with_apertures_from_fields(Lens lens);

}  // namespace petzval
