// SPDX-License-Identifier: BSD-3-Clause
// Analyses of lenses with poses: against the same lens seen from elsewhere, against counted rays, against
// each other, and against what the wall of a rendering gets.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/mtf.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/seidel.h>
#include <petzval/analysis/spot_moments.h>
#include <petzval/analysis/spots.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>

#include <cmath>
#include <complex>

#include "counted_light.h"

namespace petzval {
namespace {

Lens gauss() {
  return read_lens("dgauss-50mm").lens;
}

/// With its fourth surface tilted, one element decentred and the sensor askew.
Lens as_built() {
  Lens lens = gauss();
  lens.surfaces[3].pose.tilt_x_deg = 0.2;
  lens.groups = {{0, 1, {0.12, 0.07, 0, 0.05, -0.08, 0}, 0}};
  lens.sensor_pose.tilt_y_deg = 0.15;
  return lens;
}

/// Lens and sensor turned as one about x.
Lens tilted_whole(double tilt_deg) {
  Lens lens = gauss();
  lens.groups = {{0, lens.surfaces.size(), {0, 0, 0, tilt_deg, 0, 0}, 7}};
  return lens;
}

FieldTableRequest at_field(double field, double azimuth_deg = 0) {
  FieldTableRequest request;
  request.fields = {field};
  request.wavelengths_nm = {550};
  request.azimuth_deg = azimuth_deg;
  return request;
}

MtfRow mtf_of(const Lens& lens, double field, double azimuth_deg = 0, bool geometric = false) {
  MtfOptions options;
  options.frequencies_cpmm = {40};
  options.geometric = geometric;
  return mtf_table(lens, at_field(field, azimuth_deg), options).front();
}

/// The difference of two PSFs of one grid against the first, root mean square.
double difference_of(const Psf& a, const Psf& b) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    difference += std::pow(double(a.values[i]) * a.captured - double(b.values[i]) * b.captured, 2);
    size += std::pow(double(a.values[i]) * a.captured, 2);
  }
  return std::sqrt(difference / size);
}

/// Samples that say everything, about all of a spot of the double Gauss.
PsfOptions sampled_window() {
  PsfOptions options;
  options.size = 240;
  options.spacing_um = 0.5;
  return options;
}

/// The PSF of a pupil by fits against that of traced nodes: by Parseval as good as the MTF.
constexpr double psf_tolerance = 1e-3;

/// What the same light does to two lenses must be the same but for how the two are computed: outlines by
/// evenly spread azimuths, waves by fits, each good to 1e-4 of an MTF (CONVENTIONS).
constexpr double mtf_tolerance = 2e-4;

TEST(PosedLens, TurnedAsAWholeSeesTheFieldMoved) {
  // Turned by +2° about x, the axis points from +z towards −y: light at an angle of 8° in the designed lens's
  // own axes comes from 6° or 10° of space.
  const Lens lens = gauss(), turned = tilted_whole(2);
  FieldTracer own(lens, 550), seen(turned, 550);
  const ChiefRay designed = *own.chief_ray(8);
  double nearest = 1e9, field = 0;
  for (const double candidate : {6.0, 10.0}) {
    const double distance = std::abs(seen.chief_ray(candidate)->image_height_mm - designed.image_height_mm);
    if (distance < nearest) nearest = distance, field = candidate;
  }
  // The chief ray is aimed to 1e-10 of the stop.
  EXPECT_LT(nearest, 1e-8);
  const ChiefRay chief = *seen.chief_ray(field);
  EXPECT_NEAR(chief.image_x_mm, 0, 1e-9);
  EXPECT_NEAR(seen.g_sensor_sr(chief) / own.g_sensor_sr(designed), 1, 1e-4);
  EXPECT_NEAR(seen.g_source_sr(chief) / own.g_source_sr(designed), 1, 2e-3);
  for (const bool geometric : {false, true}) {
    const MtfRow there = mtf_of(turned, field, 0, geometric), here = mtf_of(lens, 8, 0, geometric);
    EXPECT_NEAR(there.tangential, here.tangential, mtf_tolerance) << geometric;
    EXPECT_NEAR(there.sagittal, here.sagittal, mtf_tolerance) << geometric;
    EXPECT_GT(std::abs(mtf_of(turned, 16 - field, 0, geometric).tangential - here.tangential), 0.005)
        << "8 degrees on the other side must differ";
  }
  // The turned sensor's own t runs along the same line, from the same light.
  const Psf there = *point_spread(seen, chief, sampled_window()),
            here = *point_spread(own, designed, sampled_window());
  EXPECT_LT(difference_of(here, there), psf_tolerance);
}

