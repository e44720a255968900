// SPDX-License-Identifier: BSD-3-Clause
// Analyses by field of lenses with poses: closed forms of a pinhole over a tilted sensor and of a grating, a
// lens turned as a whole, sums of squares, and a pose too small to matter.
#include <gtest/gtest.h>
#include <petzval/analysis/aberration_fans.h>
#include <petzval/analysis/chromatic.h>
#include <petzval/analysis/field_curvature.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/tv_distortion.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/analysis/wavefront_zernike.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>

#include <cmath>

namespace petzval {
namespace {

FieldTableRequest fields_of(std::vector<double> fields, double azimuth_deg = 0) {
  FieldTableRequest request;
  request.fields = std::move(fields);
  request.wavelengths_nm = {550};
  request.azimuth_deg = azimuth_deg;
  return request;
}

/// An ideal lens, whose chief rays go straight on, in front of a sensor that is turned.
Lens pinhole(double tilt_x_deg, double tilt_y_deg) {
  Lens lens;
  lens.name = "ideal";
  lens.surfaces = {Surface::sphere(INFINITY, 20)};
  lens.surfaces[0].stop = true;
  lens.surfaces[0].ideal_lens = IdealLens{20};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 1};
  lens.fields.values = {0, 20};
  lens.wavelengths_nm = {550};
  lens.reference_wavelength_nm = 550;
  lens.sensor_pose.tilt_x_deg = tilt_x_deg, lens.sensor_pose.tilt_y_deg = tilt_y_deg;
  return lens;
}

TEST(PosedAnalyses, DistortionOfATiltedSensorIsThatOfAKeystone) {
  // At a distance d, turned by τ: y' = d sin θ / cos(θ ± τ), and d θ / cos τ in the middle.
  const double tilt = 10, theta = 15;
  const auto rows = distortion_table(pinhole(tilt, 0), fields_of({-theta, 0, theta}));
  const auto keystone = [&](double sign) {
    return 100 *
           (std::cos(radians(theta)) * std::cos(radians(tilt)) / std::cos(radians(theta + sign * tilt)) - 1);
  };
  const double one = keystone(1), other = keystone(-1);
  const bool swapped = std::abs(rows[2].distortion_percent - one) > 0.1;
  EXPECT_NEAR(rows[2].distortion_percent, swapped ? other : one, 1e-5);
  EXPECT_NEAR(rows[0].distortion_percent, swapped ? one : other, 1e-5);
  EXPECT_EQ(rows[1].distortion_percent, 0);
  EXPECT_NEAR(rows[0].across_percent, 0, 1e-9);
  // A field along x meets the same sensor askew: the ray lands beside the field by the same law.
  const auto beside = distortion_table(pinhole(0, tilt), fields_of({theta}));
  EXPECT_NEAR(beside[0].distortion_percent, 0, 1e-5);
  const double moved = distortion_table(pinhole(0, tilt), fields_of({theta}, 45))[0].across_percent;
  EXPECT_GT(std::abs(moved), 0.1);
}

TEST(PosedAnalyses, TvDistortionOfATiltedSensor) {
  // Sides of the rectangle are 1/(1 ∓ X tan τ) as high as in the middle, X the tangent of their field.
  const double tilt = 8;
  const FrameSize frame{8, 6};
  const double x = 4.0 / 20, t = std::tan(radians(tilt));
  const auto rows = tv_distortion(pinhole(0, tilt), frame, std::vector<double>{550});
  EXPECT_NEAR(rows[0].smia_percent, 100 * x * x * t * t / (1 - x * x * t * t), 1e-6);
  EXPECT_NEAR(tv_distortion(pinhole(0, 0), frame, std::vector<double>{550})[0].smia_percent, 0, 1e-9);
}

TEST(PosedAnalyses, FocalLinesOfAnIdealLensLieInItsFlatField) {
  // Off a sensor turned by τ the plane stands d tan θ sin τ, in the sensor's own axes.
  for (const double tilt : {0.0, 3.0}) {
    const auto row = field_curvature_table(pinhole(tilt, 0), fields_of({12})).front();
    const double off = row.tangential_mm;
    EXPECT_NEAR(row.sagittal_mm, off, 1e-5);
    EXPECT_NEAR(std::abs(off), 20 * std::tan(radians(12)) * std::sin(radians(tilt)), 1e-5);
  }
}

TEST(PosedAnalyses, LateralColourOfAGratingIsItsDispersion) {
  // Behind 300 lines/mm an ideal lens of 50 mm puts λ at f tan(asin(λ G)).
  Lens lens = pinhole(0, 0);
  lens.surfaces.insert(lens.surfaces.begin(), Surface::sphere(INFINITY, 1e-9));
  lens.surfaces[0].stop = true, lens.surfaces[1].stop = false;
  lens.surfaces[0].grating = Grating{300, 1, 0};
  lens.surfaces[1].ideal_lens = IdealLens{50}, lens.surfaces[1].thickness_mm = 50;
  FieldTableRequest request = fields_of({0});
  request.wavelengths_nm = {500, 600};
  const auto at = [](double nm) { return 50 * std::tan(std::asin(300 * nm * 1e-6)); };
  for (const LateralColourRow& row : lateral_colour_table(lens, request)) {
    EXPECT_NEAR(row.lateral_colour_um, 1e3 * (at(row.wavelength_nm) - at(550)), 1e-3);
    EXPECT_NEAR(row.across_um, 0, 1e-6);
  }
  request.azimuth_deg = 90;
  for (const LateralColourRow& row : lateral_colour_table(lens, request))
    EXPECT_NEAR(std::abs(row.across_um), std::abs(1e3 * (at(row.wavelength_nm) - at(550))), 1e-3);
}

TEST(PosedAnalyses, ALensTurnedAsAWholeShowsTheFieldMoved) {
  // By 2° about x: its own 8° are 6° or 10° of space.
  const Lens lens = read_lens("dgauss-50mm").lens;
  Lens turned = lens;
  turned.groups = {{0, lens.surfaces.size(), {0, 0, 0, 2, 0, 0}, 7}};
  const auto own_fans = aberration_fans(lens, fields_of({8}), 9).front();
  double field = 6;
  if (std::abs(aberration_fans(turned, fields_of({6}), 9).front().real_image_height_mm -
               own_fans.real_image_height_mm) > 1e-6)
    field = 10;
  const auto fans = aberration_fans(turned, fields_of({field}), 9).front();
  ASSERT_EQ(fans.tangential.size(), own_fans.tangential.size());
  ASSERT_EQ(fans.sagittal.size(), own_fans.sagittal.size());
  for (std::size_t i = 0; i < fans.tangential.size(); ++i) {
    EXPECT_NEAR(fans.tangential[i].y_um, own_fans.tangential[i].y_um, 1e-4);
    EXPECT_NEAR(fans.tangential[i].opd_waves, own_fans.tangential[i].opd_waves, 1e-5);
  }
  for (std::size_t i = 0; i < fans.sagittal.size(); ++i)
    EXPECT_NEAR(fans.sagittal[i].x_um, own_fans.sagittal[i].x_um, 1e-4);
  const auto own_terms = zernike_table(lens, fields_of({8}), ZernikeOrder::noll, 22).front();
  const auto terms = zernike_table(turned, fields_of({field}), ZernikeOrder::noll, 22).front();
  // Pupils of the two are sampled at other azimuths, whose corners converge as their square.
  for (std::size_t i = 0; i < terms.coefficients.size(); ++i)
    EXPECT_NEAR(terms.coefficients[i], own_terms.coefficients[i], 2e-3) << i + 1;
  // Coddington's equations against neighbouring rays; the sensor turns with the lens.
  const auto own_foci = field_curvature_table(lens, fields_of({8})).front();
  const auto foci = field_curvature_table(turned, fields_of({field})).front();
  EXPECT_NEAR(foci.tangential_mm, own_foci.tangential_mm, 1e-4);
  EXPECT_NEAR(foci.sagittal_mm, own_foci.sagittal_mm, 1e-4);
}

TEST(PosedAnalyses, ZernikeTermsOfATiltedElementSumToTheWavefront) {
  // Noll's terms are orthonormal over a full pupil: the squares of all but the first, and of what they leave,
  // are the variance.
  Lens lens = read_lens("cooke-triplet").lens;
  for (Surface& surface : lens.surfaces) surface.semi_diameter_mm.reset();
  lens.groups = {{2, 3, {0.03, -0.02, 0, 0.1, 0.05, 0}, 0}};
  const auto row = zernike_table(lens, fields_of({4}), ZernikeOrder::noll, 36).front();
  double squares = row.rms_residual_waves * row.rms_residual_waves;
  for (std::size_t i = 1; i < row.coefficients.size(); ++i)
    squares += row.coefficients[i] * row.coefficients[i];
  const double rms = wavefront_table(lens, fields_of({4})).front().rms_waves;
  EXPECT_NEAR(std::sqrt(squares) / rms, 1, 2e-3);
  // Coma across the field comes from the tilt alone.
  EXPECT_GT(std::abs(row.coefficients[7]), 0.01) << "Z8, coma along x";
  // The map is the same wave: its place (0, 0) is the chief ray's, its left and right halves differ.
  const WavefrontMap map = wavefront_maps(lens, fields_of({4}), 9).front();
  EXPECT_NEAR(map.waves[4 * 9 + 4], 0, 1e-6);
  EXPECT_GT(std::abs(map.waves[4 * 9 + 1] - map.waves[4 * 9 + 7]), 0.01);
}

TEST(ImmersedObjects, KeepTheirEtendue) {
  // n² dA dα dβ is that of the image: what a wall in water gives is what its points send, on the axis, where
  // nothing is distorted. Both by pupils of even azimuths, good to 1e-4.
  Lens lens = read_lens("cooke-triplet").lens;
  lens.object_material = Material(Material::Constant{1.333});
  lens.object_distance_mm = 300;
  lens.fields = {Fields::Kind::object_height_mm, {0}};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 0.1};  // aberrations count as its square
  lens.set_image_distance_mm(first_order(lens).paraxial_image_mm);
  FieldTracer tracer(lens, 550);
  const ChiefRay chief = *tracer.chief_ray(0);
  EXPECT_NEAR(tracer.g_sensor_sr(chief) / tracer.g_source_sr(chief), 1, 1e-4);
}

