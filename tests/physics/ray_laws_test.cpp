// SPDX-License-Identifier: BSD-3-Clause
// Laws that every ray keeps, whatever the surfaces: Snell's, the skew invariant, reversal, étendue, and
// optical path differences that do not depend on where the beam was launched.
#include <gtest/gtest.h>
#include <petzval/lens/lens_file.h>
#include <petzval/trace/pencil.h>
#include <petzval/trace/pupil.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <cmath>
#include <random>

#include "trace/sample_lenses.h"

namespace petzval {
namespace {

using sample::of_every_kind;
using sample::random_ray;

using Vec = std::array<double, 3>;
using Matrix = std::array<std::array<double, 4>, 4>;

Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

TEST(RayLaws, SnellHoldsAtEverySurface) {
  // n (d × N) is the same on both sides; N by the tracer, perpendicular to the surface by the next test.
  const Lens lens = of_every_kind();
  const Tracer tracer(lens, 550);
  std::mt19937_64 random(1);
  for (int ray = 0; ray < 100; ++ray) {
    const Ray start = random_ray(random);
    std::vector<Intersection> path;
    ASSERT_EQ(tracer.trace(start, Tracer::Clip::none, &path).status, RayStatus::ok);
    Vec before = start.direction;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
      const Vec in = cross(before, path[i].normal), out = cross(path[i].direction_after, path[i].normal);
      for (std::size_t a = 0; a < 3; ++a)
        EXPECT_NEAR(tracer.surfaces()[i].index_before * in[a], tracer.surfaces()[i].index_after * out[a],
                    1e-14);
      before = path[i].direction_after;
    }
  }
}

TEST(RayLaws, SkewInvariantIsKept) {
  // n (x M − y L) is constant through anything that is symmetric about the axis (Welford 1986, ch. 6): it
  // fails if a normal does not point to the axis or a point does not lie on its ray.
  const Lens lens = of_every_kind();
  const Tracer tracer(lens, 550);
  std::mt19937_64 random(2);
  for (int ray = 0; ray < 100; ++ray) {
    const Ray start = random_ray(random);
    const double invariant = start.point_mm[0] * start.direction[1] - start.point_mm[1] * start.direction[0];
    const Ray end = tracer.trace(start, Tracer::Clip::none);
    ASSERT_EQ(end.status, RayStatus::ok);
    EXPECT_NEAR(
        tracer.image_index() * (end.point_mm[0] * end.direction[1] - end.point_mm[1] * end.direction[0]),
        invariant, 1e-13);
  }
}

TEST(RayLaws, NormalsArePerpendicularToTheirSurface) {
  // Two neighbours of a ray meet the surface beside it: the chord is perpendicular to the mean normal, to
  // second order. Chords of 2e-4 mm against curvatures of 0.05/mm: 1e-9.
  const Lens lens = of_every_kind();
  const Tracer tracer(lens, 550);
  std::mt19937_64 random(3);
  for (int ray = 0; ray < 50; ++ray) {
    const Ray start = random_ray(random);
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
      Ray low = start, high = start;
      low.point_mm[axis] -= 1e-4;
      high.point_mm[axis] += 1e-4;
      std::vector<Intersection> middle, below, above;
      tracer.trace(start, Tracer::Clip::none, &middle);
      tracer.trace(low, Tracer::Clip::none, &below);
      tracer.trace(high, Tracer::Clip::none, &above);
      for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        double along = 0, length = 0;
        for (std::size_t a = 0; a < 3; ++a) {
          const double chord = above[i].point_mm[a] - below[i].point_mm[a];
          along += chord * middle[i].normal[a];
          length += chord * chord;
        }
        EXPECT_LT(std::abs(along), 1e-7 * std::sqrt(length)) << "surface " << i;
      }
    }
  }
}

TEST(RayLaws, EveryKindOfSurfaceIsReversible) {
  const Tracer tracer(of_every_kind(), 550);
  std::mt19937_64 random(4);
  for (int ray = 0; ray < 100; ++ray) {
    const Ray start = random_ray(random);
    std::vector<Intersection> path;
    Ray back = tracer.trace(start, Tracer::Clip::none, &path);
    ASSERT_EQ(back.status, RayStatus::ok);
    for (double& cosine : back.direction) cosine = -cosine;
    back = tracer.trace_backward(back, Tracer::Clip::none);
    ASSERT_EQ(back.status, RayStatus::ok);
    // Aspheres are met to 1e-12 mm, twice.
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NEAR(back.point_mm[a], path.front().point_mm[a], 1e-11);
      EXPECT_NEAR(back.direction[a], -start.direction[a], 1e-12);
    }
  }
}

