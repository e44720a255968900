// SPDX-License-Identifier: BSD-3-Clause
// Gratings, ideal lenses and immersed objects: closed forms, and a tracer written for the test in long
// double.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/trace/radiance_tracer.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <cmath>
#include <random>

#include "trace/simd_targets.h"

namespace petzval {
namespace {

using Long = long double;
using LongVector = std::array<Long, 3>;

Material glass_of(double index) {
  return Material(Material::Constant{index});
}

Lens lens_of(std::vector<Surface> surfaces, double stop_mm = 5) {
  Lens lens;
  lens.name = "bends";
  lens.surfaces = std::move(surfaces);
  lens.surfaces.front().stop = true;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, stop_mm};
  lens.wavelengths_nm = {550};
  lens.reference_wavelength_nm = 550;
  return lens;
}

Surface ruled(double radius_mm, double thickness_mm, const Grating& grating, const Material& behind = {}) {
  Surface surface = Surface::sphere(radius_mm, thickness_mm, behind);
  surface.grating = grating;
  return surface;
}

Surface ideal(double focal_length_mm, double thickness_mm, const Material& behind = {}) {
  Surface surface = Surface::sphere(INFINITY, thickness_mm, behind);
  surface.ideal_lens = IdealLens{focal_length_mm};
  return surface;
}

Ray in_meridian(double height_mm, double sine) {
  return {{0, height_mm, 0}, {0, sine, std::sqrt(1 - sine * sine)}};
}

TEST(Gratings, ObeyTheGratingEquation) {
  // n' sin θ' = n sin θ + m λ/d, worked by hand; a mirror has n' = n and throws the ray back.
  for (const double order : {-2.0, -1.0, 0.0, 1.0, 2.0})
    for (const double sine : {-0.4, 0.0, 0.3}) {
      const Lens through = lens_of({ruled(INFINITY, 10, {300, order, 0}, glass_of(1.5))});
      const Ray passed = Tracer(through, 550).trace(in_meridian(0.7, sine));
      ASSERT_EQ(passed.status, RayStatus::ok);
      EXPECT_NEAR(passed.direction[1], (sine + order * 300 * 550e-6) / 1.5, 1e-15);
      Lens back = lens_of({ruled(INFINITY, -10, {300, order, 0})});
      back.surfaces[0].mirror = true;
      std::vector<Intersection> path;
      Tracer(back, 550).trace(in_meridian(0.7, sine), Tracer::Clip::apertures, &path);
      ASSERT_EQ(path.size(), 2u);
      EXPECT_NEAR(path[0].direction_after[1], sine + order * 300 * 550e-6, 1e-15);
      EXPECT_LT(path[0].direction_after[2], 0);
    }
  // Beyond a right angle there is no order.
  const Ray none = Tracer(lens_of({ruled(INFINITY, 10, {2000, 1, 0})}), 550).trace(in_meridian(0, 0.3));
  EXPECT_EQ(none.status, RayStatus::tir);
  EXPECT_EQ(none.failed_at, 0);
}

TEST(Gratings, TurnTheirLines) {
  const Lens lens = lens_of({ruled(INFINITY, 10, {300, 1, 30})});
  const Ray ray = Tracer(lens, 550).trace(Ray{});
  EXPECT_NEAR(ray.direction[0], -0.5 * 300 * 550e-6, 1e-15);
  EXPECT_NEAR(ray.direction[1], std::sqrt(0.75) * 300 * 550e-6, 1e-15);
  const Ray turned = Tracer(lens, 550).turned(radians(-30)).trace(Ray{});
  EXPECT_NEAR(turned.direction[0], 0, 1e-15);
  EXPECT_NEAR(turned.direction[1], 300 * 550e-6, 1e-15);
  EXPECT_NEAR(Tracer(lens, 550).mirrored().trace(Ray{}).direction[0], 0.5 * 300 * 550e-6, 1e-15);
  EXPECT_FALSE(Tracer(lens, 550).is_centred());
}

TEST(Gratings, KeepAPlaneWaveInStep) {
  // The rays of a beam, launched from a plane across them, have the same path at a plane across the order.
  const Lens lens = lens_of({ruled(INFINITY, 30, {600, -1, 0}, glass_of(1.6))});
  const Tracer tracer(lens, 633);
  const double sine = 0.35, cosine = std::sqrt(1 - sine * sine);
  double first = 0;
  for (const double v : {-4.0, 0.0, 3.0}) {
    const Ray ray = tracer.trace(Ray{{0.2 * v, v * cosine, -v * sine}, {0, sine, cosine}});
    const auto& [x, y, z] = ray.point_mm;
    const double ahead = 1.6 * (x * ray.direction[0] + y * ray.direction[1] + (z - 30) * ray.direction[2]);
    if (v == -4.0) first = ray.opl_mm - ahead;
    EXPECT_NEAR(ray.opl_mm - ahead, first, 1e-13);
  }
}

TEST(Gratings, OnASphereFocusOnTheRowlandCircle) {
  // Source and image on the circle whose diameter is the radius of the sphere: defocus and coma along the
  // dispersion vanish, so that the paths to the image grow as the fourth power of the height (Welford 1986,
  // ch. 5). Rays are sent to the points of the grating; the image's distance is reckoned by hand.
  const double radius = 200, lines = 600, lambda = 550e-6, sine = std::sin(0.3);
  const double sine_after = sine - lines * lambda;  // light thrown back, order -1
  const double near = radius * std::cos(0.3), far = radius * std::sqrt(1 - sine_after * sine_after);
  Lens lens = lens_of({ruled(-radius, -10, {lines, -1, 0})}, 50);
  lens.surfaces[0].mirror = true;
  const Tracer tracer(lens, 550);
  const auto path_at = [&](double y) {
    const double z = -(radius - std::sqrt(radius * radius - y * y));
    const double sy = -near * sine, sz = -near * std::cos(0.3);
    const double way = std::hypot(y - sy, z - sz);
    std::vector<Intersection> met;
    Ray ray{{0, sy, sz}, {0, (y - sy) / way, (z - sz) / way}};
    const Ray end = tracer.trace(ray, Tracer::Clip::none, &met);
    EXPECT_EQ(end.status, RayStatus::ok);
    EXPECT_NEAR(met[0].point_mm[1], y, 1e-12);
    const auto& after = met[0].direction_after;
    const double at_surface = end.opl_mm - std::hypot(met[1].point_mm[1] - y, met[1].point_mm[2] - z);
    const double iy = far * sine_after, iz = -far * std::sqrt(1 - sine_after * sine_after);
    // The ray itself heads for the image, but for aberrations of the third power.
    const double miss = (iy - y) * after[2] - (iz - z) * after[1];
    EXPECT_LT(std::abs(miss), 3e-6 * std::abs(y * y * y) + 1e-11);
    return at_surface + std::hypot(iy - y, iz - z);
  };
  const double at_vertex = path_at(0);
  const double two = path_at(2) - at_vertex, four = path_at(4) - at_vertex;
  EXPECT_GT(std::abs(four), 1e-7);
  EXPECT_NEAR(four / two, 16, 0.05 * 16);
}

/// One surface in a pose, in long double: turned axes, a conic met by Newton, the grating's law by
/// components.
struct LongRay {
  LongVector point, direction;
  Long path;
};

LongVector turned(const LongVector& v, Long about_x, Long about_y, bool back) {
  const auto x = [&](const LongVector& a, Long t) {
    return LongVector{a[0], a[1] * std::cos(t) - a[2] * std::sin(t), a[1] * std::sin(t) + a[2] * std::cos(t)};
  };
  const auto y = [&](const LongVector& a, Long t) {
    return LongVector{a[0] * std::cos(t) + a[2] * std::sin(t), a[1],
                      -a[0] * std::sin(t) + a[2] * std::cos(t)};
  };
  return back ? y(x(v, -about_x), -about_y) : x(y(v, about_y), about_x);
}

TEST(Gratings, OnATiltedConicAgreeWithASecondTracer) {
  const double n = 1.52, tilt_x = 12, tilt_y = -7, tolerance = 1e-9;
  const Grating grating{450, 2, 35};
  for (const bool mirror : {false, true}) {
    Surface surface = ruled(-80, mirror ? -25 : 25, grating, mirror ? Material() : glass_of(n));
    surface.conic = -0.6;
    surface.mirror = mirror;
    surface.pose = {0.4, -0.3, 0.2, tilt_x, tilt_y, 0};
    const Lens lens = lens_of({surface});
    const Tracer tracer(lens, 600);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(-5, 5), slope(-0.1, 0.1);
    for (int i = 0; i < 50; ++i) {
      const double l = slope(random), m = slope(random);
      Ray start{{place(random), place(random), -8}, {l, m, std::sqrt(1 - l * l - m * m)}};
      std::vector<Intersection> met;
      const Ray ours = tracer.trace(start, Tracer::Clip::none, &met);
      ASSERT_EQ(ours.status, RayStatus::ok);
      const Long ax = Long(tilt_x) * Long(pi) / 180, ay = Long(tilt_y) * Long(pi) / 180;
      LongVector p = turned(
          {start.point_mm[0] - Long(0.4), start.point_mm[1] + Long(0.3), start.point_mm[2] - Long(0.2)}, ax,
          ay, true);
      LongVector d = turned({start.direction[0], start.direction[1], start.direction[2]}, ax, ay, true);
      const Long c = Long(1) / -80, q = 1 + Long(-0.6);
      Long t = -p[2] / d[2];
      for (int k = 0; k < 40; ++k) {
        const Long x = p[0] + t * d[0], y = p[1] + t * d[1], z = p[2] + t * d[2];
        const Long f = c * (x * x + y * y + q * z * z) - 2 * z;
        t -= f / (2 * (c * (x * d[0] + y * d[1] + q * z * d[2]) - d[2]));
      }
      for (std::size_t k = 0; k < 3; ++k) p[k] += t * d[k];
      LongVector normal{-c * p[0], -c * p[1], 1 - c * q * p[2]};
      const Long length = std::hypot(normal[0], normal[1], normal[2]);
      for (Long& each : normal) each /= length;
      const Long turn = Long(35) * Long(pi) / 180, strength = 2 * Long(600e-6) * 450,
                 after = mirror ? 1 : Long(n);
      LongVector k{d[0] - strength * std::sin(turn), d[1] + strength * std::cos(turn), d[2]};
      const Long along = k[0] * normal[0] + k[1] * normal[1] + k[2] * normal[2];
      for (std::size_t a = 0; a < 3; ++a) k[a] -= along * normal[a];
      const Long rest = std::sqrt(after * after - k[0] * k[0] - k[1] * k[1] - k[2] * k[2]);
      for (std::size_t a = 0; a < 3; ++a) d[a] = (k[a] + (mirror ? -rest : rest) * normal[a]) / after;
      const Long path = t + strength * (-std::sin(turn) * p[0] + std::cos(turn) * p[1]);
      const LongVector at = turned(p, ax, ay, false), towards = turned(d, ax, ay, false);
      const LongVector moved{at[0] + Long(0.4), at[1] - Long(0.3), at[2] + Long(0.2)};
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(met[0].point_mm[a], static_cast<double>(moved[a]), tolerance);
        EXPECT_NEAR(met[0].direction_after[a], static_cast<double>(towards[a]), tolerance);
      }
      const Long rest_way = ((mirror ? -25 : 25) - moved[2]) / towards[2];
      EXPECT_NEAR(ours.opl_mm, static_cast<double>(path + after * rest_way), tolerance);
    }
  }
}

