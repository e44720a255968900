// SPDX-License-Identifier: BSD-3-Clause
// g_sensor by counting rays: slow, simple, and a check on the pupil's boundary.
#pragma once

#include <petzval/trace/tracer.h>

namespace petzval {

/// n'² ∬ dα dβ over the backward directions from an image point that pass every aperture [sr], by tracing a
/// grid of `rays_a_side`² directions over the whole hemisphere and counting. Knows nothing of chief rays,
/// stops or pupils. Error about 2·rays_a_side^−1.5 relative to a solid angle of a fifth of a steradian.
double counted_g_sensor_sr(const Tracer& tracer, double image_height_mm, int rays_a_side,
                           Tracer::Clip clip = Tracer::Clip::apertures);

}  // namespace petzval
