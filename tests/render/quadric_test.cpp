// SPDX-License-Identifier: BSD-3-Clause
// The short way that whole spheres are met in, beside the way of all quadrics; points of the disk.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/render/disk_point.h>
#include <petzval/render/shapes/quadric.h>

#include <random>

namespace petzval::render {
namespace {

void expect_near(Vector3 a, Vector3 b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Quadric, MeetsABallAsAnySphere) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> about(-1, 1);
  for (const double mirror : {1.0, -1.0}) {
    Quadric slow;
    slow.radius = 0.7, slow.z_min = -0.7, slow.z_max = 0.7, slow.phi_max = 2 * pi;
    slow.world_from_object = Transform::translation({0.3, -2, 5}) * Transform::rotation(40, {1, 2, 3}) *
                             Transform::scaling({2 * mirror, 2, 2});
    Quadric quick = slow;
    quick.find_ball();
    ASSERT_TRUE(quick.ball);
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vector3 origin{0.3 + 3 * about(random), -2 + 3 * about(random), 5 + 3 * about(random)};
      const Vector3 direction{about(random), about(random), about(random)};
      const auto a = slow.hit(origin, direction, 1e-3, 100), b = quick.hit(origin, direction, 1e-3, 100);
      ASSERT_EQ(a.has_value(), b.has_value());
      if (!a) continue;
      ++met;
      // Grazing roots lose half of their digits.
      EXPECT_NEAR(*a, *b, 1e-6 * *a);
      const Vector3 near = origin + *a * direction;
      const Quadric::Point p = slow.at(near), q = quick.at(near, false);
      expect_near(p.position, q.position, 1e-12);
      expect_near(p.normal, q.normal, 1e-12);
      expect_near(p.along_u, q.along_u, 1e-12);
    }
    EXPECT_GT(met, 300);
  }
}

TEST(Quadric, IsNoBallInPartOrStretched) {
  Quadric part;
  part.phi_max = pi;
  part.find_ball();
  EXPECT_FALSE(part.ball);
  Quadric ellipsoid;
  ellipsoid.phi_max = 2 * pi;
  ellipsoid.world_from_object = Transform::scaling({1, 1, 2});
  ellipsoid.find_ball();
  EXPECT_FALSE(ellipsoid.ball);
}

TEST(DiskPoint, LiesAtTheAngleAndRadiusOfShirleyAndChiu) {
  for (int i = 0; i <= 64; ++i)
    for (int j = 0; j <= 64; ++j) {
      const double a = i / 32.0 - 1, b = j / 32.0 - 1;
      const DiskPoint on = disk_point(i / 64.0, j / 64.0);
      const bool wide = std::abs(a) > std::abs(b);
      const double r = wide ? a : b;
      const double phi = wide ? pi / 4 * b / a : b != 0 ? pi / 2 - pi / 4 * a / b : 0;
      // Roundings of an angle up to 3π/4, and of what is made of it.
      EXPECT_NEAR(on.x, r * std::cos(phi), 1e-15);
      EXPECT_NEAR(on.y, r * std::sin(phi), 1e-15);
    }
}

}  // namespace
}  // namespace petzval::render
