// SPDX-License-Identifier: BSD-3-Clause
// Powers of reflected and refracted light against the closed forms, energy and reversibility.
#include <gtest/gtest.h>
#include <petzval/flare/surface_reflection.h>
#include <petzval/wave/thin_film.h>

#include <cmath>

namespace petzval {
namespace {

using V = std::array<double, 3>;

struct Meeting {
  V before, refracted, mirrored, normal{0, 0, 1};
};

/// In a plane that is no axis's.
Meeting meeting(double n1, double n2, double angle) {
  const double s = std::sin(angle), c = std::cos(angle), t = n1 / n2 * s;
  const double x = 0.6, y = 0.8;
  return {{x * s, y * s, c}, {x * t, y * t, std::sqrt(std::max(0.0, 1 - t * t))}, {x * s, y * s, -c}};
}

TEST(SurfaceReflection, OfBareGlassIsFresnelsFromBothSides) {
  for (const bool behind : {false, true})
    for (const double angle : {0.0, 0.3, 0.6, 1.2}) {
      const double n1 = behind ? 1.7 : 1.0, n2 = behind ? 1.0 : 1.7;
      if (n1 / n2 * std::sin(angle) >= 1) continue;
      const SurfaceReflection surface(1.0, 1.7, nullptr, 550);
      const Meeting at = meeting(n1, n2, angle);
      const LightFields light = LightFields::unpolarised(at.before);
      const double reflected = surface.reflected(light, at.before, at.mirrored, at.normal, behind).power();
      // sin² and tan² of the difference over the sum of the angles (Fresnel 1823).
      const double other = std::asin(n1 / n2 * std::sin(angle));
      const double expected = angle == 0
                                  ? std::pow((n1 - n2) / (n1 + n2), 2)
                                  : 0.5 * (std::pow(std::sin(angle - other) / std::sin(angle + other), 2) +
                                           std::pow(std::tan(angle - other) / std::tan(angle + other), 2));
      EXPECT_NEAR(reflected, expected, 1e-14);
      EXPECT_NEAR(reflected + surface.transmitted(light, at.before, at.refracted, at.normal, behind).power(),
                  1, 1e-14);
    }
}

// Linear interpolation over 1024 steps of the cosine: the second derivative of a few quarter waves is of the
// order of ten, an eighth of which times the square of a step is 1e-6.
TEST(SurfaceReflection, OfFilmsIsThatOfTheirMatrices) {
  const Coating coating = read_coating("mgf2");
  for (const bool behind : {false, true})
    for (const double angle : {0.0, 0.2, 0.5, 0.62, 1.0}) {
      const double glass = 1.6, n1 = behind ? glass : 1.0, n2 = behind ? 1.0 : glass;
      const SurfaceReflection surface(1.0, glass, &coating, 480);
      const Meeting at = meeting(n1, n2, angle);
      const LightFields light = LightFields::unpolarised(at.before);
      const double reflected = surface.reflected(light, at.before, at.mirrored, at.normal, behind).power();
      if (n1 / n2 * std::sin(angle) >= 1) {
        EXPECT_NEAR(reflected, 1, 1e-12);
        continue;
      }
      const std::vector<ThinFilm> films = coating.films(480, n1);
      const double s = film_power(n1, films, n2, std::cos(angle), 480, Polarisation::s).reflectance,
                   p = film_power(n1, films, n2, std::cos(angle), 480, Polarisation::p).reflectance;
      EXPECT_NEAR(reflected, 0.5 * (s + p), 2e-6) << angle << behind;
      EXPECT_NEAR(reflected + surface.transmitted(light, at.before, at.refracted, at.normal, behind).power(),
                  1, 2e-6);
    }
}

TEST(SurfaceReflection, OfAMeasuredOneIsTheSameAtAllAngles) {
  const Coating coating = Coating::constant(0.012);
  const SurfaceReflection surface(1.0, 1.5, &coating, 550);
  for (const double angle : {0.0, 0.7}) {
    const Meeting at = meeting(1.0, 1.5, angle);
    const LightFields light = LightFields::unpolarised(at.before);
    EXPECT_NEAR(surface.reflected(light, at.before, at.mirrored, at.normal, false).power(), 0.012, 1e-15);
  }
}

}  // namespace
}  // namespace petzval
