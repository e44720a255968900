// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/wavelength_range.h>

#include <algorithm>

namespace petzval {

LensWavelengths wavelength_range(const Lens& lens) {
  LensWavelengths range;
  const auto narrow = [&](double shortest_nm, double longest_nm) {
    range.shortest_nm = std::max(range.shortest_nm, shortest_nm);
    range.longest_nm = std::min(range.longest_nm, longest_nm);
  };
  const auto narrow_to = [&](const Material& material) {
    const Material::Kind& kind = material.kind();
    if (const auto* glass = std::get_if<std::shared_ptr<const Glass>>(&kind))
      narrow((*glass)->shortest_nm, (*glass)->longest_nm);
    if (const auto* table = std::get_if<Material::Table>(&kind))
      narrow(table->front().first, table->back().first);
  };
  narrow_to(lens.object_material);
  for (const Surface& surface : lens.surfaces) {
    narrow_to(surface.material);
    if (surface.transfer && surface.transfer->bands.size() > 1)
      narrow(surface.transfer->bands.front().wavelength_nm, surface.transfer->bands.back().wavelength_nm);
  }
  return range;
}

bool disperses(const Lens& lens, const std::vector<double>& wavelengths_nm) {
  return std::any_of(lens.surfaces.begin(), lens.surfaces.end(), [&](const Surface& surface) {
    if (surface.transfer) return surface.transfer->bands.size() > 1 && wavelengths_nm.size() > 1;
    return !surface.mirror && std::any_of(wavelengths_nm.begin(), wavelengths_nm.end(), [&](double nm) {
      return surface.material.index(nm) != surface.material.index(wavelengths_nm.front());
    });
  });
}

}  // namespace petzval
