// SPDX-License-Identifier: BSD-3-Clause
// Surfaces that are not round: by their formulas in long double, slopes by differences, and through files.
#include <gtest/gtest.h>
#include <petzval/lens/surface_shape.h>

#include <cmath>
#include <functional>

#include "lens/sample_lenses.h"
#include "lens/scratch_file.h"

namespace petzval::testing {
namespace {

using Real = long double;
using Formula = std::function<Real(Real, Real)>;

Surface shaped(double radius_mm, double conic, AddedShape shape) {
  Surface result = surface(radius_mm, 5, 1.5);
  result.conic = conic;
  result.shape = std::move(shape);
  return result;
}

void expect_formula(const Surface& surface, const Formula& sag) {
  const ShapeData<double> shape = shape_of(surface);
  for (const double x : {-3.1, -0.7, 0.0, 1.2, 2.9})
    for (const double y : {-2.7, -1.1, 0.0, 0.4, 3.2}) {
      const SurfacePoint<double> at = surface_point(shape, x, y);
      // Some roundings of a sag of up to 1 mm, and of a slope.
      EXPECT_NEAR(at.sag, static_cast<double>(sag(x, y)), 2e-15) << x << " " << y;
      const Real h = 1e-6L;
      EXPECT_NEAR(at.slope_x, static_cast<double>((sag(x + h, y) - sag(x - h, y)) / (2 * h)), 1e-11);
      EXPECT_NEAR(at.slope_y, static_cast<double>((sag(x, y + h) - sag(x, y - h)) / (2 * h)), 1e-11);
    }
}

Surface biconic() {
  return shaped(40, -0.8, {"biconic", {{"curvature_x_per_mm", {-1 / 55.0}}, {"conic_x", {0.4}}}});
}

TEST(Biconic, HasTheSagOfItsFormula) {
  expect_formula(biconic(), [](Real x, Real y) {
    const Real a = -1 / 55.0, c = 1 / 40.0;
    const Real root = std::sqrt(1 - (1 + 0.4) * a * a * x * x - (1 - Real(0.8)) * c * c * y * y);
    return (a * x * x + c * y * y) / (1 + root);
  });
  EXPECT_NEAR(vertex_curvature_per_mm(biconic()), 1 / 40.0, 1e-16);  // in the y-z plane
}

TEST(Biconic, OfTwoEqualHalvesIsTheConic) {
  Surface conic = surface(40, 5, 1.5),
          both = shaped(40, -0.8, {"biconic", {{"curvature_x_per_mm", {1 / 40.0}}, {"conic_x", {-0.8}}}});
  conic.conic = -0.8;
  for (const double x : {-3.0, 0.5, 2.0})
    EXPECT_NEAR(surface_point(shape_of(conic), x, 1.7).sag, surface_point(shape_of(both), x, 1.7).sag, 1e-16);
}

Surface toroid(double rotation_radius_mm) {
  return shaped(-30, 0.2,
                {"toroid",
                 {{"rotation_curvature_per_mm", {rotation_radius_mm == 0 ? 0 : 1 / rotation_radius_mm}},
                  {"normalisation_radius_mm", {5}},
                  {"coefficients_mm", {0.01, -0.02, 0.003}}}});
}

TEST(Toroid, TurnsItsCurveAboutAnAxis) {
  for (const double radius : {25.0, -70.0}) {
    expect_formula(toroid(radius), [radius](Real x, Real y) {
      const Real c = -1 / 30.0L, u = (y / 5) * (y / 5);
      const Real g = c * y * y / (1 + std::sqrt(1 - Real(1.2) * c * c * y * y)) + Real(0.01) * u -
                     Real(0.02) * u * u + Real(0.003) * u * u * u;
      const Real R = radius, sign = radius < 0 ? -1 : 1;
      return R - sign * std::sqrt((R - g) * (R - g) - x * x);
    });
  }
}

TEST(Toroid, WithoutRotationIsACylinder) {
  const ShapeData<double> shape = shape_of(toroid(0));
  EXPECT_EQ(surface_point(shape, 0, 1.5).sag, surface_point(shape, 3, 1.5).sag);
  EXPECT_EQ(surface_point(shape, 3, 1.5).slope_x, 0);
}

Surface freeform(const char* kind, std::vector<double> coefficients) {
  return shaped(60, -1.5,
                {kind, {{"normalisation_radius_mm", {4}}, {"coefficients_mm", std::move(coefficients)}}});
}

Real base(Real x, Real y) {
  const Real c = 1 / 60.0L, r_sq = x * x + y * y;
  return c * r_sq / (1 + std::sqrt(1 + Real(0.5) * c * c * r_sq));
}

TEST(XyPolynomial, ListsItsTermsByDegree) {
  // x, y, x², xy, y², x³, x²y, xy², y³
  const std::vector<double> a{0.01, -0.02, 0.03, 0.005, -0.01, 0.002, -0.004, 0.001, 0.006};
  expect_formula(freeform("xy_polynomial", a), [&](Real x, Real y) {
    const Real u = x / 4, v = y / 4;
    return base(x, y) + a[0] * u + a[1] * v + a[2] * u * u + a[3] * u * v + a[4] * v * v + a[5] * u * u * u +
           a[6] * u * u * v + a[7] * u * v * v + a[8] * v * v * v;
  });
}

TEST(ZernikeSag, HasNollsPolynomials) {
  // Noll's table I, in polar coordinates.
  const std::vector<std::function<Real(Real, Real)>> z{
      [](Real, Real) { return Real(1); },
      [](Real r, Real t) { return 2 * r * std::cos(t); },
      [](Real r, Real t) { return 2 * r * std::sin(t); },
      [](Real r, Real) { return std::sqrt(Real(3)) * (2 * r * r - 1); },
      [](Real r, Real t) { return std::sqrt(Real(6)) * r * r * std::sin(2 * t); },
      [](Real r, Real t) { return std::sqrt(Real(6)) * r * r * std::cos(2 * t); },
      [](Real r, Real t) { return std::sqrt(Real(8)) * (3 * r * r * r - 2 * r) * std::sin(t); },
      [](Real r, Real t) { return std::sqrt(Real(8)) * (3 * r * r * r - 2 * r) * std::cos(t); },
      [](Real r, Real t) { return std::sqrt(Real(8)) * r * r * r * std::sin(3 * t); },
      [](Real r, Real t) { return std::sqrt(Real(8)) * r * r * r * std::cos(3 * t); },
      [](Real r, Real) { return std::sqrt(Real(5)) * (6 * r * r * r * r - 6 * r * r + 1); },
      [](Real r, Real t) { return std::sqrt(Real(10)) * (4 * r * r * r * r - 3 * r * r) * std::cos(2 * t); },
      [](Real r, Real t) { return std::sqrt(Real(10)) * (4 * r * r * r * r - 3 * r * r) * std::sin(2 * t); },
      [](Real r, Real t) { return std::sqrt(Real(10)) * r * r * r * r * std::cos(4 * t); },
      [](Real r, Real t) { return std::sqrt(Real(10)) * r * r * r * r * std::sin(4 * t); }};
  for (std::size_t j = 0; j < z.size(); ++j) {
    std::vector<double> coefficients(j + 1, 0.0);
    coefficients[j] = 0.01;
    expect_formula(freeform("zernike_sag", coefficients), [&](Real x, Real y) {
      return base(x, y) + 0.01 * z[j](std::sqrt(x * x + y * y) / 4, std::atan2(y, x));
    });
  }
}

TEST(Freeforms, GoThroughZmxFiles) {
  for (const Surface& each :
       {biconic(), toroid(25), toroid(0), freeform("xy_polynomial", {0, 0.01, 0.02, 0, -0.03}),
        freeform("zernike_sag", {0, 0, 0, 0.01, 0.02, 0, 0.003})}) {
    Lens lens = lens_of({stop_surface(5), each, surface(0, 50)}, 6);
    const Lens again = through_file(lens, "freeform.zmx"), native = through_file(lens, "freeform.json");
    ASSERT_TRUE(again.surfaces[1].shape);
    EXPECT_EQ(again.surfaces[1].shape->kind, each.shape->kind);
    EXPECT_EQ(native.surfaces[1].shape->parameters, each.shape->parameters);
    for (const double x : {-2.0, 0.3, 1.9})
      for (const double y : {-1.4, 2.2}) {
        const double sag = surface_point(shape_of(each), x, y).sag;
        EXPECT_NEAR(surface_point(shape_of(again.surfaces[1]), x, y).sag, sag, 1e-15) << each.shape->kind;
      }
    EXPECT_FALSE(is_round(lens));
  }
}

TEST(Freeforms, GrowWithTheLens) {
  for (const Surface& each :
       {biconic(), toroid(25), freeform("zernike_sag", {0, 0, 0, 0.01, 0.02, 0, 0.003})}) {
    const Surface twice = scaled_surface(each, 2);
    EXPECT_NEAR(surface_point(shape_of(twice), 2.4, -3.4).sag,
                2 * surface_point(shape_of(each), 1.2, -1.7).sag, 1e-15);
  }
}

}  // namespace
}  // namespace petzval::testing