/// A grating and an ideal lens in the beam of a lens, posed, with glass between.
Lens mixed() {
  Surface grating = ruled(120, 6, {200, 1, 20}, glass_of(1.6));
  grating.conic = 0.3;
  grating.pose = {0.1, 0.2, 0, 5, -3, 0};
  Lens lens = lens_of({Surface::sphere(60, 4, glass_of(1.5)), grating, Surface::sphere(-70, 5),
                       ideal(45, 30, glass_of(1.3))});
  lens.object_material = glass_of(1.33);
  lens.object_distance_mm = 150;
  return lens;
}

TEST(Bends, AreTheSameBackwardsAndInVectors) {
  const Tracer tracer(mixed(), 550);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-4, 4), slope(-0.05, 0.05);
  RayBatch batch(67);
  std::vector<Ray> starts;
  for (std::size_t i = 0; i < 67; ++i) {
    const double l = slope(random), m = slope(random);
    starts.push_back({{place(random), place(random), -20}, {l, m, std::sqrt(1 - l * l - m * m)}});
  }
  for (const std::int64_t target : sample::targets_of_this_machine()) {
    const sample::OnlyTarget only(target);
    for (std::size_t i = 0; i < starts.size(); ++i) {
      batch.x_mm[i] = starts[i].point_mm[0], batch.y_mm[i] = starts[i].point_mm[1];
      batch.z_mm[i] = starts[i].point_mm[2];
      batch.l[i] = starts[i].direction[0], batch.m[i] = starts[i].direction[1];
      batch.n[i] = starts[i].direction[2];
      batch.opl_mm[i] = 0;
    }
    std::fill(batch.status.begin(), batch.status.end(), RayStatus::ok);
    tracer.trace(batch, Tracer::Clip::none);
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const Ray one = tracer.trace(starts[i], Tracer::Clip::none);
      ASSERT_EQ(one.status, batch.status[i]);
      ASSERT_EQ(one.status, RayStatus::ok);
      EXPECT_NEAR(one.point_mm[0], batch.x_mm[i], 1e-11);
      EXPECT_NEAR(one.point_mm[1], batch.y_mm[i], 1e-11);
      EXPECT_NEAR(one.direction[1], batch.m[i], 1e-13);
      EXPECT_NEAR(one.opl_mm, batch.opl_mm[i], 1e-11);
      Ray back{one.point_mm, {-one.direction[0], -one.direction[1], -one.direction[2]}};
      back = tracer.trace_backward(back, Tracer::Clip::none);
      ASSERT_EQ(back.status, RayStatus::ok);
      const double way = (-20 - back.point_mm[2]) / back.direction[2];
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(back.direction[a], -starts[i].direction[a], 1e-12);
        EXPECT_NEAR(back.point_mm[a] + way * back.direction[a], starts[i].point_mm[a], 1e-10);
      }
      EXPECT_NEAR(back.opl_mm + 1.33 * way, one.opl_mm, 1e-10);
    }
  }
  // In single precision: what float resolves of 40 mm, a few times over.
  RadianceRays rays(starts.size());
  for (std::size_t i = 0; i < starts.size(); ++i) {
    rays.x_mm[i] = static_cast<float>(starts[i].point_mm[0]);
    rays.y_mm[i] = static_cast<float>(starts[i].point_mm[1]);
    rays.z_mm[i] = static_cast<float>(starts[i].point_mm[2]);
    rays.l[i] = static_cast<float>(starts[i].direction[0]);
    rays.m[i] = static_cast<float>(starts[i].direction[1]);
    rays.n[i] = static_cast<float>(starts[i].direction[2]);
  }
  RadianceTracer(tracer, RadianceTracer::Direction::forward, Tracer::Clip::none).trace(rays);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const Ray one = tracer.trace(starts[i], Tracer::Clip::none);
    ASSERT_EQ(rays.passes[i], 1);
    EXPECT_NEAR(rays.y_mm[i], one.point_mm[1], 2e-5);
    EXPECT_NEAR(rays.m[i], one.direction[1], 2e-6);
  }
}

