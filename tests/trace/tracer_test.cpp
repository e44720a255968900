// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/trace/pencil.h>
#include <petzval/trace/pupil.h>
#include <petzval/trace/tracer.h>

#include <cmath>
#include <random>

#include "physics/independent_tracer.h"
#include "trace/sample_lenses.h"

namespace petzval {
namespace {

using sample::random_ray;
using sample::surface;
using sample::triplet_like;

TEST(Tracer, AgreesWithTheIndependentTracerOnSpheres) {
  const Lens lens = triplet_like();
  const Tracer tracer(lens, 550);
  const independent::SphereTracer second(lens, 550, 1e9L);
  std::mt19937_64 random(7);
  for (int i = 0; i < 500; ++i) {
    const Ray start = random_ray(random);
    const Ray ours = tracer.trace(start, Tracer::Clip::none);
    independent::IndependentRay other{};
    for (int a = 0; a < 3; ++a) other.point[a] = start.point_mm[a], other.direction[a] = start.direction[a];
    const auto theirs = second.trace(other, false, false);
    ASSERT_TRUE(theirs && ours.status == RayStatus::ok);
    const auto t = (second.image_z() - theirs->point[2]) / theirs->direction[2];
    const auto image = independent::along(theirs->point, theirs->direction, t);
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(ours.point_mm[a], double(image[a]), 1e-12);  // 44 mm of path in double
      EXPECT_NEAR(ours.direction[a], double(theirs->direction[a]), 1e-14);
    }
    EXPECT_NEAR(ours.opl_mm, double(theirs->path + t), 1e-12);
  }
}

TEST(Tracer, RunsBackwardsAlongTheSameRay) {
  const Lens lens = triplet_like();
  const Tracer tracer(lens, 550);
  std::mt19937_64 random(8);
  for (int i = 0; i < 200; ++i) {
    const Ray start = random_ray(random);
    std::vector<Intersection> path;
    Ray there = tracer.trace(start, Tracer::Clip::none, &path);
    ASSERT_EQ(there.status, RayStatus::ok);
    ASSERT_EQ(path.size(), lens.surfaces.size() + 1);
    Ray back = there;
    for (double& cosine : back.direction) cosine = -cosine;
    back.opl_mm = 0;
    back = tracer.trace_backward(back, Tracer::Clip::none);
    ASSERT_EQ(back.status, RayStatus::ok);
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(back.point_mm[a], path.front().point_mm[a], 1e-12);
      EXPECT_NEAR(back.direction[a], -start.direction[a], 1e-14);
    }
    double to_first = 0;
    for (int a = 0; a < 3; ++a)
      to_first += (path.front().point_mm[a] - start.point_mm[a]) * start.direction[a];
    EXPECT_NEAR(back.opl_mm, there.opl_mm - to_first, 1e-12);
  }
}

TEST(Tracer, HyperboloidFocusesACollimatedBeamWithoutAberration) {
  // A plano-convex lens whose rear is a hyperboloid with k = −n² images an axial beam to a point (Descartes
  // 1637).
  const double n = 1.5, radius = -20;
  Lens lens;
  lens.surfaces = {surface(0, 5, n), surface(radius, 40, 1)};  // focus at −R/(n−1) = 40 mm
  lens.surfaces[0].stop = true;
  lens.surfaces[1].conic = -n * n;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 12};
  const Tracer tracer(lens, 550);
  const double axial = tracer.trace(Ray{{0, 0, 0}, {0, 0, 1}}).opl_mm;
  for (const double h : {1.0, 5.0, 9.0, 12.0}) {
    const Ray ray = tracer.trace(Ray{{h * 0.6, h * 0.8, 0}, {0, 0, 1}});
    ASSERT_EQ(ray.status, RayStatus::ok);
    EXPECT_NEAR(ray.point_mm[0], 0, 1e-12);
    EXPECT_NEAR(ray.point_mm[1], 0, 1e-12);
    EXPECT_NEAR(ray.opl_mm, axial, 1e-12);
  }
}