TEST(PosedAnalyses, APoseTooSmallToMatterChangesNothing) {
  const Lens lens = read_lens("cooke-triplet").lens;
  Lens posed = lens;
  posed.surfaces[2].pose.tilt_x_deg = 1e-9;
  const FieldTableRequest request = fields_of({5, 14});
  const auto a = distortion_table(lens, request), b = distortion_table(posed, request);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].distortion_percent, b[i].distortion_percent, 1e-4);
    EXPECT_NEAR(*a[i].distortion_ftheta_percent, *b[i].distortion_ftheta_percent, 1e-4);
  }
  const auto near = field_curvature_table(lens, request), far = field_curvature_table(posed, request);
  for (std::size_t i = 0; i < near.size(); ++i) {
    EXPECT_NEAR(near[i].tangential_mm, far[i].tangential_mm, 1e-4);
    EXPECT_NEAR(near[i].sagittal_mm, far[i].sagittal_mm, 1e-4);
  }
  const std::vector<double> colours{450, 550, 650}, zones{0, 0.7, 1};
  const auto c = axial_focus_table(lens, colours, zones), d = axial_focus_table(posed, colours, zones);
  for (std::size_t i = 0; i < c.size(); ++i) EXPECT_NEAR(c[i].focus_mm, d[i].focus_mm, 1e-4);
  const FrameSize frame{18, 12};
  EXPECT_NEAR(tv_distortion(lens, frame, std::vector<double>{550})[0].smia_percent,
              tv_distortion(posed, frame, std::vector<double>{550})[0].smia_percent, 1e-4);
}

}  // namespace
}  // namespace petzval