TEST(PosedLens, DecentredAsAWholeMovesTheImage) {
  const Lens lens = gauss();
  Lens moved = lens;
  moved.groups = {{0, lens.surfaces.size() - 1, {0.5, -0.3, 0, 0, 0, 0}, 0}};
  FieldTracer own(lens, 550), seen(moved, 550);
  const ChiefRay designed = *own.chief_ray(8), chief = *seen.chief_ray(8);
  EXPECT_NEAR(chief.image_height_mm, designed.image_height_mm - 0.3, 1e-9);
  EXPECT_NEAR(chief.image_x_mm, 0.5, 1e-9);
  EXPECT_NEAR(seen.g_sensor_sr(chief) / own.g_sensor_sr(designed), 1, 1e-4);
  EXPECT_NEAR(mtf_of(moved, 8).tangential, mtf_of(lens, 8).tangential, mtf_tolerance);
  EXPECT_NEAR(mtf_of(moved, 8).sagittal, mtf_of(lens, 8).sagittal, mtf_tolerance);
}

TEST(PosedLens, APoseTooSmallToMatterChangesNothing) {
  // Another path through the program: chief rays in two dimensions, pupils all round, fits without symmetry.
  const Lens lens = gauss();
  Lens posed = lens;
  posed.surfaces[2].pose.tilt_x_deg = 1e-9;
  for (const double field : {0.0, 7.0, 13.0}) {
    FieldTracer own(lens, 550), seen(posed, 550);
    const ChiefRay designed = *own.chief_ray(field), chief = *seen.chief_ray(field);
    EXPECT_NEAR(chief.image_height_mm, designed.image_height_mm, 1e-8) << field;
    EXPECT_NEAR(seen.g_sensor_sr(chief) / own.g_sensor_sr(designed), 1, 1e-4) << field;
    EXPECT_NEAR(seen.object_flux(chief) / own.object_flux(designed), 1, 1e-4) << field;
    EXPECT_NEAR(mtf_of(posed, field).tangential, mtf_of(lens, field).tangential, mtf_tolerance) << field;
    EXPECT_NEAR(mtf_of(posed, field).sagittal, mtf_of(lens, field).sagittal, mtf_tolerance) << field;
    EXPECT_NEAR(mtf_of(posed, field, 0, true).sagittal, mtf_of(lens, field, 0, true).sagittal, 1e-3) << field;
    const Psf there = *point_spread(seen, chief, sampled_window()),
              here = *point_spread(own, designed, sampled_window());
    EXPECT_LT(difference_of(here, there), psf_tolerance) << field;
  }
}

TEST(PosedLens, AzimuthsGoAroundTheAxis) {
  // A tilt about y does at 90° or 270° what the same tilt about x does at 0° or 180°.
  Lens about_x = gauss(), about_y = gauss();
  about_x.surfaces[3].pose.tilt_x_deg = 0.2;
  about_y.surfaces[3].pose.tilt_y_deg = 0.2;
  for (const double azimuth : {0.0, 180.0, 40.0}) {
    // Turned by +90° about z, from +x towards +y, which is anticlockwise as seen from the film, x becomes y:
    // one lens is the other, turned.
    const MtfRow x = mtf_of(about_x, 10, azimuth), y = mtf_of(about_y, 10, azimuth + 90);
    EXPECT_NEAR(x.tangential, y.tangential, 1e-6) << azimuth;
    EXPECT_NEAR(x.sagittal, y.sagittal, 1e-6) << azimuth;
  }
  EXPECT_GT(std::abs(mtf_of(about_x, 10, 0).sagittal - mtf_of(about_x, 10, 180).sagittal),
            50 * mtf_tolerance);
  // And a field at an azimuth of 180° is the negative field.
  EXPECT_NEAR(mtf_of(about_x, 10, 180).tangential, mtf_of(about_x, -10).tangential, mtf_tolerance);
}

