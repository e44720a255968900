// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_states.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/reversed_lens.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

Lens reversed_lens(const Lens& lens) {
  if (!lens.states.empty()) return in_every_state(lens, reversed_lens);
  lens.validate();
  require_glass(lens, "turning it round needs");
  require_no_bends(lens, "turning it round needs");
  require_centred(lens, "centred lenses can be turned round");
  require_no_mirrors(lens, "lenses without one can be turned round");
  if (!lens.surfaces.back().material.is_air() || !lens.object_material.is_air())
    throw InputError(
        fmt::format("{}: glass reaches up to the sensor or the object; a lens with air on both sides can be "
                    "turned round",
                    lens.name));
  Lens turned = lens;
  turned.aperture = {Aperture::Kind::stop_semi_diameter_mm, first_order(lens).stop_semi_diameter_mm};
  std::ranges::reverse(turned.surfaces);
  const std::size_t last = lens.surfaces.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    Surface& surface = turned.surfaces[i];
    if (!surface.apertures.empty())
      throw InputError(
          fmt::format("{}: surfaces[{}] has apertures that are not round; others can be turned round",
                      lens.name, last - i));
    if (surface.shape)
      throw InputError(fmt::format("{}: surfaces[{}] is a {}; conics and aspheres can be turned round",
                                   lens.name, last - i, surface.shape->kind));
    surface.curvature_per_mm = -surface.curvature_per_mm;
    for (auto& [power, coefficient] : surface.asphere) coefficient = -coefficient;
    surface.blades.rotation_deg = -surface.blades.rotation_deg;
    surface.thickness_mm = i < last ? lens.surfaces[last - 1 - i].thickness_mm : 1;
    surface.material = i < last ? lens.surfaces[last - 1 - i].material : Material();
  }
  const double image_mm = first_order(turned).paraxial_image_mm;
  if (!(image_mm > 0 && std::isfinite(image_mm)))
    throw InputError(
        fmt::format("{} forms no real image behind its last surface when it is turned round", lens.name));
  turned.surfaces.back().thickness_mm = image_mm;
  turned.name += ", turned round";
  return turned;
}

}  // namespace petzval
