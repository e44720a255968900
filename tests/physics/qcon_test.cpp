// SPDX-License-Identifier: BSD-3-Clause
// Forbes' Qcon asphere against his published polynomials, and a lens with one through everything that asks
// for a shape. Rays of it, and its vectors on every instruction set, are in trace/shapes_test.cpp.
#include <gtest/gtest.h>
#include <petzval/analysis/seidel.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/native.h>
#include <petzval/lens/formats/seq.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/scaled_lens.h>
#include <petzval/lens/surface_kind.h>
#include <petzval/lens/surface_shape.h>
#include <petzval/report/lens_drawing.h>
#include <petzval/trace/tracer.h>

#include <cmath>

namespace petzval {
namespace {

/// Q_m^con as Forbes prints them (Optics Express 15, 5218, 2007, table of section 3).
double published(std::size_t m, double x) {
  switch (m) {
    case 0:
      return 1;
    case 1:
      return -(5 - 6 * x);
    case 2:
      return 15 - 14 * x * (3 - 2 * x);
    case 3:
      return -(35 - 12 * x * (14 - x * (21 - 10 * x)));
    case 4:
      return 70 - 3 * x * (168 - 5 * x * (84 - 11 * x * (8 - 3 * x)));
    default:
      return -(126 - x * (1260 - 11 * x * (420 - x * (720 - 13 * x * (45 - 14 * x)))));
  }
}

Surface qcon(double radius_mm, double conic, double normalisation_mm, std::vector<double> coefficients) {
  Surface surface;
  surface.curvature_per_mm = 1 / radius_mm;
  surface.conic = conic;
  surface.shape = AddedShape{
      "qcon",
      {{"normalisation_radius_mm", {normalisation_mm}}, {"coefficients_mm", std::move(coefficients)}}};
  return surface;
}

/// The same surface by powers of r: A_0 u⁴ + A_1 u⁴(6u² − 5) + A_2 u⁴(15 − 42u² + 28u⁴).
Surface by_powers(double radius_mm, double conic, double n, const std::array<double, 3>& a) {
  Surface surface;
  surface.curvature_per_mm = 1 / radius_mm;
  surface.conic = conic;
  surface.asphere = {{4, (a[0] - 5 * a[1] + 15 * a[2]) / std::pow(n, 4)},
                     {6, (6 * a[1] - 42 * a[2]) / std::pow(n, 6)},
                     {8, 28 * a[2] / std::pow(n, 8)}};
  return surface;
}

Lens singlet(Surface front) {
  Lens lens;
  lens.name = "singlet";
  front.thickness_mm = 3;
  front.material = Material(Material::Constant{1.5});
  front.stop = true;
  Surface back;
  back.thickness_mm = 38;
  lens.surfaces = {front, back};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 4};
  lens.fields.values = {0, 5};
  lens.wavelengths_nm = {550};
  lens.reference_wavelength_nm = 550;
  return lens;
}

constexpr std::array<double, 3> small{0.02, -0.004, 0.001};

Lens with_qcon() {
  return singlet(qcon(20, -0.6, 5, {small.begin(), small.end()}));
}

TEST(Qcon, SagIsThatOfThePublishedPolynomials) {
  for (std::size_t m = 0; m < 6; ++m) {
    std::vector<double> coefficients(m + 1, 0.0);
    coefficients[m] = 0.01;
    const ShapeData<double> shape = shape_of(qcon(-30, 0.3, 6, coefficients));
    for (const double r : {0.0, 1.0, 2.5, 4.0, 5.5, 6.0}) {
      const double x = r * r / 36, root = std::sqrt(1 - 1.3 * r * r / 900);
      EXPECT_NEAR(surface_point(shape, 0.6 * r, 0.8 * r).sag,
                  -r * r / 30 / (1 + root) + 0.01 * x * x * published(m, x), 1e-14)
          << "m " << m << ", r " << r;
    }
  }
}

TEST(Qcon, IsOneAtTheRimForEveryTerm) {
  // Q_m(1) = 1, also far beyond the terms that are printed.
  for (std::size_t m = 0; m < 30; ++m) {
    std::vector<double> coefficients(m + 1, 0.0);
    coefficients[m] = 1;
    const Surface surface = qcon(1e9, 0, 5, coefficients);
    EXPECT_NEAR(surface_point(shape_of(surface), 5, 0).sag, 1, 2e-8) << m;  // 1.25e-8 is the sphere's
  }
}

TEST(Qcon, TracesLikeItsPowersOfR) {
  const Lens lens = with_qcon(), powers = singlet(by_powers(20, -0.6, 5, small));
  const Tracer a(lens, 550), b(powers, 550);
  for (const double h : {-3.9, -2.0, 0.0, 1.1, 3.8})
    for (const double m : {-0.1, 0.0, 0.15}) {
      const Ray start{{0.3, h, -2}, {0, m, std::sqrt(1 - m * m)}};
      const Ray ra = a.trace(start, Tracer::Clip::none), rb = b.trace(start, Tracer::Clip::none);
      ASSERT_EQ(ra.status, RayStatus::ok);
      for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(ra.point_mm[axis], rb.point_mm[axis], 3e-12);
      EXPECT_NEAR(ra.opl_mm, rb.opl_mm, 3e-12);
    }
}

TEST(Qcon, HasTheParaxialAndSeidelDataOfItsPowersOfR) {
  const Lens lens = with_qcon(), powers = singlet(by_powers(20, -0.6, 5, small));
  EXPECT_NEAR(first_order(lens).efl_mm, first_order(powers).efl_mm, 1e-12);
  const double expected = seidel_sums(powers).sum.s1;
  EXPECT_NEAR(seidel_sums(lens).sum.s1, expected, 1e-12 * std::abs(expected));
  EXPECT_GT(std::abs(seidel_sums(singlet(qcon(20, -0.6, 5, {}))).sum.s1 - expected),
            0.1 * std::abs(expected));
  for (const double r : {0.0, 2.0, 4.5}) {
    const auto one = principal_curvatures(shape_of(lens.surfaces[0]), r);
    const auto other = principal_curvatures(shape_of(powers.surfaces[0]), r);
    EXPECT_NEAR(one.meridional, other.meridional, 1e-14);
    EXPECT_NEAR(one.sagittal, other.sagittal, 1e-14);
  }
}

TEST(Qcon, ScalesLikeItsPowersOfR) {
  const ShapeData<double> one = shape_of(scaled_lens(with_qcon(), 3).surfaces[0]);
  const ShapeData<double> other =
      shape_of(scaled_lens(singlet(by_powers(20, -0.6, 5, small)), 3).surfaces[0]);
  for (const double r : {3.0, 9.0, 14.0})
    EXPECT_NEAR(surface_point(one, r, 0).sag, surface_point(other, r, 0).sag, 1e-13);
}

TEST(Qcon, GoesThroughTheNativeFormatAndItsSettings) {
  const Lens lens = with_qcon(), again = lens_from_json(lens_to_json(lens), "lens.json", {});
  EXPECT_EQ(again.surfaces[0].shape->kind, "qcon");
  EXPECT_EQ(again.surfaces[0].shape->parameters, lens.surfaces[0].shape->parameters);
  const Lens set = with_setting(lens, "surfaces[0].shape.coefficients_mm[1]=0.5", {});
  EXPECT_EQ(shape_numbers(set.surfaces[0], "coefficients_mm"), (std::vector<double>{0.02, 0.5, 0.001}));
  EXPECT_FALSE(with_setting(lens, "surfaces[0].shape=null", {}).surfaces[0].shape);
  EXPECT_EQ(shape_remarks(lens.surfaces[0]).back(),
            "qcon, coefficients_mm 0.02 -0.004 0.001, normalisation_radius_mm 5");
  LensDrawingOptions drawn;
  drawn.semi_diameters_mm = {4.5, 4.5};
  EXPECT_NE(draw_lens(lens, {}, drawn), draw_lens(singlet(qcon(20, -0.6, 5, {0.5})), {}, drawn));
}

TEST(Qcon, SaysWhatIsWrong) {
  const auto complaint = [](const std::string& assignment) -> std::string {
    try {
      with_setting(with_qcon(), assignment, {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto expect = [&](const std::string& assignment, const std::string& words) {
    EXPECT_NE(complaint(assignment).find(words), std::string::npos) << complaint(assignment);
  };
  expect("surfaces[0].shape.kind=potato", "is not a kind of surface; these are: qcon");
  expect("surfaces[0].shape.normalisation_radius_mm=-1",
         "must be the radius in mm at which u is 1, and positive");
  expect("surfaces[0].shape.radius=3", "radius");
  expect("surfaces[0].asphere={\"4\": 1e-6}", "stands in place of powers of r");
  expect("surfaces[0].shape.coefficients_mm=3", "must be a list");
  EXPECT_THROW(seq_text(with_qcon()), InputError);
}

}  // namespace
}  // namespace petzval
