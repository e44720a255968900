// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/colour/illuminants.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/simulate/outputs.h>
#include <scratch.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace petzval {
namespace {

/// Light of D65 on a whole sensor, brighter from left to right.
SpectralImage daylight(const Sensor& sensor) {
  const Spectrum light = illuminant("D65");
  std::vector<double> nm;
  for (int at = 380; at <= 780; at += 10) nm.push_back(at);
  SpectralImage image(64, 48, nm, sensor.geometry.pitch_um);
  for (int band = 0; band < image.bands(); ++band)
    for (int row = 0; row < image.rows(); ++row)
      for (int column = 0; column < image.columns(); ++column)
        image.at(band, row, column) =
            static_cast<float>(1e-5 * light.at(nm[static_cast<std::size_t>(band)]) * (1 + column / 64.0));
  image.illuminant = light;
  image.lens = LensFacts{"a lens", 50, 4, -60};
  return image;
}

Sensor colour_sensor() {
  return read_sensor("third-inch-1280x960");
}

TEST(Expose, GivesARawImageThatDevelops) {
  const Sensor sensor = colour_sensor();
  const RawImage raw = expose(daylight(sensor), sensor);
  EXPECT_EQ(raw.calibrations.size(), 2U);
  EXPECT_EQ(raw.as_shot_neutral.size(), raw.channels.size());
  EXPECT_GT(raw.iso, 0);
  EXPECT_EQ(raw.lens.name, "a lens");
  const Picture picture = develop(raw);
  EXPECT_EQ(picture.planes.values.size(), 3U);
  EXPECT_NEAR(picture.report.temperature_k, 6500, 200);
}

// A grey scene in its own light is grey: red, green and blue agree but for noise.
TEST(Expose, KnowsTheWhiteOfTheScene) {
  const Sensor sensor = colour_sensor();
  ExposeOptions quiet;
  for (const char* source : {"shot", "read", "dsnu", "prnu", "dark"})
    quiet.without.insert(noise_source(source));
  const Picture picture = develop(expose(daylight(sensor), sensor, quiet));
  double means[3] = {};
  for (std::size_t channel = 0; channel < 3; ++channel)
    for (const float value : picture.planes.values[channel]) means[channel] += static_cast<double>(value);
  EXPECT_NEAR(means[0] / means[1], 1, 5e-3);
  EXPECT_NEAR(means[2] / means[1], 1, 5e-3);
}

TEST(Expose, TellsWhenTheLightIsNotKnown) {
  const Sensor sensor = colour_sensor();
  SpectralImage light = daylight(sensor);
  light.illuminant.reset();
  std::vector<std::string> notes;
  Context context;
  context.note = [&](const std::string& text) { notes.push_back(text); };
  expose(light, sensor, {}, context);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes.front().find("grey on average"), std::string::npos);
}

TEST(Expose, TakesTheSeedOfItsContext) {
  const Sensor sensor = colour_sensor();
  const SpectralImage light = daylight(sensor);
  Context first, other;
  first.seed = 1, other.seed = 2;
  EXPECT_EQ(expose(light, sensor, {}, first).samples, expose(light, sensor, {}, first).samples);
  EXPECT_NE(expose(light, sensor, {}, first).samples, expose(light, sensor, {}, other).samples);
}

TEST(Exposure, HasOneGrammar) {
  EXPECT_EQ(Exposure::parse("auto").kind, Exposure::Kind::automatic);
  EXPECT_EQ(Exposure::parse("0.01").value, 0.01);
  EXPECT_EQ(Exposure::parse("ev:12").kind, Exposure::Kind::exposure_value);
  for (const char* same : {"10ms", "1/100", "0.01s", "10000us", "1/100s"})
    EXPECT_NEAR(Exposure::parse(same).value, 0.01, 1e-15) << same;
  for (const char* wrong : {"", "fast", "-1", "ev:", "1/", "/100", "1/0", "ms", "1min"})
    EXPECT_THROW(Exposure::parse(wrong), InputError) << wrong;
}

// t = N²/2^EV.
TEST(Exposure, OfAValueFollowsTheFNumber) {
  const Sensor sensor = colour_sensor();
  ExposeOptions options;
  options.exposure = Exposure::of_value(10);
  EXPECT_NEAR(expose(daylight(sensor), sensor, options).exposure_s, 16 / std::exp2(10), 1e-12);
  options.compensation_ev = 1;
  EXPECT_NEAR(expose(daylight(sensor), sensor, options).exposure_s, 32 / std::exp2(10), 1e-12);
}

TEST(WhiteBalance, HasOneGrammar) {
  EXPECT_EQ(WhiteBalance::parse("as-shot").kind, WhiteBalance::Kind::as_shot);
  EXPECT_EQ(WhiteBalance::parse("grey-world").kind, WhiteBalance::Kind::grey_world);
  EXPECT_EQ(WhiteBalance::parse("0.5,1,0.7").neutral, (std::vector<double>{0.5, 1, 0.7}));
  EXPECT_EQ(WhiteBalance::parse("D65").kind, WhiteBalance::Kind::light);
  EXPECT_THROW(WhiteBalance::parse("moonshine"), InputError);
}

TEST(Outputs, AreAllWrittenFromOneLight) {
  const test::Scratch folder;
  const Sensor sensor = colour_sensor();
  const auto path = [&](const char* name) { return folder.path(name); };
  const Outputs made =
      write_outputs(daylight(sensor), {path("a.exr"), path("a.dng"), path("a.png"), path("a.tif")}, sensor);
  for (const char* name : {"a.exr", "a.dng", "a.png", "a.tif"})
    EXPECT_TRUE(std::filesystem::exists(path(name))) << name;
  ASSERT_TRUE(made.raw && made.picture);
  EXPECT_EQ(read_dng(path("a.dng")).samples, made.raw->samples);
}

TEST(Outputs, AreRefusedBeforeTheLightIsComputed) {
  const Sensor sensor = colour_sensor(), frame = read_sensor("64x48@5");
  EXPECT_THROW(check_outputs({"a.bmp"}, sensor), InputError);
  EXPECT_THROW(check_outputs({"a.dng"}, frame), InputError);
  EXPECT_THROW(check_outputs({"a.dng"}, {}), InputError);
  EXPECT_THROW(check_outputs({"a.tif"}, frame), InputError);
  OutputOptions wrong;
  wrong.expose.gain_mode = "none such";
  EXPECT_THROW(check_outputs({"a.dng"}, sensor, wrong), InputError);
  check_outputs({"a.exr", "a.png"}, frame);
}

TEST(Outputs, LeaveNothingBehindWhenTheyAreStopped) {
  const test::Scratch folder;
  const Sensor sensor = colour_sensor();
  Context context;
  context.progress = [](double, const std::string&) { return false; };
  EXPECT_THROW(write_outputs(daylight(sensor), {folder.path("a.dng")}, sensor, {}, context), Cancelled);
  EXPECT_TRUE(folder.is_empty());
}

}  // namespace
}  // namespace petzval
