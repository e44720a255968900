// SPDX-License-Identifier: BSD-3-Clause
// Derivatives of rays by numbers of the lens: against differences of traced rays and against closed forms.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_file.h>
#include <petzval/trace/ray_derivatives.h>

#include <cmath>
#include <random>

#include "trace/sample_lenses.h"

namespace petzval {
namespace {

using Kind = LensNumber::Kind;

/// Every number that a lens of spheres, conics and powers has, and some that it might have.
std::vector<LensNumber> all_numbers(const Lens& lens) {
  std::vector<LensNumber> numbers;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    for (const Kind kind : {Kind::curvature_per_mm, Kind::thickness_mm, Kind::conic})
      numbers.push_back({kind, i});
    if (!lens.surfaces[i].shape) numbers.push_back({Kind::power, i, 4});
    for (const auto& [power, coefficient] : lens.surfaces[i].asphere)
      if (power >= 2 && power != 4) numbers.push_back({Kind::power, i, power});
  }
  for (int entry = 0; entry < 6; ++entry) {
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) numbers.push_back({Kind::surface_pose, i, entry});
    for (std::size_t i = 0; i < lens.groups.size(); ++i) numbers.push_back({Kind::group_pose, i, entry});
    numbers.push_back({Kind::sensor_pose, 0, entry});
  }
  return numbers;
}

std::array<double, 5> place_of_ray(const Lens& lens, const Ray& launch) {
  const Ray end = Tracer(lens, 550, INFINITY).trace(launch, Tracer::Clip::none);
  return {end.point_mm[0], end.point_mm[1], end.direction[0], end.direction[1], end.opl_mm};
}

/// By the central difference of the fourth order.
std::array<double, 5> difference(const Lens& lens, const LensNumber& number, const Ray& launch, double step) {
  const double now = value_of(lens, number);
  const auto at = [&](double steps) {
    return place_of_ray(with_value(lens, number, now + steps * step), launch);
  };
  const auto a = at(-2), b = at(-1), c = at(1), d = at(2);
  std::array<double, 5> slope{};
  for (std::size_t i = 0; i < 5; ++i) slope[i] = (a[i] - 8 * b[i] + 8 * c[i] - d[i]) / (12 * step);
  return slope;
}

/// A step by which the rim of a surface moves by some micrometres.
double step_of(const LensNumber& number) {
  switch (number.kind) {
    case Kind::curvature_per_mm:
      return 1e-5;
    case Kind::thickness_mm:
      return 1e-3;
    case Kind::conic:
      return 1e-3;
    case Kind::power:
      return 1e-3 * std::pow(4.0, -number.power);
    default:
      break;
  }
  return 1e-3;  // mm or degrees
}

/// With poses of single surfaces, of groups within groups and of the sensor.
Lens posed_lens() {
  Lens lens = sample::of_every_kind();
  lens.name = "posed";
  lens.surfaces[0].pose = {0.1, -0.2, 0.05, 1, -2, 10};
  lens.surfaces[3].pose.decentre_y_mm = 0.3;
  lens.groups = {{1, 2, {0.05, 0.1, 0, -1.5, 0.5, 3}, 2}, {1, 5, {0, 0.2, 0.1, 2, 1, 0}, -1}};
  lens.sensor_pose = {0.1, 0.2, -0.3, 3, -2, 20};
  return lens;
}

/// A mirror at 45°, a biconic behind it, and all that follows turned by 90°.
Lens folded_lens() {
  Lens lens = sample::triplet_like();
  lens.name = "folded";
  Surface mirror = sample::surface(0, -12, 1);
  mirror.mirror = true;
  lens.surfaces.insert(lens.surfaces.begin() + 2, mirror);
  lens.surfaces[3].thickness_mm = -4, lens.surfaces[4].thickness_mm = -2, lens.surfaces[5].thickness_mm = -30;
  for (const std::size_t i : {4, 5}) lens.surfaces[i].curvature_per_mm *= -1;
  lens.surfaces[4].shape = AddedShape{"biconic", {{"curvature_x_per_mm", {0.04}}, {"conic_x", {0.3}}}};
  lens.groups = {{2, 6, {0, 0, 0, 45, 0, 0}, 0}, {3, 6, {0, 0, 0, 45, 0, 0}, 12}};
  return lens;
}

