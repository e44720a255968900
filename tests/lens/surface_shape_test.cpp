// SPDX-License-Identifier: BSD-3-Clause
// The geometry of surfaces, against their formulas and against differences of the sag.
#include <gtest/gtest.h>
#include <petzval/lens/surface_shape.h>

#include <cmath>

#include "sample_lenses.h"

namespace petzval {
namespace {

Surface curved(double radius_mm, double conic = 0, std::map<int, double> powers = {}) {
  Surface surface;
  surface.curvature_per_mm = 1 / radius_mm;
  surface.conic = conic;
  surface.asphere = std::move(powers);
  return surface;
}

double sag(const Surface& surface, double x, double y) {
  return surface_point(shape_of(surface), x, y).sag;
}

const std::vector<Surface>& samples() {
  static const std::vector<Surface> all{curved(20), curved(-15, -2), curved(12, 0.5),
                                        curved(-18, -0.4, {{2, 1e-3}, {4, 3e-5}, {8, -2e-9}}),
                                        curved(25, 0, {{3, 2e-4}, {4, -1e-5}, {7, 1e-8}})};
  return all;
}

TEST(SurfaceShape, SagIsThatOfTheFormula) {
  EXPECT_NEAR(sag(curved(10, -1), 0, 4), 0.8, 1e-15);  // a paraboloid, r²/2R
  EXPECT_NEAR(sag(curved(10, -1, {{4, 1e-3}}), 0, -4), 0.8 + 0.256, 1e-15);
  EXPECT_NEAR(sag(curved(10, -1, {{3, 1e-3}}), 2.4, 3.2), 0.8 + 0.064, 1e-15);
  EXPECT_NEAR(sag(curved(-13), 3, 4), -1, 1e-14);  // 5, 12, 13
}

TEST(SurfaceShape, EndsAtTheRim) {
  EXPECT_DOUBLE_EQ(rim_mm(shape_of(curved(-8))), 8);
  EXPECT_DOUBLE_EQ(rim_mm(shape_of(curved(8, 3))), 4);
  EXPECT_TRUE(std::isinf(rim_mm(shape_of(curved(8, -1)))));
  EXPECT_TRUE(std::isnan(sag(curved(8), 0, 8.01)));
  EXPECT_FALSE(std::isnan(sag(curved(8), 0, 7.99)));
}

TEST(SurfaceShape, SlopesAreDifferencesOfTheSag) {
  for (const Surface& surface : samples())
    for (const double x : {-3.0, 0.0, 1.5})
      for (const double y : {-2.0, 0.7, 3.5}) {
        const SurfacePoint<double> point = surface_point(shape_of(surface), x, y);
        const double h = 1e-4;  // h² times a third derivative, and 1e-16/h
        EXPECT_NEAR(point.slope_x, (sag(surface, x + h, y) - sag(surface, x - h, y)) / (2 * h), 1e-10);
        EXPECT_NEAR(point.slope_y, (sag(surface, x, y + h) - sag(surface, x, y - h)) / (2 * h), 1e-10);
      }
}

TEST(SurfaceShape, PrincipalCurvaturesOfASphereAreItsOwn) {
  for (const double r : {0.0, 1.0, 7.5, 14.0}) {
    const auto [meridional, sagittal] = principal_curvatures(shape_of(curved(-15)), r);
    EXPECT_NEAR(meridional, -1 / 15.0, 1e-14);
    EXPECT_NEAR(sagittal, -1 / 15.0, 1e-14);
  }
}

TEST(SurfaceShape, PrincipalCurvaturesAreThoseOfTheProfile) {
  for (const Surface& surface : samples())
    for (const double r : {0.5, 2.0, 5.0}) {
      const auto slope = [&](double at) { return surface_point(shape_of(surface), at, 0).slope_x; };
      const double h = 1e-5, z1 = slope(r), length = std::sqrt(1 + z1 * z1);
      const double z2 = (slope(r + h) - slope(r - h)) / (2 * h);
      const auto [meridional, sagittal] = principal_curvatures(shape_of(surface), r);
      EXPECT_NEAR(meridional, z2 / (length * length * length), 1e-9);
      EXPECT_NEAR(sagittal, z1 / (r * length), 1e-15);
    }
}

TEST(SurfaceShape, SeriesAtTheVertexIsThatOfTheSag) {
  for (const Surface& surface : samples()) {
    if (surface.asphere.count(3)) continue;  // no such series
    const auto [c, g] = vertex_series(surface);
    // What is left over is of sixth order.
    for (const double r : {0.1, 0.2, 0.4})
      EXPECT_NEAR(sag(surface, r, 0), c * r * r / 2 + g * std::pow(r, 4) / 8, 2e-6 * std::pow(r, 6));
    EXPECT_EQ(c, vertex_curvature_per_mm(surface));
  }
}

TEST(SurfaceShape, ScalesAsAWhole) {
  for (const Surface& surface : samples())
    for (const double r : {0.5, 3.0})
      EXPECT_NEAR(sag(scaled_surface(surface, 2.5), 2.5 * r, 0), 2.5 * sag(surface, r, 0), 1e-14);
}

TEST(SurfaceShape, TermsOfZeroDoNotCount) {
  EXPECT_EQ(shape_of(curved(20, 0, {{4, 0.0}})).form, ShapeForm::sphere);
  EXPECT_EQ(shape_of(curved(20, 0, {{3, 0.0}, {4, 1e-5}})).form, ShapeForm::powers);
  EXPECT_TRUE(is_flat(Surface{}));
  EXPECT_FALSE(is_flat(curved(20)));
  EXPECT_TRUE(is_spherical(curved(20)));
  EXPECT_FALSE(is_spherical(curved(20, -1)));
}

TEST(SurfaceShape, UnknownKindsAreRefused) {
  Surface surface = curved(20);
  surface.shape = AddedShape{"potato", {}};
  EXPECT_THROW(shape_of(surface), InputError);
  Lens lens;
  surface.stop = true;
  lens.surfaces = {surface};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 1};
  EXPECT_NE(
      testing::error_of([&] { lens.validate(); }).find("surfaces[0].shape.kind is not a kind of surface"),
      std::string::npos);
}

}  // namespace
}  // namespace petzval
