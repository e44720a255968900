// SPDX-License-Identifier: BSD-3-Clause
// Clips of scenes in three dimensions: what moves is where it should be, row by row.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/simulate/clip.h>

#include <cmath>
#include <fstream>

#include "scratch.h"

namespace petzval {
namespace {

constexpr double fov_deg = 20, distance = 10, speed = 12;  // of a bar, across [units a second]

/// A bar that shines, upright, 0.3 wide, in the middle at t = 0; it moves to the right of the picture.
std::string bar_scene(const test::Scratch& scratch) {
  std::ofstream(scratch.path("bar.pbrt"))
      << "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" " << fov_deg
      << "\nTransformTimes 0 1\nWorldBegin\nAttributeBegin\nActiveTransform EndTime\nTranslate " << speed
      << " 0 0\nActiveTransform All\nAreaLightSource \"diffuse\" \"rgb L\" [4 4 4] \"bool twosided\" true\n"
         "Shape \"trianglemesh\" \"point3 P\" [-.15 -9 10  .15 -9 10  .15 9 10  -.15 9 10] \"integer "
         "indices\" [0 "
         "1 2 0 2 3]\nAttributeEnd\n";
  return scratch.path("bar.pbrt");
}

Sensor grey_sensor() {
  Sensor sensor = read_sensor("third-inch-1280x960", {"columns=64", "rows=48"});
  sensor.electronics->channels = {{"grey", Spectrum({400, 700}, {0.5, 0.5})}};
  sensor.electronics->mosaic = {};
  return sensor;
}

RenderRequest bar_request(const test::Scratch& scratch) {
  RenderRequest request{.scene = bar_scene(scratch)};
  request.camera.sensor = grey_sensor();
  request.pinhole = true;
  request.wavelengths_nm = {550};
  request.samples_per_pixel = 16;
  return request;
}

ClipOptions quiet_options() {
  ClipOptions options;
  options.frames = 2;
  options.fps = 25;
  for (const NoiseSource source :
       {NoiseSource::shot, NoiseSource::read, NoiseSource::dsnu, NoiseSource::prnu, NoiseSource::column,
        NoiseSource::row, NoiseSource::defects, NoiseSource::dark})
    options.expose.without.insert(source);
  return options;
}

double bar_centre(const RawImage& raw, int row) {
  double sum = 0, moment = 0;
  for (int c = 0; c < raw.columns; ++c) {
    const double value = raw.pixel(row, c) - raw.black_level;
    sum += value;
    moment += value * (c + 0.5);
  }
  return moment / sum;
}

/// Mean place of the bar over rows.
double place(const RawImage& raw, int first, int end) {
  double sum = 0;
  for (int row = first; row < end; ++row) sum += bar_centre(raw, row);
  return sum / (end - first);
}

/// Across the shorter side, 48 rows, fall the degrees of the field of view.
double speed_px() {
  return speed / distance * 24 / std::tan(radians(fov_deg / 2));
}

// A pinhole's picture: a bar at this distance moves by v·f/Z pixels a second, and every row of a rolling
// shutter sees it a row time later. Sixteen samples a pixel know a row's centroid to some hundredths of a
// pixel.
TEST(RenderedClip, ARollingShutterSlantsABarByItsSpeed) {
  const test::Scratch scratch;
  ClipOptions options = quiet_options();
  options.shutter = Shutter{Shutter::Kind::rolling, 400e-6};
  options.expose.exposure = Exposure::seconds(2e-3);
  options.instants = 4;
  const RenderRequest request = bar_request(scratch);
  const Clip clip(request, grey_sensor(), options);
  EXPECT_EQ(clip.instants(0), 1 + std::size_t(std::ceil((47 * 400e-6 + 2e-3) / 2e-3 * 4)));
  const RawImage frame = clip.frame(0);
  const double slant = (place(frame, 32, 48) - place(frame, 0, 16)) / 32;
  EXPECT_NEAR(slant / (speed_px() * 400e-6), 1, 0.03);
}

TEST(RenderedClip, FramesAreWhereTheBarIsInTheMiddleOfTheExposure) {
  const test::Scratch scratch;
  ClipOptions options = quiet_options();
  options.expose.exposure = Exposure::seconds(0.02);
  options.instants = 6;
  const RenderRequest request = bar_request(scratch);
  const Clip clip(request, grey_sensor(), options);
  for (const int frame : {0, 1})
    EXPECT_NEAR(place(clip.frame(frame), 0, 48), 32 + speed_px() * (frame / 25.0 + 0.01), 0.05) << frame;
  // Any order, any number of threads: the same bytes.
  Context one;
  one.threads = 1;
  EXPECT_EQ(Clip(request, grey_sensor(), options, one).frame(1, one).samples, clip.frame(1).samples);
}

TEST(RenderedClip, SaysWhatItDoesNotTake) {
  const test::Scratch scratch;
  RenderRequest request = bar_request(scratch);
  ClipOptions options = quiet_options();
  options.motion = MotionPath::steady({.pan_deg = 5}, 1);
  EXPECT_THROW(Clip(request, grey_sensor(), options), InputError);
  options.motion = {};
  options.instants = 0;
  EXPECT_THROW(Clip(request, grey_sensor(), options), InputError);
  options.instants = 1;
  request.checkpoint = scratch.path("c");
  EXPECT_THROW(Clip(request, grey_sensor(), options), InputError);
}

}  // namespace
}  // namespace petzval
