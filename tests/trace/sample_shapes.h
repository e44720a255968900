// SPDX-License-Identifier: BSD-3-Clause
// Surfaces of every kind, with random parameters.
#pragma once

#include <petzval/lens/surface_kind.h>

#include <random>
#include <string>
#include <vector>

namespace petzval::sample {

struct NamedSurface {
  std::string name;
  Surface surface;
};

/// One of each kind that there is, those of the table of kinds among them: some 10 mm of radius, and
/// departures of some micrometres up to r = 4 mm.
inline std::vector<NamedSurface> surfaces_of_all_kinds(std::mt19937_64& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Surface base;
  base.curvature_per_mm = between(1 / 25.0, 1 / 9.0) * (between(-1, 1) < 0 ? -1 : 1);
  base.thickness_mm = 40;
  base.material = Material(Material::Constant{between(1.4, 1.9)});
  base.stop = true;
  std::vector<NamedSurface> all(6, {"", base});
  all[0] = {"plane", base};
  all[0].surface.curvature_per_mm = 0;
  all[1].name = "sphere";
  all[2].name = "conic";
  all[3].name = "even powers";
  all[3].surface.asphere = {{4, between(-1e-5, 1e-5)}, {6, between(-1e-6, 1e-6)}, {10, between(-1e-9, 1e-9)}};
  all[4].name = "odd powers";
  all[4].surface.asphere = {{2, between(-1e-4, 1e-4)}, {3, between(-1e-4, 1e-4)}, {5, between(-1e-6, 1e-6)}};
  all[5].name = "powers on a plane";
  all[5].surface.curvature_per_mm = 0;
  all[5].surface.asphere = {{2, between(-0.03, 0.03)}, {4, between(-1e-5, 1e-5)}};
  for (std::size_t i = 2; i < 5; ++i) all[i].surface.conic = between(-2.5, 0.8);
  for (const SurfaceKind& kind : surface_kinds()) {
    NamedSurface added{kind.name, base};
    added.surface.conic = between(-2.5, 0.8);
    added.surface.shape = AddedShape{kind.name, {}};
    for (const ShapeParameter& parameter : kind.parameters) {
      std::vector<double>& numbers = added.surface.shape->parameters[parameter.name];
      numbers.resize(std::min<std::size_t>(parameter.most, 6));
      for (double& number : numbers) number = parameter.positive ? between(4, 6) : between(-2e-3, 2e-3);
    }
    all.push_back(added);
  }
  return all;
}

}  // namespace petzval::sample
