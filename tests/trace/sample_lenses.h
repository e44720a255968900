// SPDX-License-Identifier: BSD-3-Clause
// Small lenses for testing, and random rays towards them.
#pragma once

#include <petzval/trace/tracer.h>

#include <cmath>
#include <random>

namespace petzval::sample {

/// radius 0: flat.
inline Surface surface(double radius_mm, double thickness_mm, double index) {
  Surface s;
  s.curvature_per_mm = radius_mm == 0 ? 0 : 1 / radius_mm;
  s.thickness_mm = thickness_mm;
  if (index != 1) s.material = Material(Material::Constant{index});
  return s;
}

/// Spheres with a stop of 1.5 mm on the third surface.
inline Lens triplet_like() {
  Lens lens;
  lens.name = "test lens";
  lens.surfaces = {surface(20, 3, 1.62), surface(-200, 5, 1), surface(0, 4, 1), surface(-30, 2, 1.7),
                   surface(25, 30, 1)};
  lens.surfaces[2].stop = true;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 1.5};
  return lens;
}

/// The same with every kind of surface: conic, even asphere, plane, odd asphere, sphere.
inline Lens of_every_kind() {
  Lens lens = triplet_like();
  lens.surfaces[0].conic = -0.6;
  lens.surfaces[1].asphere = {{4, 2e-5}, {6, -3e-7}};
  lens.surfaces[3].conic = 0.4;
  lens.surfaces[3].asphere = {{3, 1e-4}, {4, -5e-5}, {5, 2e-6}};
  return lens;
}

inline Ray random_ray(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-2, 2), slope(-0.2, 0.2);
  const double l = slope(random), m = slope(random);
  return {{place(random), place(random), -5}, {l, m, std::sqrt(1 - l * l - m * m)}};
}

}  // namespace petzval::sample
