// SPDX-License-Identifier: BSD-3-Clause
// A lens tilted and decentred by known amounts, found again from its noisy pictures: a checkerboard through
// the lens as it is built (image formation: tables over the frame), exposed, its edges measured, and the
// lens fitted to them (the overlap of pupils, edge by edge). bench/fit_builds.py does twenty.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/scaled_lens.h>
#include <petzval/measure/sfr/measure_picture.h>
#include <petzval/optimise/fit_build.h>
#include <petzval/simulate/expose.h>
#include <petzval/simulate/image.h>

#include <cmath>

namespace petzval {
namespace {

constexpr double light_nm = 550, turned_deg = 7, side_px = 74;
constexpr int samples_per_px = 4;

bool bright_at(double x, double y) {
  static const double c = std::cos(radians(turned_deg)), s = std::sin(radians(turned_deg));
  const double u = (x * c + y * s) / side_px + 0.31, v = (y * c - x * s) / side_px + 0.17;
  return (static_cast<long>(std::floor(u)) + static_cast<long>(std::floor(v))) % 2 == 0;
}

Scene checkerboard(const SensorGeometry& sensor, double focal_length_mm) {
  const int columns = static_cast<int>(sensor.columns * 1.3) * samples_per_px;
  const int rows = static_cast<int>(sensor.rows * 1.3) * samples_per_px;
  const double half_tangent = columns * sensor.pitch_um * 1e-3 / (2 * samples_per_px * focal_length_mm);
  Scene scene(columns, rows, {light_nm}, 2 * degrees(std::atan(half_tangent)), {});
  const std::span<float> band = scene.band(0);
  constexpr int parts = 4;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      int bright = 0;
      for (int i = 0; i < parts * parts; ++i)
        bright += bright_at((column + (i % parts + 0.5) / parts - columns / 2.0) / samples_per_px,
                            (row + (i / parts + 0.5) / parts - rows / 2.0) / samples_per_px);
      band[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column)] = static_cast<float>(0.1 + 0.9 * bright / (parts * parts));
    }
  return scene;
}

SfrMap photograph(const Lens& lens, const Sensor& sensor, double focal_length_mm, std::uint64_t seed) {
  Camera camera{.lens = lens};
  camera.focus = Focus::design();
  camera.sensor = sensor;
  ImageOptions options;
  options.imaging.product.tolerance = 1e-3;
  options.imaging.supersample = 3;
  const SpectralImage light = image(checkerboard(sensor.geometry, focal_length_mm), camera, options);
  Context context;
  context.seed = seed;
  const RawImage raw = expose(light, sensor, {}, context);
  Plane plane{raw.columns, raw.rows, {}};
  for (int row = 0; row < raw.rows; ++row)
    for (int column = 0; column < raw.columns; ++column) plane.values.push_back(raw.pixel(row, column));
  PicturePlanes planes;
  planes.columns = raw.columns, planes.rows = raw.rows;
  planes.planes = {plane};
  SfrMap map = sfr_map(measure_sfr(planes), raw.columns, raw.rows);
  // The samples of the scene blur, too: their own squares and the lines drawn between them.
  for (MapEdge& edge : map.edges)
    for (std::size_t k = 0; k < edge.contrast.size(); ++k) {
      const double f = edge.frequencies_cpp[k] / samples_per_px;
      const double one = sinc(f * std::cos(edge.normal_rad)) * sinc(f * std::sin(edge.normal_rad));
      edge.contrast[k] /= one * one;
    }
  return map;
}

// Wanted (before anything was measured): every number within three of its stated deviations, and deviations
// of at most 4 um and 0.15 degrees: a third of what is off.
TEST(FitBuildFromPictures, FindsTwoLensesAgain) {
  const Lens lens = scaled_lens(read_lens("cooke-triplet").lens, 0.2);
  const double focal_length_mm = first_order(lens, light_nm).efl_mm;
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
    const SfrMap map = photograph(built, sensor, focal_length_mm, seed++);
    const FitBuildResult found = fit_build(lens, {map}, request);
    const double values[] = {truth.defocus_mm, truth.tilt_x_deg, truth.tilt_y_deg, truth.decentre_x_mm,
                             truth.decentre_y_mm};
    const double known_to[] = {0.004, 0.15, 0.15, 0.004, 0.004};
    std::printf("%zu edges, chi2 %.1f for %d\n", found.edges.size(), found.chi_squared, found.freedom);
    for (std::size_t i = 0; i < 5; ++i) {
      const FittedNumber& number = found.numbers[i];
      std::printf("  %-28s %+.5f found %+.5f +- %.5f, pull %+.2f\n", number.number.name().c_str(), values[i],
                  number.value, number.deviation, (number.value - values[i]) / number.deviation);
      EXPECT_LT(std::abs(number.value - values[i]), 3 * number.deviation) << number.number.name();
      EXPECT_LT(number.deviation, known_to[i]) << number.number.name();
    }
  }
}

}  // namespace
}  // namespace petzval
