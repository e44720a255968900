// SPDX-License-Identifier: BSD-3-Clause
// SIMD batches against the scalar trace, on every instruction set of the machine, in double and in float.
#include <gtest/gtest.h>
#include <petzval/lens/lens_file.h>
#include <petzval/trace/radiance_tracer.h>
#include <petzval/trace/tracer.h>

#include <cmath>
#include <random>

#include "trace/sample_lenses.h"
#include "trace/simd_targets.h"

namespace petzval {
namespace {

using sample::of_every_kind;
using sample::OnlyTarget;
using sample::random_ray;
using sample::targets_of_this_machine;
using sample::triplet_like;

void append(const Ray& ray, RayBatch& batch) {
  batch.push_back(ray.point_mm[0], ray.point_mm[1], ray.point_mm[2], ray.direction[0], ray.direction[1],
                  ray.direction[2]);
}

/// Rays from the front, some of which miss, and rays from the image side.
struct Launch {
  std::vector<Ray> rays;
  bool backward;
};

Launch forward_rays(std::size_t count) {
  std::mt19937_64 random(9);
  Launch launch{{}, false};
  for (std::size_t i = 0; i < count; ++i) {
    Ray ray = random_ray(random);
    if (i % 10 == 9) ray.point_mm[1] += 25;
    launch.rays.push_back(ray);
  }
  return launch;
}

Launch backward_rays(std::size_t count) {
  Launch launch = forward_rays(count);
  launch.backward = true;
  for (Ray& ray : launch.rays) {
    const double l = 0.2 * ray.direction[0], m = 0.2 * ray.direction[1];
    ray = {{0.1 * ray.point_mm[0], ray.point_mm[1], 44}, {l, m, -std::sqrt(1 - l * l - m * m)}};
  }
  return launch;
}

/// Statuses must be the same; the last bits may differ, as lanes use fused multiply-adds: 44 mm of path with
/// a relative 2e-16 a step.
void expect_batch_equals_scalar(const Lens& lens, const Launch& launch) {
  const Tracer tracer(lens, 550);
  RayBatch batch;
  for (const Ray& ray : launch.rays) append(ray, batch);
  launch.backward ? tracer.trace_backward(batch) : tracer.trace(batch);
  std::size_t passed = 0;
  for (std::size_t i = 0; i < launch.rays.size(); ++i) {
    const Ray single = launch.backward ? tracer.trace_backward(launch.rays[i]) : tracer.trace(launch.rays[i]);
    ASSERT_EQ(batch.status[i], single.status) << i;
    EXPECT_EQ(batch.failed_at[i], single.failed_at);
    if (single.status != RayStatus::ok) continue;
    ++passed;
    EXPECT_NEAR(batch.x_mm[i], single.point_mm[0], 1e-12);
    EXPECT_NEAR(batch.y_mm[i], single.point_mm[1], 1e-12);
    EXPECT_NEAR(batch.z_mm[i], single.point_mm[2], 1e-12);
    EXPECT_NEAR(batch.l[i], single.direction[0], 1e-14);
    EXPECT_NEAR(batch.m[i], single.direction[1], 1e-14);
    EXPECT_NEAR(batch.n[i], single.direction[2], 1e-14);
    EXPECT_NEAR(batch.opl_mm[i], single.opl_mm, 3e-12);
  }
  EXPECT_GT(passed, launch.rays.size() / 20) << "too few rays pass to show anything";
}

void expect_float_agrees(const Lens& lens, const Launch& launch) {
  // Places of up to 16 mm have a rounding of 5e-7 mm in float; refraction at a dozen surfaces adds up to
  // 1e-5. A pose turns the ray into the surface's axes and back, and into the sensor's: three sums of three
  // products, each rounded.
  const double tolerance_mm = 1e-5 + (has_poses(lens) ? 9 * 5e-7 : 0);
  const Tracer tracer(lens, 550);
  RadianceRays rays(launch.rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = launch.rays[i];
    rays.x_mm[i] = float(ray.point_mm[0]), rays.y_mm[i] = float(ray.point_mm[1]);
    rays.z_mm[i] = float(ray.point_mm[2]), rays.l[i] = float(ray.direction[0]);
    rays.m[i] = float(ray.direction[1]), rays.n[i] = float(ray.direction[2]);
  }
  const RadianceTracer single(
      tracer, launch.backward ? RadianceTracer::Direction::backward : RadianceTracer::Direction::forward);
  single.trace(rays);
  std::size_t passed = 0, differ = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray exact = launch.backward ? tracer.trace_backward(launch.rays[i]) : tracer.trace(launch.rays[i]);
    differ += (exact.status == RayStatus::ok) != (rays.passes[i] != 0);
    if (exact.status != RayStatus::ok || !rays.passes[i]) continue;
    ++passed;
    EXPECT_NEAR(rays.x_mm[i], exact.point_mm[0], tolerance_mm);
    EXPECT_NEAR(rays.y_mm[i], exact.point_mm[1], tolerance_mm);
    EXPECT_NEAR(rays.m[i], exact.direction[1], 2e-6);
  }
  EXPECT_GT(passed, rays.size() / 20);
  EXPECT_LE(differ, 1u);
}

class Targets : public testing::TestWithParam<std::int64_t> {};

TEST_P(Targets, BatchesEqualSingleRays) {
  const OnlyTarget only(GetParam());
  Lens conics = triplet_like();
  conics.surfaces[0].conic = -0.6;
  conics.surfaces[3].conic = 1.2;
  conics.surfaces[1].semi_diameter_mm = 2.0;
  Lens posed = of_every_kind();
  posed.surfaces[0].pose = {0.11, -0.07, 0.02, 0.9, -1.3, 20};
  posed.surfaces[2].pose = {0.05, 0.02, 0, 0.4, 0.3, 0};
  posed.groups = {{3, 4, {0.09, 0.04, 0.01, 1.1, 0.6, -5}, 1.5}};
  Lens sensor_alone = triplet_like();
  sensor_alone.sensor_pose = {0.2, -0.1, 0.04, 1.7, -2.1, 4};
  Lens all = posed;
  all.sensor_pose = sensor_alone.sensor_pose;
  for (const Lens& lens : {triplet_like(), conics, of_every_kind(), posed, sensor_alone, all}) {
    for (const std::size_t count : {1, 2, 7, 8, 23, 24, 25, 100, 999})
      expect_batch_equals_scalar(lens, forward_rays(std::max<std::size_t>(count, 20)));
    expect_batch_equals_scalar(lens, backward_rays(999));
  }
}

TEST_P(Targets, FloatAgreesWithDouble) {
  // Coordinates up to 50 mm have a float spacing of 3.8e-6 mm, directions of 6e-8; eleven surfaces add up
  // their rounding. Bounds as docs/TRACING.md states them.
  const OnlyTarget only(GetParam());
  const Lens lens = read_lens("dgauss-50mm").lens;
  const Tracer tracer(lens, 587.5618);
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> place(-12, 12), slope(-0.15, 0.15);
  for (const bool backward : {false, true}) {
    const std::size_t count = 997;
    RadianceRays rays(count);
    RayBatch exact;
    for (std::size_t i = 0; i < count; ++i) {
      const double l = static_cast<float>(slope(random)), m = static_cast<float>(slope(random));
      const double n = (backward ? -1 : 1) * std::sqrt(1 - l * l - m * m);
      const double x = static_cast<float>(place(random)), y = static_cast<float>(place(random));
      const double z = backward ? tracer.image_z_mm() : -10;
      exact.push_back(x, y, z, l, m, n);
      rays.x_mm[i] = static_cast<float>(x), rays.y_mm[i] = static_cast<float>(y);
      rays.z_mm[i] = static_cast<float>(z), rays.l[i] = static_cast<float>(l);
      rays.m[i] = static_cast<float>(m), rays.n[i] = static_cast<float>(n);
    }
    backward ? tracer.trace_backward(exact) : tracer.trace(exact);
    const RadianceTracer single(
        tracer, backward ? RadianceTracer::Direction::backward : RadianceTracer::Direction::forward);
    single.trace(rays);
    std::size_t passed = 0, differ = 0;
    double worst_mm = 0, worst_direction = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const bool passes = exact.status[i] == RayStatus::ok;
      differ += passes != (rays.passes[i] != 0);
      if (!passes || !rays.passes[i]) continue;
      ++passed;
      // Backward rays end on the first surface: their last coordinates err by what 50 mm of lever makes of
      // the direction they start with.
      worst_mm = std::max({worst_mm, std::abs(rays.x_mm[i] - exact.x_mm[i]),
                           std::abs(rays.y_mm[i] - exact.y_mm[i]), std::abs(rays.z_mm[i] - exact.z_mm[i])});
      worst_direction = std::max({worst_direction, std::abs(rays.l[i] - exact.l[i]),
                                  std::abs(rays.m[i] - exact.m[i]), std::abs(rays.n[i] - exact.n[i])});
    }
    EXPECT_GT(passed, count / 10);
    EXPECT_LE(differ, 1u) << "only a ray that grazes a rim may be told otherwise";
    EXPECT_LT(worst_mm, 2e-5);
    EXPECT_LT(worst_direction, 2e-6);
    EXPECT_GT(worst_mm, 1e-8) << "float that does not round was not traced";
  }
}

