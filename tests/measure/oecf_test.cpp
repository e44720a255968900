// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/colour/display.h>
#include <petzval/measure/oecf.h>
#include <petzval/numeric/random.h>
#include <petzval/sensor/capture.h>

#include <cmath>
#include <fstream>

#include "scratch.h"

namespace petzval {
namespace {

constexpr int exposures = 8;

// 40,000 pixels: a standard deviation is known to 0.35 % (of temporal noise, over seven degrees of freedom,
// to 0.14 %); four of those.
TEST(PatchNoise, PartsWhatStaysFromWhatIsNew) {
  constexpr std::size_t pixels = 40000;
  RandomStream random(1, 2, 3);
  std::vector<double> pattern(pixels);
  for (double& value : pattern) value = 100 + 3 * random.normal();
  std::vector<std::vector<double>> frames(exposures, pattern);
  for (std::vector<double>& frame : frames)
    for (double& value : frame) value += 5 * random.normal();
  const PatchNoise noise = patch_noise(frames);
  EXPECT_NEAR(noise.mean, 100, 4 * 5 / std::sqrt(8.0 * pixels) + 4 * 3 / std::sqrt(1.0 * pixels));
  EXPECT_NEAR(noise.temporal / 5, 1, 4 * 0.0014);
  // Temporal noise over √8 is taken away, and known as well as that: (3² + 5²/8)/3² of the uncertainty.
  EXPECT_NEAR(noise.fixed_pattern / 3, 1, 4 * 0.0035 * 1.35);
  EXPECT_NEAR(noise.total(), std::hypot(noise.temporal, noise.fixed_pattern), 1e-12);
  EXPECT_THROW(patch_noise(std::span(frames).first(1)), InputError);
}

Sensor linear_sensor() {
  Sensor sensor;
  sensor.name = "test";
  sensor.geometry = {800, 200, 5};
  SensorElectronics electronics;
  electronics.channels = {{"grey", Spectrum({400, 700}, {0.5, 0.5})}};
  electronics.gain_modes = {{"base", 20000, 0.2, 6, 0, 8}};
  electronics.bits = 12;
  electronics.white_level_dn = 4095;
  electronics.black_level_dn = 60;
  electronics.prnu = 0.01;
  electronics.dsnu_e = 4;
  sensor.electronics = electronics;
  return sensor;
}

constexpr double greys_e[] = {0, 300, 1200, 4000, 12000, 19000, 26000};
constexpr int patch_side = 100;

// A chart of seven greys in electrons, on a sensor with known gain K, photon noise and read noise σ.
TEST(Oecf, ALinearSensorHasItsGainItsNoiseAndItsRange) {
  const Sensor sensor = linear_sensor();
  PhotoCurrent light{800, 200, 0, 0, std::vector<float>(800 * 200)};
  std::vector<GreyPatch> patches;
  for (int i = 0; i < 7; ++i) {
    patches.push_back({10 + 110 * i, 40, patch_side, patch_side, greys_e[i]});
    for (int row = 40; row < 40 + patch_side; ++row)
      for (int column = 10 + 110 * i; column < 10 + 110 * i + patch_side; ++column)
        light.e_per_s[static_cast<std::size_t>(row * 800 + column)] = static_cast<float>(greys_e[i]);
  }
  std::vector<RawImage> raws;
  CaptureOptions options;
  for (; raws.size() < exposures; ++options.seed) raws.push_back(capture(light, sensor, 1, options));
  const Oecf oecf = measure_oecf(raws, 0, patches);
  ASSERT_EQ(oecf.points.size(), 7U);
  EXPECT_TRUE(oecf.points[6].clipped);
  EXPECT_TRUE(oecf.saturates);
  const double read2 = 36 + 1 / (12 * 0.2 * 0.2);
  for (std::size_t i = 0; i < 6; ++i) {
    SCOPED_TRACE(greys_e[i]);
    const OecfPoint& point = oecf.points[i];
    const double e = greys_e[i], temporal = std::sqrt(e + read2), fixed = std::hypot(0.01 * e, 4);
    // 10,000 pixels: 0.7 % of a fixed pattern, 0.27 % of temporal noise; a mean to σ/100.
    EXPECT_NEAR(point.levels[0], 60 + 0.2 * e, 0.2 * 5 * std::hypot(temporal, fixed) / 100);
    EXPECT_NEAR(point.incremental_gain, 0.2, 0.2 * 0.02);
    EXPECT_NEAR(point.noise.temporal / (0.2 * temporal), 1, 4 * 0.0027);
    EXPECT_NEAR(point.noise.fixed_pattern / (0.2 * fixed), 1,
                4 * 0.007 * (1 + temporal * temporal / fixed / fixed / 8));
    EXPECT_NEAR(point.total_snr(), e / std::hypot(temporal, fixed), 0.03 * e / std::hypot(temporal, fixed));
    EXPECT_NEAR(point.temporal_snr(), e / temporal, 0.03 * e / temporal);
  }
  EXPECT_NEAR(oecf.least_exposure / std::sqrt(read2), 1, 0.03);
  EXPECT_NEAR(oecf.saturation_exposure / 20000, 1, 0.02);
  EXPECT_NEAR(20 * std::log10(oecf.dynamic_range()), 20 * std::log10(20000 / std::sqrt(read2)), 0.4);
  EXPECT_THROW(measure_oecf(raws, 1, patches), InputError);
  patches[0].x = 750;
  EXPECT_THROW(measure_oecf(raws, 0, patches), InputError);
}

/// A row of patches, 20 pixels wide, coded with sRGB's curve; noise in light differs by channel.
std::vector<ComparablePicture> coded_steps(const std::vector<double>& light) {
  std::vector<ComparablePicture> pictures(exposures);
  RandomStream random(7, 1, 1);
  for (ComparablePicture& picture : pictures) {
    picture.columns = 20 * static_cast<int>(light.size()), picture.rows = 40, picture.bands = 3;
    picture.interleaved = true;
    std::vector<double> values;
    for (int row = 0; row < picture.rows; ++row)
      for (int column = 0; column < picture.columns; ++column)
        for (int c = 0; c < 3; ++c)
          values.push_back(srgb_encoded(light[static_cast<std::size_t>(column / 20)]) +
                           0.01 * (c + 1) * random.normal());
    picture.values = std::move(values);
  }
  return pictures;
}

// The derivative of sRGB's curve above its foot is 1.055/2.4 · L^(1/2.4 − 1); steps of 6 % in light lie on it
// to their third order, 2e-4.
TEST(Oecf, APictureForDisplayHasTheCurveOfSrgb) {
  std::vector<double> light;
  for (double l = 0.05; l < 0.9; l *= 1.2) light.push_back(l);
  std::vector<GreyPatch> patches;
  for (std::size_t i = 0; i < light.size(); ++i)
    patches.push_back({20 * static_cast<int>(i), 0, 20, 40, light[i]});
  const Oecf oecf = measure_oecf(coded_steps(light), patches);
  EXPECT_FALSE(oecf.saturates);
  EXPECT_EQ(oecf.saturation_exposure, light.back());
  // Channels have 0.01, 0.02 and 0.03: luminance, and both differences, as their weights say.
  const double y2 = std::pow(0.2125 * 0.01, 2) + std::pow(0.7154 * 0.02, 2) + std::pow(0.0721 * 0.03, 2);
  const double r2 = std::pow(0.7875 * 0.01, 2) + std::pow(0.7154 * 0.02, 2) + std::pow(0.0721 * 0.03, 2);
  const double b2 = std::pow(0.2125 * 0.01, 2) + std::pow(0.7154 * 0.02, 2) + std::pow(0.9279 * 0.03, 2);
  const double weighted = std::sqrt(y2 + 0.279 * r2 + 0.088 * b2);
  for (std::size_t i = 1; i + 1 < light.size(); ++i) {
    const OecfPoint& point = oecf.points[i];
    // 800 pixels, eight times: means to 0.03/80; gains over steps of 0.4 l.
    for (const double level : point.levels) EXPECT_NEAR(level, srgb_encoded(light[i]), 5 * 0.03 / 80);
    const double slope = 1.055 / 2.4 * std::pow(light[i], 1 / 2.4 - 1);
    EXPECT_NEAR(point.incremental_gain / slope, 1, 0.01 + 5 * 0.02 / 80 / (0.4 * light[i] * slope));
    EXPECT_NEAR(point.noise.temporal / weighted, 1, 0.06);  // 5600 degrees of freedom, 1 %
  }
}

TEST(Oecf, PatchesComeFromATable) {
  const test::Scratch scratch;
  const auto written = [&](const char* text) {
    std::ofstream(scratch.path("p.csv")) << text;
    return scratch.path("p.csv");
  };
  const auto patches = read_grey_patches(written("x_px,y_px,width_px,height_px,exposure\n1,2,30,40,0.5\n\n"));
  ASSERT_EQ(patches.size(), 1U);
  EXPECT_EQ(patches[0].height, 40);
  EXPECT_EQ(patches[0].exposure, 0.5);
  for (const char* bad : {"x,y\n1,2\n", "x_px,y_px,width_px,height_px,exposure\n1,2,3,4\n",
                          "x_px,y_px,width_px,height_px,exposure\n1,2,3.5,4,1\n"})
    EXPECT_THROW(read_grey_patches(written(bad)), InputError);
}

}  // namespace
}  // namespace petzval
