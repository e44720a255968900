// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_states.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/scaled_lens.h>
#include <petzval/lens/surface_shape.h>

#include <cmath>

namespace petzval {

Lens scaled_lens(Lens lens, double factor) {
  if (!lens.states.empty())
    return in_every_state(lens, [&](const Lens& each) { return scaled_lens(each, factor); });
  if (!(factor > 0) || !std::isfinite(factor))
    throw InputError(fmt::format("a scale factor of {}; it must be positive", factor));
  require_glass(lens, "scaling needs");
  const auto scale = [&](Pose& pose) {
    for (const PoseNumber& number : pose_numbers)
      if (number.is_length) pose.*number.value *= factor;
  };
  for (Surface& surface : lens.surfaces) {
    surface = scaled_surface(std::move(surface), factor);
    scale(surface.pose);
  }
  for (SurfaceGroup& group : lens.groups) {
    scale(group.pose);
    group.pivot_mm *= factor;
  }
  scale(lens.sensor_pose);
  if (lens.object_distance_mm) *lens.object_distance_mm *= factor;
  if (lens.aperture.kind == Aperture::Kind::entrance_pupil_diameter_mm ||
      lens.aperture.kind == Aperture::Kind::stop_semi_diameter_mm)
    lens.aperture.value *= factor;
  if (lens.fields.kind != Fields::Kind::angle_deg)
    for (double& field : lens.fields.values) field *= factor;
  lens.validate();
  return lens;
}

}  // namespace petzval