TEST_P(Targets, FloatTracesEveryKindOfSurface) {
  const OnlyTarget only(GetParam());
  Lens posed = of_every_kind();
  posed.surfaces[0].pose = {0.11, -0.07, 0.02, 0.9, -1.3, 20};
  posed.sensor_pose = {0.2, -0.1, 0.04, 1.7, -2.1, 4};
  for (const Lens& lens : {of_every_kind(), posed})
    for (const Launch& launch : {forward_rays(500), backward_rays(500)}) expect_float_agrees(lens, launch);
}

INSTANTIATE_TEST_SUITE_P(Machine, Targets, testing::ValuesIn(targets_of_this_machine()),
                         [](const auto& info) { return std::string(hwy::TargetName(info.param)); });

TEST(Batch, FindsTheSurfaceFromBeyondItsCentre) {
  // From 20 mm in front of a surface of radius −10 mm, whose centre lies between: G < 0, the other form of
  // the quadratic. All rays must be traced by the lanes as the scalar trace does.
  Lens lens;
  lens.surfaces = {sample::surface(0, 20, 1), sample::surface(-10, 3, 1.6), sample::surface(-9, 20, 1)};
  lens.surfaces[0].stop = true;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 4};
  expect_batch_equals_scalar(lens, forward_rays(300));
}

