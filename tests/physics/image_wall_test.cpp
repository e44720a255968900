// SPDX-License-Identifier: BSD-3-Clause
// Two ways to the same light, with real lenses: g_source and the PSFs, which trace forwards from object
// points, must give every pixel of a uniform wall the illumination that g_sensor, traced backwards from image
// points, says.

#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/build.h>

#include <cmath>

namespace petzval {
namespace {

struct Wall {
  const char* lens;
  SensorGeometry sensor;
  int supersample;
  double tolerance;
  bool at_infinity;
  double share_off;  ///< of the pixels that may be off by more than 1e-3
  double most_off;
  bool panorama = false;  ///< the wall is all around
};

class ImageWall : public ::testing::TestWithParam<Wall> {};

TEST_P(ImageWall, ComesOutAsTheBackwardTraceSays) {
  const Wall& at = GetParam();
  MountedLens camera(read_lens(at.lens).lens);
  if (at.at_infinity) camera.focus_at_m({});
  TableOptions table_options;
  table_options.wavelengths_nm = {587.5618};
  const double half_diagonal_mm = std::hypot(at.sensor.width_mm(), at.sensor.height_mm()) / 2;
  table_options.max_image_height_mm = half_diagonal_mm;
  const LensDataTable table = build_lens_data_table(camera.lens(), table_options);
  std::optional<double> distance_m = object_to_sensor_mm(table);
  if (distance_m) *distance_m /= mm_per_m;
  Scene wall(8, 6, {587.5618}, 40, distance_m);
  if (at.panorama) {
    wall = Scene(16, 8, {587.5618}, 40, distance_m);
    wall.make_panorama();
  }
  std::fill(wall.band(0).begin(), wall.band(0).end(), 1.0F);
  ImagingOptions options;
  options.supersample = at.supersample;
  options.product.tolerance = at.tolerance;
  options.surround = Surround::extend;
  const SpectralImage image = form_image(wall, table, at.sensor, options);

  const RadialProfile profile = RadialProfiles(table).at_wavelength(587.5618);
  double worst = 0;
  int off = 0, pixels = 0;
  for (int row = 0; row < at.sensor.rows; ++row)
    for (int column = 0; column < at.sensor.columns; ++column) {
      const double height = std::hypot(at.sensor.x_mm(column + 0.5), at.sensor.y_mm(row + 0.5));
      if (height > profile.max_height_mm() - 0.1) continue;  // beyond the last field, where it is dark
      const double error = std::abs(double(image.at(0, row, column)) / profile.g_sensor_sr(height) - 1);
      worst = std::max(worst, error);
      off += error > 1e-3;
      ++pixels;
    }
  std::printf(
      "%s, %g um, supersample %d, tolerance %g: worst pixel %.2e, %.3f %% of %d off by more than 1e-3\n",
      at.lens, at.sensor.pitch_um, at.supersample, at.tolerance, worst, 100.0 * off / pixels, pixels);
  EXPECT_GT(pixels, at.sensor.rows * at.sensor.columns / 2);
  EXPECT_LE(off, at.share_off * pixels);
  EXPECT_LE(worst, at.most_off);
}

// The project promises 1e-3. At its default settings the paper's lens exceeds it in a few pixels towards the
// corners, where its PSF changes fastest: the tolerance is one of pictures, not of pixels.
INSTANTIATE_TEST_SUITE_P(
    Bundled, ImageWall,
    ::testing::Values(Wall{"edmund-54852", {768, 576, 6.25}, 2, 3e-4, false, 0, 1e-3},
                      Wall{"edmund-54852", {768, 576, 6.25}, 0, 1e-3, false, 1e-3, 2e-3},
                      Wall{"edmund-54852", {320, 240, 15}, 4, 1e-3, false, 1e-3, 2e-3},
                      Wall{"dgauss-50mm", {360, 240, 100}, 0, 1e-3, true, 0, 1e-3},
                      Wall{"wide-22mm", {300, 200, 80}, 0, 1e-3, true, 0, 1e-3},
                      Wall{"fisheye-10mm", {320, 320, 50}, 0, 1e-3, true, 0, 1e-3},
                      Wall{"fisheye-10mm", {160, 160, 100}, 0, 1e-3, true, 0, 1e-3, true}),
    [](const auto& info) {
      std::string name = info.param.lens;
      std::replace(name.begin(), name.end(), '-', '_');
      return name + "_" + std::to_string(info.index);
    });

}  // namespace
}  // namespace petzval
