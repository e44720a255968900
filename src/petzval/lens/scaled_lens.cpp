// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/scaled_lens.h>

#include <cmath>

namespace petzval {

Lens scaled_lens(Lens lens, double factor) {
  if (!(factor > 0) || !std::isfinite(factor))
    throw InputError(fmt::format("a scale factor of {}; it must be positive", factor));
  for (Surface& surface : lens.surfaces) {
    surface.curvature_per_mm /= factor;
    surface.thickness_mm *= factor;
    if (surface.semi_diameter_mm) *surface.semi_diameter_mm *= factor;
    for (auto& [power, coefficient] : surface.asphere) coefficient *= std::pow(factor, 1 - power);
  }
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