TEST(Batch, KeepsTheSignOfPathsWhereFacingSurfacesCross) {
  // Two facing surfaces 0.1 mm apart on the axis cross at a height of about 1.7 mm; beyond, the gap is walked
  // backwards. Nothing is between them, so a ray parallel to the axis stays parallel, and its path to the
  // image plane is the straight one.
  Lens lens;
  lens.surfaces = {sample::surface(-30, 0.1, 1), sample::surface(30, 10, 1)};
  lens.surfaces[0].stop = true;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 10};
  const Lens reversed = [&] {
    Lens other = lens;
    std::swap(other.surfaces[0].curvature_per_mm, other.surfaces[1].curvature_per_mm);
    return other;
  }();
  for (const Lens& each : {lens, reversed}) {
    const Tracer tracer(each, 550);
    RayBatch batch;
    for (int i = 0; i < 60; ++i) batch.push_back(0, 0.1 * i, -1, 0, 0, 1);
    tracer.trace(batch);
    bool crossed = false;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      ASSERT_EQ(batch.status[i], RayStatus::ok);
      EXPECT_NEAR(batch.opl_mm[i], 11.1, 1e-13);
      std::vector<Intersection> path;
      tracer.trace(Ray{{0, batch.y_mm[i], -1}, {0, 0, 1}}, Tracer::Clip::apertures, &path);
      crossed |= path[1].point_mm[2] < path[0].point_mm[2];
    }
    EXPECT_EQ(crossed, each.surfaces[0].curvature_per_mm > 0) << "the gap must be walked backwards";
  }
}

TEST(Batch, KeepsItsDigitsFromFarAway) {
  // The same line launched 1 mm and 1 km in front of the lens, in units that a double holds exactly: after
  // the lens all but the path must be the same. From 1 km the quadratic itself would lose ten of its digits.
  const Lens lens = triplet_like();
  const Tracer tracer(lens, 550);
  const double m = 0.28, n = 0.96;  // 7² + 24² = 25²
  for (const double length : {1e3, 1e6}) {
    RayBatch batch;
    for (int i = 0; i < 40; ++i) batch.push_back(0, 0.02 * i - m * length, -n * length, 0, m, n);
    tracer.trace(batch, Tracer::Clip::none);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const Ray near =
          tracer.trace(Ray{{0, 0.02 * static_cast<double>(i), 0}, {0, m, n}}, Tracer::Clip::none);
      ASSERT_EQ(batch.status[i], RayStatus::ok);
      // What the launch point itself is rounded to, times the lens's magnification of order one.
      const double digits = 4e-16 * length + 1e-13;
      EXPECT_NEAR(batch.y_mm[i], near.point_mm[1], 4 * digits);
      EXPECT_NEAR(batch.m[i], near.direction[1], digits);
      EXPECT_NEAR(batch.opl_mm[i] - length, near.opl_mm, 4 * digits);
      const Ray single = tracer.trace(
          Ray{{0, 0.02 * static_cast<double>(i) - m * length, -n * length}, {0, m, n}}, Tracer::Clip::none);
      EXPECT_NEAR(single.opl_mm - length, near.opl_mm, 4 * digits);
    }
  }
}

TEST(Batch, ReachesAnAsphereFromFarAway) {
  // From 12 km: the distance itself has a rounding of 2e-9 mm, the point on the surface must not.
  Lens lens = of_every_kind();
  lens.surfaces[0].asphere = {{4, 1e-5}};
  const Tracer tracer(lens, 550);
  RayBatch batch;
  for (int i = 0; i < 30; ++i) batch.push_back(0, 0.05 * i, -1.2e7, 0, 0, 1);
  tracer.trace(batch);
  for (int i = 0; i < 30; ++i) {
    ASSERT_EQ(batch.status[static_cast<std::size_t>(i)], RayStatus::ok) << i;
    const Ray near = tracer.trace(Ray{{0, 0.05 * i, -1}, {0, 0, 1}});
    // A ray along the axis meets the same point wherever it starts; what differs is 1e-9 in z, times slope.
    EXPECT_NEAR(batch.y_mm[static_cast<std::size_t>(i)], near.point_mm[1], 1e-9);
  }
}

}  // namespace
}  // namespace petzval