/// (x, y, nL, nM) on the image plane for (x, y, L, M) on the plane z = −5 in air.
std::array<double, 4> mapped(const Tracer& tracer, const std::array<double, 4>& from) {
  const Ray end = tracer.trace(
      Ray{{from[0], from[1], -5}, {from[2], from[3], std::sqrt(1 - from[2] * from[2] - from[3] * from[3])}},
      Tracer::Clip::none);
  EXPECT_EQ(end.status, RayStatus::ok);
  const double n = tracer.image_index();
  return {end.point_mm[0], end.point_mm[1], n * end.direction[0], n * end.direction[1]};
}

TEST(RayLaws, EtenduePassesEverySurface) {
  // The Jacobian J of the map between planes is symplectic, JᵀΩJ = Ω: more than dx dy dp dq = dx' dy' dp' dq'
  // alone (its determinant is then 1). Central differences of 1e-4: truncation 1e-8 of the third derivatives,
  // rounding 1e-13/1e-4.
  const Lens whole = of_every_kind();
  std::mt19937_64 random(5);
  for (std::size_t count = 1; count <= whole.surfaces.size(); ++count) {
    Lens lens = whole;
    lens.surfaces.resize(count);
    lens.surfaces.back().thickness_mm = 7;
    lens.surfaces.front().stop = true;
    for (std::size_t i = 1; i < count; ++i) lens.surfaces[i].stop = false;
    const Tracer tracer(lens, 550);
    for (int ray = 0; ray < 10; ++ray) {
      const Ray start = random_ray(random);
      const std::array<double, 4> at{start.point_mm[0], start.point_mm[1], start.direction[0],
                                     start.direction[1]};
      constexpr double step = 1e-4;
      Matrix jacobian{};
      for (std::size_t column = 0; column < 4; ++column) {
        std::array<double, 4> low = at, high = at;
        low[column] -= step;
        high[column] += step;
        const auto below = mapped(tracer, low), above = mapped(tracer, high);
        for (std::size_t row = 0; row < 4; ++row)
          jacobian[row][column] = (above[row] - below[row]) / (2 * step);
      }
      // Ω pairs x with its momentum and y with its own.
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
          double sum = 0;
          for (std::size_t q = 0; q < 2; ++q)
            sum += jacobian[q][i] * jacobian[q + 2][j] - jacobian[q + 2][i] * jacobian[q][j];
          const double omega = j == i + 2 ? 1 : (i == j + 2 ? -1 : 0);
          EXPECT_NEAR(sum, omega, 2e-6) << count << " surfaces, " << i << j;
        }
    }
  }
}

TEST(RayLaws, PathDifferencesDoNotDependOnTheLaunchPlane) {
  // All rays of a field start on a plane perpendicular to them; moving that plane adds the same to each. The
  // farther it is, the fewer digits are left for the difference: 1e3 mm leave 2e-13.
  for (const char* name : {"dgauss-50mm", "fisheye-10mm"}) {
    const Lens lens = read_lens(name).lens;
    const Tracer tracer(lens, 587.5618);
    const double field = 20;
    const Pencil pencil = Pencil::from_object(lens, field);
    ChiefRayMarch march(lens, tracer);
    const double chief_v = *march.v_at(field);
    const auto pupil = find_pupil(tracer, pencil, chief_v, 16);
    ASSERT_TRUE(pupil);
    const auto path = [&](double u, double v, double back) {
      Ray ray = *pencil.ray(u, v);
      for (std::size_t a = 0; a < 3; ++a) ray.point_mm[a] -= back * ray.direction[a];
      return tracer.trace(ray, Tracer::Clip::none).opl_mm;
    };
    const double chief = path(0, chief_v, 0);
    for (const PupilNode& node : pupil_nodes(*pupil, 4)) {
      const double difference = path(node.u, node.v, 0) - chief;
      for (const double back : {-3.0, 10.0, 1e3}) {
        EXPECT_NEAR(path(node.u, node.v, back) - path(0, chief_v, back), difference, 1e-12) << name;
        EXPECT_NEAR(path(0, chief_v, back) - chief, back, 1e-12) << name;
      }
    }
  }
}

}  // namespace
}  // namespace petzval