TEST(RayDerivatives, AreThoseOfTracedRays) {
  // Rays move by some micrometres, known to 1e-13 mm: differences are good to 1e-9 of the larger slopes, and
  // their fourth-order error is below that. A thousand times that is left for small slopes beside large ones.
  std::mt19937_64 random(3);
  for (const Lens& lens : {sample::triplet_like(), sample::of_every_kind(), posed_lens(), folded_lens(),
                           read_lens("dgauss-50mm").lens}) {
    SCOPED_TRACE(lens.name);
    const std::vector<LensNumber> numbers = all_numbers(lens);
    const DerivedTracer tracer(lens, 550, numbers);
    const double reach = 0.5 * stop_radius_mm(lens);
    std::uniform_real_distribution<double> place(-reach, reach), slope(-0.1, 0.1);
    for (int i = 0; i < 10; ++i) {
      const double l = slope(random), m = slope(random);
      const Ray launch{{place(random), place(random), -5}, {l, m, std::sqrt(1 - l * l - m * m)}};
      const auto derived = tracer.trace(launch);
      ASSERT_TRUE(derived);
      ASSERT_EQ(derived->by.size(), numbers.size());
      EXPECT_EQ(derived->ray.point_mm, tracer.tracer().trace(launch, Tracer::Clip::none).point_mm);
      for (std::size_t k = 0; k < numbers.size(); ++k) {
        const DerivedRay::Slope& by = derived->by[k];
        const std::array<double, 5> ours{by.x_mm, by.y_mm, by.alpha, by.beta, by.opl_mm};
        const std::array<double, 5> theirs = difference(lens, numbers[k], launch, step_of(numbers[k]));
        double largest = 0;
        for (const double value : theirs) largest = std::max(largest, std::abs(value));
        for (std::size_t c = 0; c < 5; ++c)
          EXPECT_NEAR(ours[c], theirs[c], 1e-6 * largest + 1e-9 / step_of(numbers[k]) * 1e-4)
              << "number " << k << " of kind " << static_cast<int>(numbers[k].kind) << ", column " << c;
      }
    }
  }
}

TEST(RayDerivatives, OfAPlateAreClosed) {
  // A plate of index n and thickness t moves a ray of slope angle θ; its place behind by thickness is
  // tan θ', with sin θ = n sin θ'; the path n / cos θ'.
  Lens plate;
  plate.surfaces = {Surface{0, 5, Material(Material::Constant{1.5})}, Surface{0, 10}};
  plate.surfaces[0].stop = true;
  plate.aperture = {Aperture::Kind::entrance_pupil_diameter_mm, 2};
  const double sine = 0.3, inside = sine / 1.5, cosine = std::sqrt(1 - inside * inside);
  const std::vector<LensNumber> numbers{{Kind::thickness_mm, 0}, {Kind::thickness_mm, 1}};
  const auto derived =
      DerivedTracer(plate, 550, numbers).trace({{0, 0, -1}, {0, sine, std::sqrt(1 - sine * sine)}});
  EXPECT_NEAR(derived->by[0].y_mm, inside / cosine, 1e-15);
  EXPECT_NEAR(derived->by[0].opl_mm, 1.5 / cosine, 1e-14);
  EXPECT_NEAR(derived->by[1].y_mm, sine / std::sqrt(1 - sine * sine), 1e-15);
  EXPECT_EQ(derived->by[0].beta, 0);
}

TEST(RayDerivatives, RefuseWhatTheyDoNotKnow) {
  Lens lens = read_lens("dgauss-50mm").lens;
  EXPECT_THROW(value_of(lens, {Kind::conic, 99}), InputError);
  EXPECT_THROW(value_of(lens, {Kind::power, 0, 1}), InputError);
  EXPECT_THROW(value_of(lens, {Kind::group_pose, 0, 3}), InputError);
  EXPECT_THROW(value_of(lens, {Kind::sensor_pose, 0, 6}), InputError);
  lens.surfaces[2].grating = Grating{};
  EXPECT_THROW(DerivedTracer(lens, 550, {}), InputError);
}

TEST(RayDerivatives, OfALostRayThereAreNone) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  EXPECT_FALSE(DerivedTracer(lens, 550, {}).trace({{0, 500, -5}, {0, 0, 1}}));
}

}  // namespace
}  // namespace petzval