/// Rays of one object point over the aperture: where they land, and the spread of their paths.
void expect_stigmatic(const Lens& lens, double object_y, double image_y) {
  const Tracer tracer(lens, 550, INFINITY);
  const double distance = *lens.object_distance_mm;
  double first = 0;
  for (const double x : {-6.0, 0.0, 5.0})
    for (const double y : {-7.0, 0.5, 6.0}) {
      const double length = std::hypot(x, y - object_y, distance);
      const Ray ray = tracer.trace(
          Ray{{0, object_y, -distance}, {x / length, (y - object_y) / length, distance / length}});
      ASSERT_EQ(ray.status, RayStatus::ok);
      EXPECT_NEAR(ray.point_mm[0], 0, 1e-11);
      EXPECT_NEAR(ray.point_mm[1], image_y, 1e-11);
      if (first == 0) first = ray.opl_mm;
      EXPECT_NEAR(ray.opl_mm, first, 1e-10);
    }
}

TEST(IdealLenses, ImageAPlanePerfectly) {
  // 1/s' = 1/f − 1/s and m = −s'/s; between media n'/s' = 1/f − n/s and m = −(s'/n')/(s/n).
  Lens lens = lens_of({ideal(50, 75)});
  lens.object_distance_mm = 150;
  expect_stigmatic(lens, 0, 0);
  expect_stigmatic(lens, 20, -10);
  Lens immersed = lens_of({ideal(50, 1.5 / (1 / 50.0 - 1.33 / 200), glass_of(1.5))});
  immersed.object_material = glass_of(1.33), immersed.object_distance_mm = 200;
  const double image_mm = immersed.surfaces[0].thickness_mm;
  expect_stigmatic(immersed, 20, -20 * (image_mm / 1.5) / (200 / 1.33));
  EXPECT_NEAR(first_order(immersed).paraxial_image_mm, image_mm, 1e-12);
  EXPECT_NEAR(first_order(immersed).magnification, -(image_mm / 1.5) / (200 / 1.33), 1e-14);
  // Two of them, the image of the first a virtual object of the second.
  Lens two = lens_of({ideal(50, 20), ideal(-80, 1 / (1 / 55.0 - 1 / 80.0))});
  two.object_distance_mm = 150;
  const double first_m = -75 / 150.0, second_m = (1 / (1 / 55.0 - 1 / 80.0)) / 55;
  expect_stigmatic(two, 12, 12 * first_m * second_m);
}

