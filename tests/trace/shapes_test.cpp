// SPDX-License-Identifier: BSD-3-Clause
// Rays meet surfaces of every kind: against bisection in extended precision, single rays against vectors of
// rays on every instruction set, forwards and backwards, and where there is nothing to meet.
#include <gtest/gtest.h>
#include <petzval/lens/surface_shape.h>
#include <petzval/trace/radiance_tracer.h>
#include <petzval/trace/tracer.h>

#include <cmath>
#include <limits>
#include <optional>

#include "trace/sample_shapes.h"
#include "trace/simd_targets.h"

namespace petzval {
namespace {

using sample::NamedSurface;
using sample::OnlyTarget;
using sample::surfaces_of_all_kinds;
using Real = long double;

Tracer tracer_of(const Surface& surface) {
  Lens lens;
  lens.surfaces = {surface};
  return Tracer(lens, 550, std::numeric_limits<double>::infinity());
}

/// The sag of a conic with powers of r, written apart from the library.
Real sag_by_formula(const Surface& s, Real x, Real y) {
  const Real r = std::sqrt(x * x + y * y), c = s.curvature_per_mm;
  Real sag = c * r * r / (1 + std::sqrt(1 - (1 + Real(s.conic)) * c * c * r * r));
  for (const auto& [power, coefficient] : s.asphere) sag += coefficient * std::pow(r, Real(power));
  return sag;
}

/// For a kind of the table its sag is that of the library, which the test of the kind holds to its formula.
Real sag_of(const Surface& s, Real x, Real y) {
  if (!s.shape) return sag_by_formula(s, x, y);
  return surface_point(shape_of(s), static_cast<double>(x), static_cast<double>(y)).sag;
}

struct Aimed {
  Ray ray;
  double way;  ///< from the ray's start to about where it meets the surface
};

/// A ray towards a place of the surface within 4 mm of the axis, from the front or from behind.
Aimed random_ray_towards(const Surface& surface, bool backward, std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-2.8, 2.8), slope(-0.45, 0.45), length(3, 30);
  const double x = place(random), y = place(random), way = length(random);
  const double z = static_cast<double>(sag_of(surface, x, y));
  const double l = slope(random), m = slope(random);
  const double n = (backward ? -1 : 1) * std::sqrt(1 - l * l - m * m);
  return {{{x - way * l, y - way * m, z - way * n}, {l, m, n}}, way};
}

/// How far along the ray the surface is, by bisection of its sag within a millimetre of `way`.
Real bisected(const Surface& surface, const Aimed& aimed) {
  const auto behind = [&](Real t) {
    const auto at = [&](int axis) { return aimed.ray.point_mm[axis] + t * aimed.ray.direction[axis]; };
    return at(2) - sag_of(surface, at(0), at(1));
  };
  Real low = aimed.way - 1, high = aimed.way + 1;
  const bool low_is_behind = behind(low) > 0;
  EXPECT_NE(low_is_behind, behind(high) > 0);
  for (int i = 0; i < 80; ++i) {
    const Real middle = (low + high) / 2;
    ((behind(middle) > 0) == low_is_behind ? low : high) = middle;
  }
  return low;
}

/// Snell's law for vectors, in extended precision, the normal from differences of the sag; nothing on total
/// reflection.
struct Bent {
  std::array<Real, 3> direction;
  Real cosine;  ///< to the normal
};
std::optional<Bent> refracted(const Surface& surface, const Intersection& hit,
                              const std::array<double, 3>& direction, Real ratio) {
  const Real h = surface.shape ? 1e-3L : 1e-5L, x = hit.point_mm[0], y = hit.point_mm[1];
  const auto slope = [&](Real dx, Real dy) {
    const auto difference = [&](Real k) {
      return (sag_of(surface, x + k * dx, y + k * dy) - sag_of(surface, x - k * dx, y - k * dy)) /
             (2 * k * h);
    };
    return (4 * difference(0.5L) - difference(1)) / 3;
  };
  std::array<Real, 3> normal{-slope(h, 0), -slope(0, h), 1}, out;
  const Real size = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + 1);
  Real cosine = 0;
  for (int a = 0; a < 3; ++a) normal[a] /= size, cosine += direction[a] * normal[a];
  for (int a = 0; a < 3; ++a) out[a] = ratio * (direction[a] - cosine * normal[a]);
  const Real sine_sq = out[0] * out[0] + out[1] * out[1] + out[2] * out[2];
  if (sine_sq > 1) return {};
  const Real out_cosine = std::sqrt(1 - sine_sq);
  for (int a = 0; a < 3; ++a) out[a] += std::copysign(out_cosine, cosine) * normal[a];
  return Bent{out, out_cosine};
}

