// SPDX-License-Identifier: BSD-3-Clause
// Mirrors: closed forms, a second tracer written for the test in long double, and folds that change nothing.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/trace/radiance_tracer.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>

namespace petzval {
namespace {

Surface mirror_of(double radius_mm, double thickness_mm, double conic = 0) {
  Surface mirror = Surface::sphere(radius_mm, thickness_mm);
  mirror.mirror = true;
  mirror.conic = conic;
  return mirror;
}

Lens lens_with(std::vector<Surface> surfaces, double pupil_mm) {
  Lens lens;
  lens.name = "mirrors";
  lens.surfaces = std::move(surfaces);
  lens.surfaces.front().stop = true;
  lens.aperture = {Aperture::Kind::entrance_pupil_diameter_mm, pupil_mm};
  lens.wavelengths_nm = {550};
  lens.reference_wavelength_nm = 550;
  return lens;
}

/// The Hubble telescope's two mirrors, scaled to mm (Schroeder, Astronomical Optics, 2nd ed. 2000,
/// table 6.13: R1 = −11.04 m, K1 = −1.00230, R2 = −1.358 m, K2 = −1.49686, mirrors 4.9061 m apart,
/// focus 6.4062 m behind the second; f/24, 57.6 m).
Lens hubble() {
  return lens_with({mirror_of(-11040, -4906.071, -1.0022985), mirror_of(-1358, 6406.200, -1.49600)}, 2400);
}

TEST(Mirrors, AParaboloidFocusesABeamAlongItsAxisToAPoint) {
  Lens lens = lens_with({mirror_of(-200, -100, -1)}, 100);  // focus at R/2
  const Tracer tracer(lens, 550);
  EXPECT_NEAR(first_order(lens).efl_mm, 100, 1e-12);
  EXPECT_NEAR(first_order(lens).paraxial_image_mm, 100, 1e-12);
  const double axial = tracer.trace(Ray{{0, 0, 0}, {0, 0, 1}}).opl_mm;
  for (const double h : {1.0, 20.0, 49.0}) {
    std::vector<Intersection> path;
    const Ray ray = tracer.trace(Ray{{0.6 * h, 0.8 * h, -300}, {0, 0, 1}, -300}, Tracer::Clip::none, &path);
    ASSERT_EQ(ray.status, RayStatus::ok);
    EXPECT_NEAR(path[0].point_mm[2], -h * h / 400, 1e-12);
    EXPECT_LT(path[0].direction_after[2], 0);
    EXPECT_NEAR(ray.point_mm[0], 0, 1e-12);
    EXPECT_NEAR(ray.point_mm[1], 0, 1e-12);
    EXPECT_NEAR(ray.opl_mm, axial + 0, 1e-11);  // 400 mm of path: 2e-13 of it, summed a few times
    EXPECT_GT(ray.direction[2], 0);             // image space is seen in the mirror
  }
}

TEST(Mirrors, TheHubbleTelescopeHasItsPublishedFocalLength) {
  const FirstOrder optics = first_order(hubble());
  // 1/f = 1/f1 + 1/f2 − d/(f1 f2), f1 = 5520, f2 = −679 mm, d = 4906.071 mm.
  const double f1 = 5520, f2 = -679, d = 4906.071;
  EXPECT_NEAR(optics.efl_mm, 1 / (1 / f1 + 1 / f2 - d / (f1 * f2)), 1e-8);
  EXPECT_NEAR(optics.efl_mm, 57600, 0.005 * 57600);  // as published, to its digits
  EXPECT_NEAR(optics.f_number, 24, 0.005 * 24);
  // Petzval's sum of two mirrors, 2/R1 − 2/R2 with the signs of the prescription.
  EXPECT_NEAR(std::abs(optics.petzval_radius_mm), 1 / std::abs(2 / 11040.0 - 2 / 1358.0), 1e-6);
}

/// Mirrors and refracting spheres or conics by long double: the quadratic solved in full, both roots tried.
struct SecondTracer {
  using Real = long double;
  using Vector = std::array<Real, 3>;
  const Lens& lens;

