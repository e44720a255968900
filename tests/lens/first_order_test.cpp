// SPDX-License-Identifier: BSD-3-Clause
// Paraxial optics against textbook formulas.
#include "sample_lenses.h"

#include <petzval/lens/first_order.h>

#include <algorithm>
#include <cmath>

namespace petzval {
namespace {

using namespace testing;

TEST(FirstOrder, ThickLensFollowsTheLensmakersFormula) {
  const double n = 1.6, r1 = 40, r2 = -70, t = 9;
  const Lens lens = lens_of({stop_surface(0), surface(r1, t, n), surface(r2, 50)});
  const double power = (n - 1) * (1 / r1 - 1 / r2 + (n - 1) * t / (n * r1 * r2));
  const FirstOrder data = first_order(lens);
  expect_relative(data.efl_mm, 1 / power, paraxial_precision);
  expect_relative(data.bfl_mm, (1 - (n - 1) * t / (n * r1)) / power, paraxial_precision);
  expect_relative(data.ffl_mm, -(1 + (n - 1) * t / (n * r2)) / power, paraxial_precision);
  expect_relative(data.f_number, 1 / power, paraxial_precision);  // the pupil is 1 mm wide
}

TEST(FirstOrder, BallLens) {
  const double n = 1.5, radius = 10;
  Lens lens = lens_of({surface(radius, 2 * radius, n), surface(-radius, 1)});
  lens.surfaces[0].stop = true;
  expect_relative(first_order(lens).efl_mm, n * radius / (2 * (n - 1)), paraxial_precision);
}

TEST(FirstOrder, TwoThinLensesApart) {
  const double f1 = 100, f2 = -40, d = 70;
  Lens lens = lens_of(joined({thin_lens(f1, d), thin_lens(f2, 10)}));
  lens.surfaces[0].stop = true;
  const FirstOrder data = first_order(lens);
  const double efl = f1 * f2 / (f1 + f2 - d);
  expect_relative(data.efl_mm, efl, paraxial_precision);
  expect_relative(data.bfl_mm, efl * (f1 - d) / f1, paraxial_precision);
}

TEST(FirstOrder, ObjectAndImageObeyNewton) {
  const double n = 1.7, object_mm = 123;
  Lens lens = lens_of({stop_surface(2), surface(30, 6, n), surface(-45, 20)});
  const FirstOrder at_infinity = first_order(lens);
  lens.object_distance_mm = object_mm;
  const FirstOrder near = first_order(lens);
  // x x' = -f^2, both from the focal points, and m = f/x.
  const double x = -object_mm - at_infinity.ffl_mm, f = at_infinity.efl_mm;
  expect_relative(near.paraxial_image_mm, at_infinity.bfl_mm - f * f / x, paraxial_precision);
  expect_relative(near.magnification, f / x, paraxial_precision);
  EXPECT_EQ(near.efl_mm, f);
}

TEST(FirstOrder, PupilsAreImagesOfTheStop) {
  const double f1 = 60, before = 20, f2 = 80, after = 15;
  Lens lens = lens_of(joined({thin_lens(f1, before), {stop_surface(after)}, thin_lens(f2, 90)}));
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 3};
  const FirstOrder data = first_order(lens);
  // 1/s' = 1/f - 1/s of a thin lens; both images are virtual, seen through the lens.
  const double entrance = 1 / (1 / before - 1 / f1), exit = 1 / (1 / after - 1 / f2);
  expect_relative(data.entrance_pupil.position_mm, entrance, paraxial_precision);
  expect_relative(data.entrance_pupil.diameter_mm, 6 * entrance / before, paraxial_precision);
  expect_relative(data.exit_pupil.position_mm, -exit - 90, paraxial_precision);
  expect_relative(data.exit_pupil.diameter_mm, 6 * exit / after, paraxial_precision);
}

TEST(FirstOrder, TelecentricRelayHasItsPupilsAtInfinity) {
  const double f1 = 50, f2 = 25;
  Lens lens = lens_of(joined({thin_lens(f1, f1), {stop_surface(f2)}, thin_lens(f2, f2)}));
  lens.object_distance_mm = f1;
  lens.aperture = {Aperture::Kind::object_na, 0.1};
  lens.fields = {Fields::Kind::object_height_mm, {0, -4}};
  const FirstOrder data = first_order(lens);
  EXPECT_TRUE(std::isinf(data.efl_mm));
  EXPECT_TRUE(std::isinf(data.entrance_pupil.position_mm));
  EXPECT_TRUE(std::isinf(data.entrance_pupil.diameter_mm));
  EXPECT_TRUE(std::isinf(data.exit_pupil.position_mm));
  expect_relative(data.magnification, -f2 / f1, paraxial_precision);
  const double slope = 0.1 / std::sqrt(1 - 0.01);
  expect_relative(data.image_space_na, slope * f1 / f2, paraxial_precision);
  expect_relative(data.stop_semi_diameter_mm, slope * f1, paraxial_precision);
  EXPECT_EQ(data.field_of_view_deg, 0);  // chief rays run parallel to the axis
  expect_relative(data.lagrange_invariant_mm, 4 * slope, paraxial_precision);
}

TEST(FirstOrder, EveryKindOfApertureCanSayTheSame) {
  using Kind = Aperture::Kind;
  Lens lens = lens_of({surface(55, 6, 1.62), stop_surface(4), surface(-80, 2, 1.5), surface(-33, 70)}, 12);
  lens.object_distance_mm = 400;
  const FirstOrder expected = first_order(lens);
  const double u = 6 / (400 + expected.entrance_pupil.position_mm);
  for (const Aperture aperture : {Aperture{Kind::f_number, expected.f_number},
                                  Aperture{Kind::working_f_number, expected.working_f_number},
                                  Aperture{Kind::image_na, expected.image_space_na},
                                  Aperture{Kind::object_na, u / std::sqrt(1 + u * u)},
                                  Aperture{Kind::stop_semi_diameter_mm, expected.stop_semi_diameter_mm}}) {
    lens.aperture = aperture;
    SCOPED_TRACE(static_cast<int>(aperture.kind));
    expect_relative(first_order(lens).entrance_pupil.diameter_mm, 12, paraxial_precision);
    expect_relative(entrance_pupil_diameter_mm(lens, 587.5618), 12, paraxial_precision);
  }
}

TEST(FirstOrder, TheStopIsTheSameAtEveryWavelength) {
  Lens lens = lens_of({surface(50, 5), stop_surface(40)}, 10);
  lens.surfaces[0].material = Material(Material::Model{1.6, 40});
  lens.surfaces.insert(lens.surfaces.begin() + 1, surface(-50, 30));
  lens.wavelengths_nm = {450, 587.5618};
  EXPECT_EQ(first_order(lens, 450).stop_semi_diameter_mm, first_order(lens).stop_semi_diameter_mm);
  // The stop stands behind the lens, where the blue beam is narrower: it must have been wider in front.
  EXPECT_GT(entrance_pupil_diameter_mm(lens, 450), 10.0 + 1e-3);
}

TEST(FirstOrder, ReversedLensSwapsItsFocalPoints) {
  Lens lens =
      lens_of({stop_surface(0), surface(20, 4, 1.7), surface(-60, 3), surface(-25, 2, 1.6), surface(33, 40)});
  Lens reversed =
      lens_of({surface(-33, 2, 1.6), surface(25, 3), surface(60, 4, 1.7), surface(-20, 0), stop_surface(40)});
  const FirstOrder forward = first_order(lens), backward = first_order(reversed);
  expect_relative(backward.efl_mm, forward.efl_mm, paraxial_precision);
  expect_relative(backward.bfl_mm, -forward.ffl_mm, paraxial_precision);
  expect_relative(backward.ffl_mm, -forward.bfl_mm, paraxial_precision);
  expect_relative(backward.petzval_radius_mm, forward.petzval_radius_mm, paraxial_precision);
}

TEST(FirstOrder, PetzvalRadiusOfAThinLensIsMinusNTimesF) {
  Lens lens = lens_of(thin_lens(80, 80));
  lens.surfaces[0].stop = true;
  expect_relative(first_order(lens).petzval_radius_mm, -1.5 * 80, paraxial_precision);
  Lens flat = lens_of(joined({thin_lens(80, 30), thin_lens(-80, 30)}));
  flat.surfaces[0].stop = true;
  EXPECT_TRUE(std::isinf(first_order(flat).petzval_radius_mm));
}

TEST(FirstOrder, ImmersedImageHasTheFocalLengthOfAir) {
  const double n = 1.33, radius = 7.8;  // a simple eye
  Lens lens = lens_of({surface(radius, 30, n)}, 2);
  lens.surfaces[0].stop = true;
  const FirstOrder data = first_order(lens);
  expect_relative(data.efl_mm, radius / (n - 1), paraxial_precision);
  expect_relative(data.bfl_mm, n * radius / (n - 1), paraxial_precision);
  expect_relative(data.working_f_number, data.f_number, paraxial_precision);
  EXPECT_NEAR(data.exit_pupil.position_mm, -30, 30 * paraxial_precision);
}

TEST(FirstOrder, SquareTermOfAnAsphereIsCurvature) {
  Lens lens = lens_of({surface(40, 3, 1.5), surface(0, 70)});
  lens.surfaces[0].stop = true;
  Lens parabola = lens;
  parabola.surfaces[0].curvature_per_mm = 0;
  parabola.surfaces[0].asphere = {{2, 1 / 80.0}, {4, 1e-4}};
  expect_relative(first_order(parabola).efl_mm, first_order(lens).efl_mm, paraxial_precision);
}

TEST(FirstOrder, FieldKindsAgree) {
  Lens lens = lens_of({surface(30, 4, 1.6), surface(-50, 3), stop_surface(45)});
  for (const auto distance_mm : {std::optional<double>(), std::optional<double>(300)}) {
    lens.object_distance_mm = distance_mm;
    lens.fields = {Fields::Kind::angle_deg, {0, 12}};
    const FirstOrder data = first_order(lens);
    EXPECT_EQ(data.field_of_view_deg, 24);
    const double height = paraxial_image_height_mm(lens, 12, 587.5618);
    lens.fields = {Fields::Kind::paraxial_image_height_mm, {height}};
    expect_relative(first_order(lens).field_of_view_deg, 24, paraxial_precision);
    expect_relative(first_order(lens).lagrange_invariant_mm, data.lagrange_invariant_mm, paraxial_precision);
    EXPECT_EQ(paraxial_image_height_mm(lens, 1.5, 587.5618), 1.5);
  }
  lens.fields = {Fields::Kind::object_height_mm, {10}};
  expect_relative(paraxial_image_height_mm(lens, 10, 587.5618), 10 * first_order(lens).magnification,
                  paraxial_precision);
}

TEST(FirstOrder, LightUpwardsLandsAbove) {
  Lens lens = lens_of(joined({{stop_surface(0)}, thin_lens(50, 50)}));
  expect_relative(paraxial_image_height_mm(lens, 10, 587.5618), 50 * std::tan(10 * M_PI / 180),
                  paraxial_precision);
  const ParaxialRay chief = trace_paraxial(lens, 0, 0.1, 587.5618);
  expect_relative(chief.height_mm.back(), 5, paraxial_precision);
  ASSERT_EQ(chief.height_mm.size(), 4u);
  ASSERT_EQ(chief.slope.size(), 3u);
}

TEST(FirstOrder, TracedRayMeetsTheAxisAtTheImage) {
  Lens lens = lens_of({surface(30, 4, 1.6), surface(-50, 3), stop_surface(45)});
  lens.surfaces.back().thickness_mm = paraxial_image_distance_mm(lens, 222, 587.5618);
  const double u = 0.01;
  EXPECT_NEAR(trace_paraxial(lens, 222 * u, u, 587.5618).height_mm.back(), 0, 1e-13);
}

TEST(FirstOrder, FisheyeFieldsBeyondNinetyDegrees) {
  Lens lens = lens_of(joined({{stop_surface(0)}, thin_lens(10, 10)}));
  lens.fields.values = {0, 110};
  EXPECT_EQ(first_order(lens).field_of_view_deg, 220);
  EXPECT_TRUE(std::isinf(paraxial_image_height_mm(lens, 110, 587.5618)));
}

TEST(FirstOrder, ApertureThatTheLensCannotHave) {
  Lens afocal = lens_of(joined({thin_lens(50, 75), thin_lens(25, 10)}));
  afocal.surfaces[0].stop = true;
  EXPECT_TRUE(std::isinf(first_order(afocal).efl_mm));
  EXPECT_TRUE(std::isinf(first_order(afocal).paraxial_image_mm));
  afocal.aperture = {Aperture::Kind::f_number, 4};
  expect_mentions(error_of([&] { first_order(afocal); }), {"afocal", "entrance_pupil_diameter_mm"});
  afocal.aperture = {Aperture::Kind::image_na, 0.1};
  expect_mentions(error_of([&] { first_order(afocal); }), {"collimated"});

  Lens telecentric = lens_of(joined({thin_lens(50, 50), {stop_surface(10)}}));
  expect_mentions(error_of([&] { first_order(telecentric); }), {"telecentric", "stop_semi_diameter_mm"});

  Lens conjugate = lens_of(joined({thin_lens(50, 100), {stop_surface(10)}}));
  conjugate.object_distance_mm = 100;
  expect_mentions(error_of([&] { first_order(conjugate); }), {"image of the object"});
}

}  // namespace
}  // namespace petzval