TEST(Shapes, RaysMeetEveryKindWhereBisectionFindsItAndRefractBySnell) {
  std::mt19937_64 random(21);
  int reflected = 0, through = 0;
  for (int round = 0; round < 60; ++round) {
    for (const auto& [name, surface] : surfaces_of_all_kinds(random)) {
      const Tracer tracer = tracer_of(surface);
      const double index = surface.material.index(550);
      for (const bool backward : {false, true}) {
        const Aimed aimed = random_ray_towards(surface, backward, random);
        std::vector<Intersection> path;
        const Ray ray = backward ? tracer.trace_backward(aimed.ray, Tracer::Clip::none, &path)
                                 : tracer.trace(aimed.ray, Tracer::Clip::none, &path);
        const Real distance = bisected(surface, aimed);
        Intersection expected;
        for (int a = 0; a < 3; ++a)
          expected.point_mm[a] =
              static_cast<double>(aimed.ray.point_mm[a] + distance * aimed.ray.direction[a]);
        const auto bent =
            refracted(surface, expected, aimed.ray.direction, backward ? Real(index) : 1 / Real(index));
        ASSERT_EQ(ray.status, bent ? RayStatus::ok : RayStatus::tir) << name << (backward ? " backward" : "");
        ++(bent ? through : reflected);
        if (!bent) continue;
        ASSERT_GE(path.size(), 1u);
        for (int a = 0; a < 3; ++a) {
          // Newton ends within 1e-12 mm of the sag; a few roundings of 30 mm come on top.
          EXPECT_NEAR(path[0].point_mm[a], expected.point_mm[a], 3e-12) << name;
          // A grazing ray turns by an error of the normal over its cosine. Differences of a sag in double are
          // good to 1e-16/1e-3.
          EXPECT_NEAR(path[0].direction_after[a], static_cast<double>(bent->direction[a]),
                      (surface.shape ? 3e-12 : 3e-14) / static_cast<double>(bent->cosine))
              << name;
        }
      }
    }
  }
  EXPECT_GT(through, 500);
  EXPECT_GT(reflected, 20);
}

TEST(Shapes, RaysBesideTheRimMiss) {
  std::mt19937_64 random(22);
  std::uniform_real_distribution<double> beyond(1.001, 2), azimuth(0, 6.28);
  int missed = 0;
  for (int round = 0; round < 40; ++round) {
    for (const auto& [name, surface] : surfaces_of_all_kinds(random)) {
      const double rim = rim_mm(shape_of(surface));
      // The rims of these are no circles.
      if (!std::isfinite(rim) || name == "biconic" || name == "toroid") continue;
      const double r = rim * beyond(random), angle = azimuth(random);
      for (const double n : {1.0, -1.0}) {
        const Ray start{{r * std::cos(angle), r * std::sin(angle), -3 * n}, {0, 0, n}};
        const Tracer tracer = tracer_of(surface);
        const Ray ray = n < 0 ? tracer.trace_backward(start) : tracer.trace(start);
        EXPECT_EQ(ray.status, RayStatus::missed) << name << " at " << r << ", rim " << rim;
        EXPECT_EQ(ray.failed_at, 0);
        ++missed;
      }
    }
  }
  EXPECT_GT(missed, 100);
}

class ShapesOnTarget : public testing::TestWithParam<std::int64_t> {};

/// Rays that meet the surface, rays that miss it, and rays that are totally reflected.
std::vector<Ray> mixed_rays(const Surface& surface, bool backward, std::mt19937_64& random) {
  std::vector<Ray> rays;
  for (int i = 0; i < 100; ++i) {
    rays.push_back(random_ray_towards(surface, backward, random).ray);
    if (i % 9 == 8) rays.back().point_mm[0] += 40;
  }
  return rays;
}