TEST(Tracer, AsphereCoefficientsOfASphereTraceLikeTheSphere) {
  // A sphere's sag as a power series, on a flat base: r²/2R + r⁴/8R³ + r⁶/16R⁵ + 5r⁸/128R⁷ + 7r¹⁰/256R⁹ + ….
  const double R = 40;
  Lens sphere, series;
  sphere.surfaces = {surface(R, 50, 1.6)};
  sphere.surfaces[0].stop = true;
  sphere.aperture = {Aperture::Kind::stop_semi_diameter_mm, 4};
  series = sphere;
  series.surfaces[0].curvature_per_mm = 0;
  series.surfaces[0].asphere = {{2, 1 / (2 * R)},
                                {4, 1 / (8 * std::pow(R, 3))},
                                {6, 1 / (16 * std::pow(R, 5))},
                                {8, 5 / (128 * std::pow(R, 7))},
                                {10, 7 / (256 * std::pow(R, 9))}};
  const Tracer a(sphere, 550), b(series, 550);
  // The first term left out, 21 r¹²/1024R¹¹, is 1.7e-14 mm at r = 2.5 mm.
  for (const double h : {-2.5, -1.0, 0.3, 2.4}) {
    const Ray start{{0.1, h, -3}, {0, 0.05, std::sqrt(1 - 0.0025)}};
    const Ray ra = a.trace(start), rb = b.trace(start);
    ASSERT_EQ(rb.status, RayStatus::ok);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(ra.point_mm[axis], rb.point_mm[axis], 3e-12);
    EXPECT_NEAR(ra.opl_mm, rb.opl_mm, 3e-12);
  }
}

TEST(Tracer, OddAspheresMeetTheirOwnEquation) {
  Lens lens;
  lens.surfaces = {surface(8, 5, 1.54)};
  lens.surfaces[0].stop = true;
  lens.surfaces[0].conic = -0.7;
  lens.surfaces[0].asphere = {{3, 1e-3}, {4, -2e-3}, {5, 4e-4}, {6, 1e-5}};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 3};
  const Tracer tracer(lens, 550);
  for (const double y : {-2.0, -0.7, 0.0, 1.1, 2.2}) {
    std::vector<Intersection> path;
    ASSERT_EQ(tracer.trace(Ray{{0.3, y, -1}, {0, 0, 1}}, Tracer::Clip::none, &path).status, RayStatus::ok);
    const auto& p = path.front().point_mm;
    const double c = 1.0 / 8, r = std::hypot(p[0], p[1]);
    const double sag = c * r * r / (1 + std::sqrt(1 - 0.3 * c * c * r * r)) + 1e-3 * std::pow(r, 3) -
                       2e-3 * std::pow(r, 4) + 4e-4 * std::pow(r, 5) + 1e-5 * std::pow(r, 6);
    EXPECT_NEAR(p[2], sag, 1.1e-12);
    // The normal is perpendicular to the surface: against a finite difference of the sag along r.
    EXPECT_NEAR(std::hypot(path.front().normal[0], path.front().normal[1], path.front().normal[2]), 1, 1e-14);
  }
}

TEST(Tracer, SaysHowARayFails) {
  Lens lens = triplet_like();
  lens.surfaces[0].semi_diameter_mm = 4;
  const Tracer tracer(lens, 550);
  const Ray missed = tracer.trace(Ray{{0, 30, -5}, {0, 0, 1}});
  EXPECT_EQ(missed.status, RayStatus::missed);
  EXPECT_EQ(missed.failed_at, 0);
  const Ray clipped = tracer.trace(Ray{{0, 4.5, -5}, {0, 0, 1}});
  EXPECT_EQ(clipped.status, RayStatus::vignetted);
  EXPECT_EQ(clipped.failed_at, 0);
  const Ray stopped = tracer.trace(Ray{{0, 2.5, -5}, {0, 0, 1}});
  EXPECT_EQ(stopped.status, RayStatus::vignetted);
  EXPECT_EQ(stopped.failed_at, 2);
  // From glass at 60°, beyond the critical angle of 1/1.62.
  Lens slab;
  slab.surfaces = {surface(0, 5, 1.62), surface(-3, 5, 1)};
  slab.surfaces[0].stop = true;
  slab.aperture = {Aperture::Kind::stop_semi_diameter_mm, 5};
  const Ray reflected = Tracer(slab, 550).trace(Ray{{0, 2.5, -1}, {0, 0, 1}});
  EXPECT_EQ(reflected.status, RayStatus::tir);
  EXPECT_EQ(reflected.failed_at, 1);
}

TEST(StopRadius, IsTheRimWhereTheParaxialPupilIsWiderThanTheGlass) {
  // A ball of 10 mm radius asked for f/0.4: the paraxial pupil is wider than the ball.
  Lens lens;
  lens.name = "ball";
  lens.surfaces = {surface(10, 20, 1.5), surface(-10, 2, 1), surface(0, 3, 1)};
  lens.surfaces[2].stop = true;
  lens.aperture = {Aperture::Kind::f_number, 0.4};
  EXPECT_THROW(stop_radius_mm(lens), InputError);
  lens.surfaces[2].semi_diameter_mm = 1.25;
  EXPECT_EQ(stop_radius_mm(lens), 1.25);
}

