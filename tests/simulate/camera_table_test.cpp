// SPDX-License-Identifier: BSD-3-Clause
// Tables that are kept: fields close enough for the pictures of a sensor.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/imaging/field_error.h>
#include <petzval/lens/lens_file.h>
#include <petzval/sensor/sensor.h>
#include <petzval/simulate/camera_table.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace petzval {
namespace {

Camera camera_with_table(const char* lens) {
  Camera camera;
  camera.lens = read_lens(lens).lens;
  camera.sensor = read_sensor("640x480@7.5");
  return camera;
}

/// Finds a field among those of another table.
std::size_t place_of(double field, const LensDataTable& table) {
  const auto nearest =
      std::ranges::min_element(table.fields, {}, [field](double other) { return std::abs(other - field); });
  EXPECT_NEAR(*nearest, field, 1e-12);
  return std::size_t(nearest - table.fields.begin());
}

/// What PSFs at some fields of a dense table miss of those in between (RMS over the frame).
double missed_between(const LensDataTable& few, const LensDataTable& dense, const SensorGeometry& sensor) {
  std::vector<std::size_t> taken;
  for (const double field : few.fields) taken.push_back(place_of(field, dense));
  const std::array half_mm{sensor.width_mm() / 2, sensor.height_mm() / 2};
  const FrameRings frame(half_mm);
  const SpreadWanted wanted{
      .cell_um = sensor.pitch_um / 2, .tolerance = 1e-3, .tail_um = 16 * sensor.pitch_um};
  double squares = 0;
  for (std::size_t i = 0; i + 1 < taken.size(); ++i) {
    const std::size_t from = taken[i], to = taken[i + 1], middle = (from + to) / 2;
    if (middle == from) continue;
    const std::vector<std::size_t> about(taken.begin() + std::ptrdiff_t(i == 0 ? 0 : i - 1),
                                         taken.begin() + std::ptrdiff_t(std::min(i + 3, taken.size())));
    const double error = over_interval * field_misfit(dense, 0, about, middle, wanted).error();
    squares += frame.share(dense.real_image_height_mm[from], dense.real_image_height_mm[to]) * error * error;
  }
  return std::sqrt(squares);
}

// The PSFs of this lens change so fast towards the rim that 31 even fields miss the tolerance several times
// over. The PSFs of 241 fields lie in the gaps.
TEST(CameraTable, HasTheFieldsThatPicturesNeed) {
  const Camera camera = camera_with_table("m12-4.5mm");
  CameraTableOptions options{.wavelengths_nm = {550}};
  const LensDataTable chosen = camera_table(camera, options);
  options.field_count = 241;
  const LensDataTable dense = camera_table(camera, options);
  options.field_count = 31;
  const LensDataTable even = camera_table(camera, options);
  const SensorGeometry& sensor = camera.sensor->geometry;
  EXPECT_LT(missed_between(chosen, dense, sensor), 1e-3);
  EXPECT_GT(missed_between(even, dense, sensor), 2e-3);

  EXPECT_LT(chosen.fields.size(), dense.fields.size() / 2);
  for (const Psf& psf : chosen.psf) EXPECT_FALSE(psf.values.empty());
  for (const double field : even.fields) place_of(field, chosen);
}

TEST(CameraTable, HasEvenFieldsWhereNoMoreAreNeeded) {
  const LensDataTable table = camera_table(camera_with_table("double-gauss"), {.wavelengths_nm = {550}});
  ASSERT_EQ(table.fields.size(), 31U);
  for (std::size_t i = 0; i < table.fields.size(); ++i)
    EXPECT_NEAR(table.fields[i], table.fields.back() * double(i) / 30, 1e-12);
}

// A lens for 248 nm, whose PSFs at 550 nm have more cells of this sensor than kernels may have.
TEST(CameraTable, HasEvenFieldsWhereKernelsWouldBeTooLarge) {
  Camera camera = camera_with_table("us-5831776");
  camera.sensor = read_sensor("third-inch-1280x960");
  EXPECT_EQ(camera_table(camera, {.wavelengths_nm = {550}}).fields.size(), 31U);
}

TEST(CameraTable, SaysWhatWouldBeRight) {
  const Camera camera = camera_with_table("double-gauss");
  EXPECT_THROW(camera_table(camera, {.image_height_mm = -3}), InputError);
  EXPECT_THROW(camera_table(camera, {.tolerance = 0}), InputError);
  EXPECT_THROW(camera_table(camera, {.tolerance = NAN}), InputError);
}

}  // namespace
}  // namespace petzval
