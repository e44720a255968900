// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/glass/catalogue.h>
#include <petzval/optimise/glass_choice.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>

namespace petzval {

double glass_distance(const AbbeNumbers& a, const AbbeNumbers& b) {
  return std::hypot(a.nd - b.nd, 1e-2 * (a.vd - b.vd));
}

std::vector<std::shared_ptr<const Glass>> nearest_glasses(const Glass& glass, std::size_t count,
                                                          const std::vector<double>& wavelengths_nm) {
  const std::optional<AbbeNumbers> own = glass.abbe();
  if (!own) return {};
  const GlassCatalogue& catalogue = GlassCatalogue::bundled();
  const std::string maker = glass.catalogue + ":";
  std::vector<std::pair<double, std::shared_ptr<const Glass>>> others;
  for (const std::string& name : catalogue.full_names()) {
    if (!name.starts_with(maker) || name == glass.full_name()) continue;
    std::shared_ptr<const Glass> other = catalogue.find(name);
    const std::optional<AbbeNumbers> abbe = other->abbe();
    const bool valid = std::ranges::all_of(
        wavelengths_nm, [&](double nm) { return nm >= other->shortest_nm && nm <= other->longest_nm; });
    if (abbe && valid) others.emplace_back(glass_distance(*own, *abbe), std::move(other));
  }
  std::stable_sort(others.begin(), others.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (others.size() > count) others.resize(count);
  std::vector<std::shared_ptr<const Glass>> nearest;
  for (auto& [distance, other] : others) nearest.push_back(std::move(other));
  return nearest;
}

std::shared_ptr<const Glass> catalogue_glass(const Lens& lens, std::size_t surface) {
  const auto* glass = std::get_if<std::shared_ptr<const Glass>>(&lens.surfaces[surface].material.kind());
  return glass ? *glass : nullptr;
}

}  // namespace petzval