  std::optional<std::array<Vector, 2>> trace(Vector p, Vector d) const {
    Real z = 0, index = 1;
    for (const Surface& s : lens.surfaces) {
      const Real c = s.curvature_per_mm, q = 1 + static_cast<Real>(s.conic);
      p[2] -= z;
      // c(x² + y² + q z²) − 2z = 0 along p + t d
      const Real a = c * (d[0] * d[0] + d[1] * d[1] + q * d[2] * d[2]);
      const Real b = c * (p[0] * d[0] + p[1] * d[1] + q * p[2] * d[2]) - d[2];
      const Real e = c * (p[0] * p[0] + p[1] * p[1] + q * p[2] * p[2]) - 2 * p[2];
      Real t = 0;
      if (a == 0) {
        t = -e / (2 * b);
      } else {
        const Real root = std::sqrt(b * b - a * e);
        const Real one = (-b + root) / a, two = (-b - root) / a;
        const auto off = [&](Real way) { return std::abs(p[2] + way * d[2]); };
        t = off(one) < off(two) ? one : two;
      }
      for (int i = 0; i < 3; ++i) p[i] += t * d[i];
      Vector n{-c * p[0], -c * p[1], 1 - c * q * p[2]};
      const Real size = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      for (Real& each : n) each /= size;
      Real cosine = d[0] * n[0] + d[1] * n[1] + d[2] * n[2];
      if (s.mirror) {
        for (int i = 0; i < 3; ++i) d[i] -= 2 * cosine * n[i];
      } else {
        const Real behind = s.material.index(550), ratio = index / behind;
        if (cosine < 0) {
          cosine = -cosine;
          for (Real& each : n) each = -each;
        }
        const Real under = 1 - ratio * ratio * (1 - cosine * cosine);
        if (under < 0) return {};
        for (int i = 0; i < 3; ++i) d[i] = ratio * d[i] + (std::sqrt(under) - ratio * cosine) * n[i];
        index = behind;
      }
      p[2] += z;
      z += s.thickness_mm;
    }
    const Real t = (z - p[2]) / d[2];
    for (int i = 0; i < 3; ++i) p[i] += t * d[i];
    return std::array{p, d};
  }
};

/// A Mangin mirror in front of a field lens, light running back through both: glass in front of the mirror is
/// behind it too.
Lens mangin() {
  const Material glass{Material::Constant{1.5168}};
  std::vector<Surface> surfaces{Surface::sphere(-150, 8, glass), mirror_of(-220, -8, -0.3),
                                Surface::sphere(-150, -40), Surface::sphere(-60, -4, glass),
                                Surface::sphere(90, -50)};
  return lens_with(std::move(surfaces), 50);
}

class MirrorRays : public ::testing::TestWithParam<Lens (*)()> {};

TEST_P(MirrorRays, AgreeWithASecondTracerBothWaysAloneAndInBatches) {
  const Lens lens = GetParam()();
  const Tracer tracer(lens, 550);
  const double pupil = lens.aperture.value / 2;
  // The length of the way, in roundings of double: 64 of them, and no less than for a lens of 0.7 m.
  const double close = std::max(1e-11, 64 * 2.3e-16 * lens.total_track_mm());
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> across(-pupil, pupil), angle(-0.01, 0.01);
  RayBatch batch;
  std::vector<Ray> starts;
  for (int i = 0; i < 200; ++i) {
    const double l = angle(random), m = angle(random);
    Ray start{{across(random), across(random), -20}, {l, m, std::sqrt(1 - l * l - m * m)}};
    starts.push_back(start);
    batch.push_back(start.point_mm[0], start.point_mm[1], start.point_mm[2], l, m, start.direction[2]);
  }
  tracer.trace(batch, Tracer::Clip::none);
  const double sense = lens.last_sense();
  int traced = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const auto& [p, d] = std::tie(starts[i].point_mm, starts[i].direction);
    const auto second = SecondTracer{lens}.trace({p[0], p[1], p[2]}, {d[0], d[1], d[2]});
    std::vector<Intersection> path;
    const Ray ray = tracer.trace(starts[i], Tracer::Clip::none, &path);
    ASSERT_EQ(ray.status == RayStatus::ok, second.has_value());
    if (!second) continue;
    ++traced;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(ray.point_mm[axis], static_cast<double>((*second)[0][axis]), close);
      EXPECT_NEAR(ray.direction[axis], static_cast<double>((*second)[1][axis]) * (axis == 2 ? sense : 1),
                  1e-13);
    }
    EXPECT_NEAR(batch.x_mm[i], ray.point_mm[0], close);
    EXPECT_NEAR(batch.y_mm[i], ray.point_mm[1], close);
    EXPECT_NEAR(batch.z_mm[i], ray.point_mm[2], close);
    EXPECT_NEAR(batch.n[i], ray.direction[2], 1e-13);
    EXPECT_NEAR(batch.opl_mm[i], ray.opl_mm, 2 * close);
    // Back along the same way, alone and in a batch.
    Ray back = ray;
    for (double& cosine : back.direction) cosine = -cosine;
    back.opl_mm = 0;
    RayBatch backwards;
    backwards.push_back(back.point_mm[0], back.point_mm[1], back.point_mm[2], back.direction[0],
                        back.direction[1], back.direction[2]);
    const Ray returned = tracer.trace_backward(back, Tracer::Clip::none);
    ASSERT_EQ(returned.status, RayStatus::ok);
    tracer.trace_backward(backwards, Tracer::Clip::none);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(returned.point_mm[axis], path.front().point_mm[axis], close);
      EXPECT_NEAR(returned.direction[axis], -starts[i].direction[axis], 1e-12);
    }
    EXPECT_NEAR(backwards.x_mm[0], returned.point_mm[0], close);
    EXPECT_NEAR(backwards.z_mm[0], returned.point_mm[2], close);
    EXPECT_NEAR(backwards.n[0], returned.direction[2], 1e-12);
  }
  EXPECT_GT(traced, 150);
}