TEST(IdealLenses, FocusParallelLight) {
  const Lens lens = lens_of({ideal(40, 40)});
  const Tracer tracer(lens, 550, INFINITY);
  EXPECT_DOUBLE_EQ(first_order(lens).efl_mm, 40);
  const double theta = radians(25);
  double first = 0;
  for (const double v : {-9.0, 0.0, 8.0}) {
    const Ray ray = tracer.trace(
        Ray{{2, v * std::cos(theta), -v * std::sin(theta)}, {0, std::sin(theta), std::cos(theta)}});
    EXPECT_NEAR(ray.point_mm[1], 40 * std::tan(theta), 1e-12);
    EXPECT_NEAR(ray.point_mm[0], 0, 1e-12);
    if (first == 0) first = ray.opl_mm;
    EXPECT_NEAR(ray.opl_mm, first, 1e-12);
  }
}

TEST(ImmersedObjects, AreImagedByTheAplanaticPointOfASphere) {
  // An object in glass R/n beyond the centre of a sphere: every ray leaves as if from n R beyond it, with
  // sin U' = sin U / n, and the magnification is n² (Born and Wolf, Principles of Optics, ch. 4.2.3).
  const double n = 1.6, radius = 10;
  Lens lens = lens_of({Surface::sphere(-radius, 20)}, 6);
  lens.object_material = glass_of(n);
  lens.object_distance_mm = radius + radius / n;
  const Tracer tracer(lens, 550, INFINITY);
  EXPECT_DOUBLE_EQ(tracer.object_index(), n);
  EXPECT_NEAR(first_order(lens).magnification, n * n, 1e-12);
  EXPECT_NEAR(first_order(lens).paraxial_image_mm, -(radius + n * radius), 1e-11);
  double first = 0;
  for (const double sine : {0.05, 0.3, 0.7}) {
    std::vector<Intersection> met;
    const Ray ray =
        tracer.trace(Ray{{0, 0, -*lens.object_distance_mm}, {0, sine, std::sqrt(1 - sine * sine)}},
                     Tracer::Clip::none, &met);
    ASSERT_EQ(ray.status, RayStatus::ok);
    EXPECT_NEAR(ray.direction[1], sine / n, 1e-14);
    const double way = met[0].point_mm[1] / ray.direction[1];
    EXPECT_NEAR(met[0].point_mm[2] - way * ray.direction[2], -(radius + n * radius), 1e-11);
    // Equal paths to the virtual image.
    const double at_surface = ray.opl_mm - (20 - met[0].point_mm[2]) / ray.direction[2];
    if (first == 0) first = at_surface - way;
    EXPECT_NEAR(at_surface - way, first, 1e-11);
  }
}

TEST(Bends, AreRefusedWhereTheyHaveNoMeaning) {
  const auto fault = [](Lens lens, auto change) {
    change(lens.surfaces[0]);
    try {
      lens.validate();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const Lens plain = lens_of({Surface::sphere(INFINITY, 10)});
  EXPECT_NE(fault(plain,
                  [](Surface& s) {
                    s.grating = Grating{600, 0.5, 0};
                  })
                .find("grating.order"),
            std::string::npos);
  EXPECT_NE(fault(plain,
                  [](Surface& s) {
                    s.grating = Grating{600, 1, 0}, s.asphere[4] = 1e-6;
                  })
                .find("ruled"),
            std::string::npos);
  EXPECT_NE(fault(plain, [](Surface& s) { s.ideal_lens = IdealLens{0}; }).find("focal_length_mm"),
            std::string::npos);
  EXPECT_NE(fault(plain, [](Surface& s) { s.ideal_lens = IdealLens{5}, s.mirror = true; }).find("no mirror"),
            std::string::npos);
}

}  // namespace
}  // namespace petzval