TEST(Pencil, ChiefRayPassesTheStopCentre) {
  const Lens lens = triplet_like();
  const Tracer tracer(lens, 550);
  ChiefRayMarch march(lens, tracer);
  for (const double field : {0.0, 3.0, 10.0, 20.0, -15.0}) {
    const std::optional<double> v = march.v_at(field);
    ASSERT_TRUE(v) << field;
    const auto at = Pencil::from_object(lens, field).clearance(tracer, 0, *v, Tracer::Clip::none);
    EXPECT_NEAR(at.stop_y_mm, 0, 1e-12);
  }
}

// However near the object is, a bounded number of steps leads out to a field of it.
TEST(Pencil, ChiefRaysOfObjectsThatAllButTouchTheLens) {
  constexpr double height_mm = 0.05;
  for (const double distance_mm : {1e-2, 1e-300}) {
    Lens lens = triplet_like();
    lens.object_distance_mm = distance_mm;
    const Tracer tracer(lens, 550);
    ChiefRayMarch march(lens, tracer);
    const std::optional<double> v = march.v_at(height_mm);
    ASSERT_EQ(v.has_value(), distance_mm > 1e-100) << distance_mm;  // from the glass itself rays have no way
    if (!v) continue;
    const auto at = Pencil::from_object(lens, height_mm).clearance(tracer, 0, *v, Tracer::Clip::none);
    EXPECT_NEAR(at.stop_y_mm, 0, 1e-9);
  }
}

TEST(Pencil, NoChiefRayThroughAnOpaqueField) {
  Lens lens = triplet_like();
  EXPECT_THROW(Pencil::from_object(lens, 181), InputError);
  lens.surfaces[0].curvature_per_mm = 1 / 3.5;  // a ball lens in front: steep fields miss it
  const Tracer tracer(lens, 550);
  ChiefRayMarch march(lens, tracer);
  EXPECT_FALSE(march.v_at(120.0));
}

TEST(Pupil, OfABareStopIsTheStop) {
  Lens lens;
  lens.surfaces = {surface(0, 50, 1)};
  lens.surfaces[0].stop = true;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 2};
  const Tracer tracer(lens, 550);
  for (const double angle : {0.0, 30.0, 60.0}) {
    const Pencil pencil = Pencil::from_object(lens, angle);
    const auto pupil = find_pupil(tracer, pencil, *aim_chief_ray(tracer, pencil, 0), 256);
    ASSERT_TRUE(pupil);
    // The projected disc, an ellipse of axis ratio cos θ: smooth, so that the trapezoid rule is exact to
    // rounding.
    EXPECT_NEAR(pupil->area(), M_PI * 4 * std::cos(angle * M_PI / 180), 1e-7) << angle;
    double sum = 0;
    for (const PupilNode& node : pupil_nodes(*pupil, 8)) sum += node.weight;
    EXPECT_NEAR(sum, pupil->area(), 1e-12);
  }
}

TEST(Pupil, OfTwoDiscsIsTheirLens) {
  // A stop and, 10 mm behind it, a ring: at angle θ their shadows overlap in the classical lens of two
  // circles.
  Lens lens;
  lens.surfaces = {surface(0, 10, 1), surface(0, 40, 1)};
  lens.surfaces[0].stop = true;
  lens.surfaces[1].semi_diameter_mm = 2;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 2};
  const Tracer tracer(lens, 550);
  for (const double shift : {1.0, 2.0, 3.0, 3.6}) {  // the last ones clip the chief ray itself
    const double angle = std::atan(shift / 10);
    const Pencil pencil = Pencil::from_object(lens, angle * 180 / M_PI);
    const auto pupil = find_pupil(tracer, pencil, *aim_chief_ray(tracer, pencil, 0), 2048);
    ASSERT_TRUE(pupil) << shift;
    const double r = 2, overlap = 2 * r * r * std::acos(shift / (2 * r)) -
                                  0.5 * shift * std::sqrt(4 * r * r - shift * shift);
    EXPECT_NEAR(pupil->area() / (overlap * std::cos(angle)), 1, 1e-5)
        << shift;  // corners: error as 1/azimuths²
  }
  const Pencil beyond = Pencil::from_object(lens, std::atan(0.41) * 180 / M_PI);
  EXPECT_FALSE(find_pupil(tracer, beyond, *aim_chief_ray(tracer, beyond, 0), 64));
}

}  // namespace
}  // namespace petzval
