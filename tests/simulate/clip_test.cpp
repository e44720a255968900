// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/clip.h>

#include <cmath>

#include "scratch.h"

namespace petzval {
namespace {

Sensor clip_sensor() {
  return read_sensor("third-inch-1280x960", {"columns=64", "rows=48"});
}

Camera clip_camera() {
  Camera camera;
  camera.lens = read_lens("edmund-54852").lens;
  camera.sensor = clip_sensor();
  return camera;
}

ImageOptions unblurred() {
  ImageOptions options;
  options.imaging.method = BlurMethod::none;
  return options;
}

/// A bright upright bar on a dark plane at infinity, seen through a lens without blur.
Scene bar_scene() {
  Scene scene(1200, 120, {550}, 20, {});
  for (int row = 0; row < scene.rows(); ++row)
    for (int column = 0; column < scene.columns(); ++column)
      scene.band(0)[static_cast<std::size_t>(row * scene.columns() + column)] =
          column >= 590 && column < 620 ? 1.0F : 0.0F;
  return scene;
}

double centroid(const RawImage& raw, int row) {
  double sum = 0, moment = 0;
  for (int c = 0; c < raw.columns; ++c) {
    const double value = raw.pixel(row, c) - raw.black_level;
    sum += value;
    moment += value * (c + 0.5);
  }
  return moment / sum;
}

TEST(Clip, AFrameOfWhatRestsIsAPlainExposure) {
  const SceneRequest request{.name = "wall", .options = {.wavelengths_nm = {450, 550, 650}}};
  const ImagePlan plan = plan_image(request, clip_camera(), unblurred());
  ClipOptions options;
  options.expose.exposure = Exposure::seconds(0.01);
  const RawImage frame = Clip(plan, clip_sensor(), options).frame(0);
  const RawImage plain = expose(image(plan), clip_sensor(), options.expose);
  EXPECT_EQ(frame.samples, plain.samples);
  EXPECT_EQ(frame.as_shot_neutral, plain.as_shot_neutral);
}

// A monochrome sensor without noise. The camera turns by ω; a bar in the middle moves by f·ω/pitch pixels a
// second, and every row sees it a row time later. Beyond the middle the tangent of the angle grows: by 1e-4
// over the 0.5 degrees of this clip; distortion and focus at infinity by less than 1 %.
TEST(Clip, ATurningCameraSlantsABarThroughTheLens) {
  Sensor sensor = clip_sensor();
  sensor.electronics->channels = {{"grey", Spectrum({400, 700}, {0.5, 0.5})}};
  sensor.electronics->mosaic = {};
  Camera camera = clip_camera();
  camera.sensor = sensor;
  const ImagePlan plan = plan_image(bar_scene(), camera, unblurred());
  ClipOptions options;
  options.step_px = 0.1;
  options.shutter = Shutter{Shutter::Kind::rolling, 200e-6};
  options.expose.exposure = Exposure::seconds(2e-4);
  for (const NoiseSource source :
       {NoiseSource::shot, NoiseSource::read, NoiseSource::dsnu, NoiseSource::prnu, NoiseSource::column,
        NoiseSource::row, NoiseSource::defects, NoiseSource::dark})
    options.expose.without.insert(source);
  options.motion = MotionPath::steady({.pan_deg = 30}, 1);
  // Enough light, but no saturation.
  options.expose.exposure = Exposure::automatic();
  options.expose.compensation_ev = -1;
  const double speed_px = plan.table.first_order.efl_mm * radians(30) / (sensor.geometry.pitch_um * 1e-3);
  Clip clip(plan, sensor, options);
  const RawImage frame = clip.frame(0);
  const double slope = (centroid(frame, 28) - centroid(frame, 20)) / 8;
  EXPECT_NEAR(slope / (-speed_px * 200e-6), 1, 0.02);

  options.shutter = Shutter{};
  const RawImage upright = Clip(plan, sensor, options).frame(0);
  EXPECT_NEAR(centroid(upright, 28), centroid(upright, 20), 0.01);
}

TEST(Clip, FramesAreTheSameInAnyOrderAndOnAnyNumberOfThreads) {
  const ImagePlan plan = plan_image(bar_scene(), clip_camera(), unblurred());
  ClipOptions options;
  options.frames = 2;
  options.motion = MotionPath::steady({.pan_deg = 20}, 1);
  options.flicker = LampFlicker::pwm(100, 0.5);
  options.expose.exposure = Exposure::seconds(2e-3);
  Context one;
  one.threads = 1;
  const Clip clip(plan, clip_sensor(), options), other(plan, clip_sensor(), options, one);
  const RawImage last = clip.frame(1);
  EXPECT_NE(clip.frame(0).samples, last.samples);
  EXPECT_EQ(other.frame(1, one).samples, last.samples);
  std::vector<Event> events, again;
  const EventCameraOptions camera;
  clip.events(camera,
              [&](const std::vector<Event>& some) { events.insert(events.end(), some.begin(), some.end()); });
  other.events(
      camera, [&](const std::vector<Event>& some) { again.insert(again.end(), some.begin(), some.end()); },
      one);
  EXPECT_FALSE(events.empty());
  EXPECT_EQ(events, again);
}

// The exposures of a bracket follow each other: what moves stands farther on in each.
TEST(Clip, TheExposuresOfABracketAreStaggered) {
  const ImagePlan plan = plan_image(bar_scene(), clip_camera(), unblurred());
  ClipOptions options;
  options.expose.exposure = Exposure::seconds(4e-3);
  options.expose.bracket_ev = {0, -2};
  const Clip clip(plan, clip_sensor(), options);
  EXPECT_DOUBLE_EQ(clip.timing(0, 1).start_s, 4e-3);
  EXPECT_DOUBLE_EQ(clip.timing(0, 1).exposure_s, 1e-3);
  EXPECT_EQ(clip.frame(0).white_level, 65535);
}

TEST(Clip, RefusesWhatAFrameCannotHold) {
  const ImagePlan plan = plan_image(bar_scene(), clip_camera(), unblurred());
  ClipOptions options;
  options.expose.exposure = Exposure::seconds(0.1);
  EXPECT_THROW(Clip(plan, clip_sensor(), options), InputError);
  options.expose.exposure = Exposure::seconds(0.01);
  options.shutter = Shutter{Shutter::Kind::rolling, 1e-3};  // 48 ms at 24 frames a second
  EXPECT_THROW(Clip(plan, clip_sensor(), options), InputError);
  options.shutter = {};
  options.motion = MotionPath::steady({.right_m = 1}, 1);
  EXPECT_THROW(Clip(plan, clip_sensor(), options), InputError);
  options.motion = {};
  options.frames = 0;
  EXPECT_THROW(Clip(plan, clip_sensor(), options), InputError);
  options.frames = 2;
  EXPECT_THROW(Clip(plan, clip_sensor(), options).frame(2), InputError);
  options.motion = MotionPath::steady({.pan_deg = 1e12}, 1);  // 1e11 steps in an exposure
  EXPECT_THROW(Clip(plan, clip_sensor(), options).frame(0), InputError);
}

TEST(MotionPath, IsStraightBetweenItsInstants) {
  const MotionPath path({{0, {}}, {1, {.pan_deg = 2}}, {3, {.pan_deg = 2, .pitch_deg = 4}}});
  EXPECT_DOUBLE_EQ(path.at(0.25).pan_deg, 0.5);
  EXPECT_DOUBLE_EQ(path.at(2).pitch_deg, 2);
  EXPECT_DOUBLE_EQ(path.at(-1).pan_deg, 0);
  EXPECT_DOUBLE_EQ(path.at(9).pitch_deg, 4);
  EXPECT_THROW(MotionPath({{1, {}}, {1, {}}}), InputError);
}

TEST(MotionPath, IsReadFromAFileAndSaysWhatIsWrongWithIt) {
  const test::Scratch scratch;
  const auto read = [&](const std::string& text) { return MotionPath::read(scratch.with("path.csv", text)); };
  const MotionPath path = read("t_s, pan_deg,up_m\n0,0,0\n0.5,1,2\n");
  EXPECT_DOUBLE_EQ(path.at(0.25).pan_deg, 0.5);
  EXPECT_DOUBLE_EQ(path.at(0.25).up_m, 1);
  for (const char* wrong : {"", "t_s,pan_deg\n", "pan_deg\n1\n", "t_s,yaw\n0,0\n", "t_s,pan_deg\n0\n",
                            "t_s,pan_deg\n0,x\n", "t_s,pan_deg\n1,0\n1,0\n"})
    EXPECT_THROW(read(wrong), InputError) << wrong;
}

}  // namespace
}  // namespace petzval
