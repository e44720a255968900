// SPDX-License-Identifier: BSD-3-Clause
// Lenses of random numbers, for properties that must hold for every lens.
#pragma once

#include <petzval/glass/catalogue.h>
#include <petzval/lens/lens.h>

#include <cmath>
#include <random>

namespace petzval::testing {

/// The same lenses in every run: the generator is seeded and its distributions are written out.
class RandomLens {
 public:
  explicit RandomLens(unsigned seed) : bits_(seed) {}

  Lens operator()() {
    Lens lens;
    lens.name = "random \"lens\" \\ \xC3\xA9\n";
    lens.source = chance(0.5) ? "" : "nowhere";
    if (chance(0.5)) lens.object_distance_mm = magnitude();
    lens.aperture = {static_cast<Aperture::Kind>(below(6)), uniform() * 0.9 + 0.01};
    if (lens.aperture.kind == Aperture::Kind::object_na && !lens.object_distance_mm)
      lens.object_distance_mm = 100;
    lens.fields = {static_cast<Fields::Kind>(below(4)), {0, uniform() * 80, uniform() * -80}};
    if (lens.fields.kind == Fields::Kind::object_height_mm && !lens.object_distance_mm) lens.fields.kind = {};
    lens.wavelengths_nm = {450 + 10 * uniform(), 550 + 10 * uniform(), 650 + 10 * uniform()};
    lens.reference_wavelength_nm = lens.wavelengths_nm[below(3)];
    const std::size_t count = 1 + below(12), stop = below(count);
    for (std::size_t i = 0; i < count; ++i) lens.surfaces.push_back(surface(i == stop));
    while (chance(0.2)) {
      const std::size_t first = below(count);
      lens.groups.push_back({first, first + below(count - first + 1), pose(), magnitude()});
    }
    if (chance(0.1)) lens.sensor_pose = pose();
    while (chance(0.2)) lens.tolerances.push_back({"surface_tilt_deg", below(count), 0, magnitude()});
    for (Tolerance& tolerance : lens.tolerances) tolerance.last = tolerance.first;
    return lens;
  }

  /// One without poses and melts, which other programs' files do not hold.
  Lens designed() {
    Lens lens = as_designed((*this)());
    for (Surface& surface : lens.surfaces) surface.material = surface.material.melted({});
    return lens;
  }

  double uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  bool chance(double probability) { return uniform() < probability; }
  std::size_t below(std::size_t count) { return bits_() % count; }
  /// From a nanometre to a kilometre, all 53 bits in use.
  double magnitude() { return std::exp2(40 * uniform() - 20) * (1 + uniform()); }

 private:
  double signed_magnitude() { return chance(0.5) ? magnitude() : -magnitude(); }

  Surface surface(bool stop) {
    Surface s;
    s.stop = stop;
    s.curvature_per_mm = chance(0.2) ? 0 : signed_magnitude();
    s.thickness_mm = chance(0.2) ? std::floor(100 * uniform()) : signed_magnitude();
    s.material = material();
    if (chance(0.7)) s.semi_diameter_mm = magnitude();
    if (chance(0.3)) s.conic = signed_magnitude();
    while (chance(0.4)) s.asphere[static_cast<int>(1 + below(40))] = signed_magnitude() * 1e-12;
    if (chance(0.1)) s.pose = pose();
    if (!s.material.is_air() && chance(0.1)) s.material = s.material.melted({1e-3 * uniform(), uniform()});
    return s;
  }

  Pose pose() {
    const auto tilt = [&] { return 120 * uniform() - 60; };
    return {magnitude(), -magnitude(), magnitude(), tilt(), tilt(), 6 * tilt()};
  }

  Material material() {
    switch (below(5)) {
      case 0:
        return Material(GlassCatalogue::bundled().find("SCHOTT:N-BK7"));
      case 1:
        return Material(Material::Model{1.5 + 0.3 * uniform(), 30 + 40 * uniform()});
      case 2:
        return Material(Material::Constant{1 + uniform()});
      case 3:
        return Material(Material::Table{
            {400 + uniform(), 1.6 + 0.1 * uniform()}, {500 + uniform(), 1.6}, {700 + uniform(), 1.5}});
      default:
        return Material();
    }
  }

  std::mt19937_64 bits_;
};

}  // namespace petzval::testing
