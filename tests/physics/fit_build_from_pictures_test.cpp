// SPDX-License-Identifier: BSD-3-Clause
// A lens tilted and decentred by known amounts, found again from its noisy pictures: a slanted board through
// the lens as it is built (image formation: tables over the frame), exposed, its edges measured, and the
// lens fitted to them (the overlap of pupils, edge by edge). bench/fit_builds.py does twenty.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/scaled_lens.h>
#include <petzval/measure/sfr/measure_picture.h>
#include <petzval/optimise/fit_build.h>
#include <petzval/simulate/expose.h>
#include <petzval/simulate/image.h>

#include <cmath>

namespace petzval {
namespace {

constexpr double light_nm = 550;

SfrMap photograph(const Lens& lens, const Sensor& sensor, std::uint64_t seed) {
  Camera camera{.lens = lens};
  camera.focus = Focus::design();
  camera.sensor = sensor;
  ImageOptions options;
  const SpectralImage light =
      image(SceneRequest{"slanted-board:8", {.wavelengths_nm = {light_nm}}}, camera, options);
  Context context;
  context.seed = seed;
  const RawImage raw = expose(light, sensor, {}, context);
  Plane plane{raw.columns, raw.rows, {}};
  for (int row = 0; row < raw.rows; ++row)
    for (int column = 0; column < raw.columns; ++column) plane.values.push_back(raw.pixel(row, column));
  PicturePlanes planes;
  planes.columns = raw.columns, planes.rows = raw.rows;
  planes.planes = {plane};
  return sfr_map(measure_sfr(planes), raw.columns, raw.rows);
}

// Wanted (before anything was measured): every number within three of its stated deviations, and deviations
// of at most 4 um and 0.15 degrees: a third of what is off.
TEST(FitBuildFromPictures, FindsTwoLensesAgain) {
  const Lens lens = scaled_lens(read_lens("cooke-triplet").lens, 0.2);
  const Sensor sensor = read_sensor("icx625-mono", {"columns=560", "rows=460"});
  struct Truth {
    double defocus_mm, tilt_x_deg, tilt_y_deg, decentre_x_mm, decentre_y_mm;
  };
  std::uint64_t seed = 11;
  for (const Truth& truth :
       {Truth{0.012, 0.5, -0.3, 0.012, -0.008}, Truth{-0.010, -0.2, 0.6, -0.009, 0.011}}) {
    Lens built = lens;
    built.set_image_distance_mm(built.image_distance_mm() + truth.defocus_mm);
    built.sensor_pose.tilt_x_deg = truth.tilt_x_deg, built.sensor_pose.tilt_y_deg = truth.tilt_y_deg;
    built.groups.push_back({2, 3, {truth.decentre_x_mm, truth.decentre_y_mm}, 0});
    FitBuildRequest request;
    request.free = {"defocus_mm", "sensor_tilt_deg", "element_decentre_mm@2-3"};
    request.pixel_pitch_um = sensor.geometry.pitch_um;
    request.photosite = sensor.photosite;
    request.wavelengths_nm = {light_nm};
    const SfrMap map = photograph(built, sensor, seed++);
    const FitBuildResult found = fit_build(lens, {map}, request);
    const double values[] = {truth.defocus_mm, truth.tilt_x_deg, truth.tilt_y_deg, truth.decentre_x_mm,
                             truth.decentre_y_mm};
    const double known_to[] = {0.004, 0.15, 0.15, 0.004, 0.004};
    for (std::size_t i = 0; i < 5; ++i) {
      const FittedNumber& number = found.numbers[i];
      EXPECT_LT(std::abs(number.value - values[i]), 3 * number.deviation) << number.number.name();
      EXPECT_LT(number.deviation, known_to[i]) << number.number.name();
    }
  }
}

}  // namespace
}  // namespace petzval