TEST_P(ShapesOnTarget, VectorsOfRaysEqualSingleRays) {
  const OnlyTarget only(GetParam());
  std::mt19937_64 random(23);
  int of_status[4] = {};
  for (int round = 0; round < 10; ++round) {
    for (const auto& [name, surface] : surfaces_of_all_kinds(random)) {
      const Tracer tracer = tracer_of(surface);
      for (const bool backward : {false, true}) {
        const std::vector<Ray> rays = mixed_rays(surface, backward, random);
        RayBatch batch;
        for (const Ray& ray : rays)
          batch.push_back(ray.point_mm[0], ray.point_mm[1], ray.point_mm[2], ray.direction[0],
                          ray.direction[1], ray.direction[2]);
        backward ? tracer.trace_backward(batch) : tracer.trace(batch);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          const Ray single = backward ? tracer.trace_backward(rays[i]) : tracer.trace(rays[i]);
          ASSERT_EQ(batch.status[i], single.status) << name << " ray " << i;
          ++of_status[static_cast<int>(single.status)];
          if (single.status != RayStatus::ok) continue;
          // 70 mm of path, and 1e-12 mm at each surface that is met by Newton; a ray that leaves along the
          // image surface goes as many times farther.
          const double way = std::hypot(single.point_mm[0], single.point_mm[1]),
                       longer = std::max(1.0, way / 70);
          EXPECT_NEAR(batch.x_mm[i], single.point_mm[0], 3e-12 * longer) << name;
          EXPECT_NEAR(batch.y_mm[i], single.point_mm[1], 3e-12 * longer) << name;
          EXPECT_NEAR(batch.z_mm[i], single.point_mm[2], 3e-12 * longer) << name;
          EXPECT_NEAR(batch.n[i], single.direction[2], 1e-13) << name;
          EXPECT_NEAR(batch.opl_mm[i], single.opl_mm, 6e-12 * longer) << name;
        }
      }
    }
  }
  EXPECT_GT(of_status[static_cast<int>(RayStatus::ok)], 1000);
  EXPECT_GT(of_status[static_cast<int>(RayStatus::missed)], 100);
  EXPECT_GT(of_status[static_cast<int>(RayStatus::tir)], 20);
}

TEST_P(ShapesOnTarget, FloatFollowsDouble) {
  const OnlyTarget only(GetParam());
  std::mt19937_64 random(24);
  for (const auto& [name, surface] : surfaces_of_all_kinds(random)) {
    const Tracer tracer = tracer_of(surface);
    RadianceRays rays(64);
    std::vector<Ray> exact;
    for (std::size_t i = 0; i < 64; ++i) {
      const Ray ray = random_ray_towards(surface, false, random).ray;
      rays.x_mm[i] = static_cast<float>(ray.point_mm[0]), rays.y_mm[i] = static_cast<float>(ray.point_mm[1]);
      rays.z_mm[i] = static_cast<float>(ray.point_mm[2]), rays.l[i] = static_cast<float>(ray.direction[0]);
      rays.m[i] = static_cast<float>(ray.direction[1]), rays.n[i] = static_cast<float>(ray.direction[2]);
      exact.push_back(tracer.trace(ray));
    }
    RadianceTracer(tracer, RadianceTracer::Direction::forward).trace(rays);
    for (std::size_t i = 0; i < 64; ++i) {
      ASSERT_EQ(rays.passes[i] != 0, exact[i].status == RayStatus::ok) << name;
      if (!rays.passes[i]) continue;
      // Coordinates up to 40 mm have a float spacing of 3.8e-6 mm, directions 6e-8 over 70 mm of way.
      EXPECT_NEAR(rays.x_mm[i], exact[i].point_mm[0], 3e-5) << name;
      EXPECT_NEAR(rays.l[i], exact[i].direction[0], 1e-6) << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Machine, ShapesOnTarget, testing::ValuesIn(sample::targets_of_this_machine()),
                         [](const auto& target) { return std::string(hwy::TargetName(target.param)); });

}  // namespace
}  // namespace petzval