INSTANTIATE_TEST_SUITE_P(Lenses, MirrorRays, ::testing::Values(&hubble, &mangin));

/// A doublet whose light is thrown to the side by a mirror at 45° on its way to the sensor: the mirror turns
/// by 45°, and all that follows by 90° about its middle.
Lens doublet(bool folded) {
  const Material crown{Material::Constant{1.5168}}, flint{Material::Constant{1.6200}};
  std::vector<Surface> surfaces{Surface::sphere(61, 6, crown), Surface::sphere(-43, 2.5, flint),
                                Surface::sphere(-125, 40)};
  if (folded) {
    Surface fold = mirror_of(INFINITY, -30);
    surfaces.push_back(fold);
    surfaces.push_back(Surface::sphere(300, -3, crown));
    surfaces.push_back(Surface::sphere(INFINITY, -20));
  } else {
    surfaces.push_back(Surface::sphere(INFINITY, 30));
    surfaces.push_back(Surface::sphere(-300, 3, crown));
    surfaces.push_back(Surface::sphere(INFINITY, 20));
  }
  Lens lens = lens_with(std::move(surfaces), 25);
  if (!folded) return lens;
  lens.surfaces[3].pose.tilt_x_deg = 45;
  SurfaceGroup behind;
  behind.first = 4, behind.last = 6, behind.pivot_mm = 30, behind.pose.tilt_x_deg = 90;
  lens.groups = {behind};
  return lens;
}

TEST(Mirrors, AFoldChangesNothing) {
  const Lens straight = doublet(false), folded = doublet(true);
  folded.validate();
  EXPECT_DOUBLE_EQ(first_order(folded).efl_mm, first_order(straight).efl_mm);
  EXPECT_DOUBLE_EQ(first_order(folded).paraxial_image_mm, first_order(straight).paraxial_image_mm);
  EXPECT_DOUBLE_EQ(first_order(folded).exit_pupil.position_mm, first_order(straight).exit_pupil.position_mm);
  const Tracer one(straight, 550), other(folded, 550);
  EXPECT_FALSE(other.is_centred());
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> across(-11, 11), angle(-0.05, 0.05);
  for (int i = 0; i < 300; ++i) {
    const double l = angle(random), m = angle(random);
    const Ray start{{across(random), across(random), -10}, {l, m, std::sqrt(1 - l * l - m * m)}};
    const Ray a = one.trace(start), b = other.trace(start);
    ASSERT_EQ(a.status, b.status);
    if (a.status != RayStatus::ok) continue;
    // 100 mm of way and three turns: some dozen roundings.
    EXPECT_NEAR(a.point_mm[0], b.point_mm[0], 1e-12);
    EXPECT_NEAR(a.point_mm[1], b.point_mm[1], 1e-12);
    EXPECT_NEAR(a.direction[0], b.direction[0], 1e-14);
    EXPECT_NEAR(a.direction[1], b.direction[1], 1e-14);
    EXPECT_NEAR(a.direction[2], b.direction[2], 1e-14);
    EXPECT_NEAR(a.opl_mm, b.opl_mm, 1e-12);
  }
}

TEST(Mirrors, FloatRaysForRadianceFollowDoubleOnes) {
  const Lens lens = mangin();
  const Tracer tracer(lens, 550);
  const RadianceTracer radiance(tracer, RadianceTracer::Direction::backward, Tracer::Clip::none);
  RadianceRays rays;
  rays.resize(1);
  const double l = 0.05, m = -0.1, n = -std::sqrt(1 - l * l - m * m);
  rays.x_mm[0] = 0.5f, rays.y_mm[0] = 1, rays.z_mm[0] = static_cast<float>(tracer.image_z_mm());
  rays.l[0] = static_cast<float>(l), rays.m[0] = static_cast<float>(m), rays.n[0] = static_cast<float>(n);
  radiance.trace(rays);
  const Ray exact = tracer.trace_backward(Ray{{0.5, 1, tracer.image_z_mm()}, {l, m, n}}, Tracer::Clip::none);
  ASSERT_EQ(exact.status, RayStatus::ok);
  ASSERT_TRUE(rays.passes[0]);
  // 100 mm in float: 1e-5 mm a rounding.
  EXPECT_NEAR(rays.x_mm[0], exact.point_mm[0], 2e-4);
  EXPECT_NEAR(rays.y_mm[0], exact.point_mm[1], 2e-4);
  EXPECT_NEAR(rays.n[0], exact.direction[2], 2e-6);
}

TEST(Mirrors, HaveNoGlassOfTheirOwn) {
  Lens lens = hubble();
  lens.surfaces[1].material = Material(Material::Constant{1.5});
  EXPECT_THROW(lens.validate(), InputError);
}

}  // namespace
}  // namespace petzval