TEST(PosedLens, MtfIsTheTransformOfThePsf) {
  const Lens lens = as_built();
  const PupilModel as_psf{PupilModel::Amplitude::light, PupilModel::Phase::plane_waves};
  FieldTracer tracer(lens, 550, Tracer::Clip::apertures, 30);
  const ChiefRay chief = *tracer.chief_ray(9);
  PsfOptions window = sampled_window();
  window.size = 400;  // beyond the spot on every side
  const Psf psf = *point_spread(tracer, chief, window);
  const ExitPupil pupil = *ExitPupil::of(tracer, chief);
  for (const double frequency : {20.0, 60.0, 120.0}) {
    std::complex<double> tangential = 0, sagittal = 0;
    for (int i = 0; i < psf.size; ++i)
      for (int j = 0; j < psf.size; ++j) {
        const double turn = -2 * pi * frequency * psf.spacing_um * mm_per_um;
        tangential += std::polar<double>(psf.at(i, j) * psf.captured, turn * (i - psf.size / 2));
        sagittal += std::polar<double>(psf.at(i, j) * psf.captured, turn * (j - psf.size / 2));
      }
    const double tolerance = 0.3 * (1 - psf.captured) + 1e-3;
    EXPECT_NEAR(std::abs(diffraction_otf(tracer, pupil, MtfDirection::tangential, frequency, as_psf)),
                std::abs(tangential), tolerance)
        << frequency;
    EXPECT_NEAR(std::abs(diffraction_otf(tracer, pupil, MtfDirection::sagittal, frequency, as_psf)),
                std::abs(sagittal), tolerance)
        << frequency;
  }
}

TEST(PosedLens, GSensorIsThatOfCountedRays) {
  const Lens lens = as_built();
  for (const double azimuth : {0.0, 135.0}) {
    FieldTracer tracer(lens, 550, Tracer::Clip::apertures, azimuth);
    for (const double field : {0.0, 9.0, 13.0}) {
      const ChiefRay chief = *tracer.chief_ray(field);
      // Cells cut by the rim: 2 · 1500^−1.5 of the hemisphere's share, as counted_g_sensor_sr() has it.
      const double counted = counted_light_sr(tracer.tracer(), chief.image_x_mm, chief.image_height_mm, 1500);
      EXPECT_NEAR(tracer.g_sensor_sr(chief) / counted, 1, 5e-4) << azimuth << " " << field;
    }
  }
}

TEST(PosedLens, SpotAndWaveOfALensTurnedAsAWhole) {
  const Lens lens = gauss(), turned = tilted_whole(2);
  FieldTracer own(lens, 550), seen(turned, 550);
  const ChiefRay designed = *own.chief_ray(8);
  double field = 6;
  if (std::abs(seen.chief_ray(6)->image_height_mm - designed.image_height_mm) > 0.1) field = 10;
  const ChiefRay chief = *seen.chief_ray(field);
  for (const RayWeight weight : {RayWeight::stop_area, RayWeight::light}) {
    const SpotRow there = *spot(seen, chief, weight), here = *spot(own, designed, weight);
    EXPECT_NEAR(there.rms_radius_um / here.rms_radius_um, 1, 1e-4);
  }
  const WavefrontRow there = *wavefront(seen, chief), here = *wavefront(own, designed);
  EXPECT_NEAR(there.rms_waves / here.rms_waves, 1, 1e-3);
}

TEST(PosedLens, ATiltedSensorDefocusesItsEdges) {
  // A positive tilt about x turns the sensor's +y away from the lens: light that lands at y is met y tan θ
  // later. Moments of rays about their mean slope, as the sensor turned by 0.4° has it: cos θ is 2.4e-5 off.
  const double tilt_deg = 0.4;
  Lens tilted = gauss();
  tilted.sensor_pose.tilt_x_deg = tilt_deg;
  for (const double field : {-8.0, 8.0}) {
    double height = 0;
    const auto best = [&](const Lens& lens) {
      FieldTracer tracer(lens, 550);
      const ChiefRay chief = *tracer.chief_ray(field);
      height = chief.image_height_mm;
      const SpotMoments moments = spot_moments(light_rays(tracer, chief, {8, 48}), chief, RayWeight::light);
      return best_shift_mm(std::span(&moments, 1));
    };
    const double straight = best(gauss());
    EXPECT_NEAR(best(tilted) - straight, -height * std::tan(radians(tilt_deg)), 1e-3) << field;
    EXPECT_GT(std::abs(height), 5);
  }
}

TEST(PosedLens, WhatNeedsAnAxisSaysSo) {
  const Lens lens = as_built();
  try {
    seidel_sums(lens);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("surfaces[3].pose is set"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace petzval
