// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/colour/illuminants.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/isp/develop.h>
#include <petzval/isp/display_picture.h>
#include <petzval/numeric/random.h>
#include <petzval/sensor/colour_calibration.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "mosaic_samples.h"
#include "scratch.h"

namespace petzval {
namespace {

/// Of uniform values a channel.
RawImage flat_raw(const Sensor& sensor, const std::vector<double>& shares) {
  RawImage raw;
  raw.columns = 24;
  raw.rows = 16;
  raw.mosaic = sensor.electronics->mosaic;
  raw.channels = sensor.electronics->channel_names();
  raw.black_level = 100;
  raw.white_level = 4100;
  raw.dn_per_e = 0.5;
  raw.read_noise_e = 3;
  for (int r = 0; r < raw.rows; ++r)
    for (int c = 0; c < raw.columns; ++c)
      raw.samples.push_back(static_cast<std::uint16_t>(
          std::lround(100 + 4000 * shares[static_cast<std::size_t>(raw.mosaic.channel(r, c))])));
  return raw;
}

TEST(LinearMosaic, LevelsBecomeZeroAndOne) {
  RawImage raw = flat_raw(read_sensor("full-frame-24mp"), {0, 0.5, 1});
  const LinearMosaic mosaic = linearised(raw);
  EXPECT_EQ(mosaic.values[0], 0);
  EXPECT_EQ(mosaic.values[1], 0.5f);
  EXPECT_EQ(mosaic.values[25], 1);
  raw.samples[0] = 0;
  EXPECT_FLOAT_EQ(linearised(raw).values[0], -100 / 4000.0f);
  raw.linearization.assign(65536, 2100);
  EXPECT_EQ(linearised(raw).values[7], 0.5f);
  raw.white_level = 50;
  EXPECT_THROW(linearised(raw), InputError);
}

TEST(LinearMosaic, DefectsAreFoundAndNothingElse) {
  LinearMosaic mosaic =
      test::bayer(40, 30, "RGGB", [](int channel, int, int c) { return 0.2 + 0.1 * channel + 0.001 * c; });
  const std::vector<float> sound = mosaic.values;
  for (const std::size_t at : {0u, 39u, 455u, 1199u}) mosaic.values[at] = 0.9f;
  mosaic.values[610] = 0;
  EXPECT_EQ(correct_defects(mosaic, 1e-5, 1e-7), 5);
  for (std::size_t i = 0; i < sound.size(); ++i) EXPECT_NEAR(mosaic.values[i], sound[i], 0.005f);
  EXPECT_EQ(correct_defects(mosaic, 1e-5, 1e-7), 0);
}

/// A slope of light from `dim` to twice that, as exposed by a sensor with an eighth more noise of its own
/// than photons make; some pixels are dead.
struct DeadPixels {
  LinearMosaic mosaic;
  std::vector<PixelPlace> dead;
};

constexpr double dead_test_scale = 1e-4, dead_test_offset = 1e-7;  // 10,000 e, 3 e in the dark

DeadPixels with_dead_pixels(double dim) {
  constexpr int columns = 400, rows = 300, between = 37;
  RandomStream random(5, 0, 0);
  DeadPixels made{test::bayer(columns, rows, "RGGB",
                              [&](int channel, int, int c) {
                                const double light = dim * (1 + c / 400.0) * (channel == 1 ? 1 : 0.8);
                                return light + std::sqrt(dead_test_scale * light + dead_test_offset) *
                                                   random.normal();
                              }),
                  {}};
  for (int place = 11; place < columns * rows; place += between * columns + between)
    made.dead.push_back({place / columns, place % columns});
  for (const PixelPlace& place : made.dead)
    made.mosaic.row(place.row)[static_cast<std::size_t>(place.column)] =
        static_cast<float>(std::sqrt(dead_test_offset) * random.normal());
  return made;
}

// A dead pixel is (level)/(noise) deviations below its neighbours: 63 and more at full exposure, 12 where
// there are 160 electrons, of which the darkest of eight neighbours takes 1.4 and the threshold 5.
TEST(LinearMosaic, DeadPixelsAreFoundInTheDarkToo) {
  for (const double dim : {0.5, 0.02}) {
    DeadPixels picture = with_dead_pixels(dim);
    const std::vector<float> before = picture.mosaic.values;
    const int found = correct_defects(picture.mosaic, dead_test_scale, dead_test_offset);
    for (const PixelPlace& place : picture.dead) {
      const auto at = static_cast<std::size_t>(place.row * picture.mosaic.columns + place.column);
      EXPECT_NE(picture.mosaic.values[at], before[at]) << dim << ": " << place.row << ", " << place.column;
    }
    // Beyond eight others by five deviations: one normal deviate in 10⁷ or so is.
    EXPECT_EQ(found, static_cast<int>(picture.dead.size())) << dim;
  }
}

TEST(LinearMosaic, KnownDefectsAreCorrectedWhereTheyCannotBeSeen) {
  constexpr double dim = 0.5 / 4096;  // half an electron
  DeadPixels picture = with_dead_pixels(dim);
  const std::vector<float> before = picture.mosaic.values;
  EXPECT_EQ(correct_defects(picture.mosaic, dead_test_scale, dead_test_offset, picture.dead),
            static_cast<int>(picture.dead.size()));
  std::size_t changed = 0;
  for (std::size_t i = 0; i < before.size(); ++i) changed += picture.mosaic.values[i] != before[i];
  EXPECT_EQ(changed, picture.dead.size());
}

// The light of a star through a lens falls on several pixels, whatever their colours.
TEST(LinearMosaic, StarsAreNoDefects) {
  for (const double place : {20.0, 20.25, 20.5, 21.0}) {
    constexpr double sigma_px = 0.7;  // an Airy disc of two pixels' diameter
    LinearMosaic star = test::bayer(41, 41, "RGGB", [&](int, int r, int c) {
      const double square = (r - place) * (r - place) + (c - place) * (c - place);
      return 0.01 + 0.6 * std::exp(-square / (2 * sigma_px * sigma_px));
    });
    EXPECT_EQ(correct_defects(star, dead_test_scale, dead_test_offset), 0) << place;
  }
}

// Mirroring at a border keeps the phase of mosaics of period two alone: others then compare pixels of two
// channels.
TEST(LinearMosaic, BordersOfLongMosaicsHaveNoDefectsOfTheirOwn) {
  const Mosaic rgbw{4, 4, {3, 0, 3, 1, 0, 3, 1, 3, 3, 1, 3, 2, 1, 3, 2, 3}};
  const Mosaic x_trans{6, 6, {1, 2, 1, 1, 0, 1, 0, 1, 0, 2, 1, 2, 1, 2, 1, 1, 0, 1,
                              1, 0, 1, 1, 2, 1, 2, 1, 2, 0, 1, 0, 1, 0, 1, 1, 2, 1}};
  const std::vector<std::string> names{"red", "green", "blue", "white"};
  for (const Mosaic& cells : {rgbw, x_trans, Mosaic{2, 2, {0, 1, 1, 2}}, Mosaic{1, 1, {0}}}) {
    LinearMosaic mosaic = test::mosaic_of(48, 36, cells, names, [](int channel, int r, int c) {
      return 0.2 + 0.2 * channel + 0.001 * c + 0.001 * r;
    });
    EXPECT_EQ(correct_defects(mosaic, 1e-5, 1e-7), 0) << cells.cells.size();
    const std::vector<float> sound = mosaic.values;
    const std::size_t corner = 0, edge = 20, last = mosaic.values.size() - 1;
    for (const std::size_t at : {corner, edge, last}) mosaic.values[at] = 0;
    EXPECT_EQ(correct_defects(mosaic, 1e-5, 1e-7), 3) << cells.cells.size();
    for (const std::size_t at : {corner, edge, last}) EXPECT_NEAR(mosaic.values[at], sound[at], 0.01f);
  }
}

TEST(LinearMosaic, ShadingIsDividedOut) {
  const auto fall_off = [](int r, int c) {
    return 1 - 0.0004 * ((r - 20) * (r - 20) + (c - 25) * (c - 25)) / 2;
  };
  LinearMosaic picture = test::bayer(
      50, 40, "RGGB", [&](int channel, int r, int c) { return (0.2 + 0.1 * channel) * fall_off(r, c); });
  const LinearMosaic flat = test::bayer(
      50, 40, "RGGB", [&](int channel, int r, int c) { return (0.5 + 0.1 * channel) * fall_off(r, c); });
  correct_shading(picture, flat, 2);
  // Smoothing rounds the top of the parabola: 0.0004/2 · 2 · 2 (the mean square of −2 … 2, twice), 8e-4. At
  // the border the parabola leaves its tangent by 0.0004/2 · (2² + 2²) within the square, where it is 0.8.
  for (int r = 0; r < 40; ++r)
    for (int c = 0; c < 50; ++c)
      EXPECT_NEAR(static_cast<double>(picture.row(r)[static_cast<std::size_t>(c)]) /
                      (0.2 + 0.1 * picture.mosaic.channel(r, c)),
                  1, r >= 6 && r < 34 && c >= 6 && c < 44 ? 2e-3 : 4e-3)
          << r << ", " << c;
  LinearMosaic black = flat;
  for (float& value : black.values) value = 0;
  EXPECT_THROW(correct_shading(picture, black, 2), InputError);
  EXPECT_THROW(correct_shading(picture, test::bayer(48, 40, "RGGB", [](int, int, int) { return 1.0; }), 2),
               InputError);
}

TEST(LinearMosaic, WhiteBalanceKeepsHighlightsWhite) {
  LinearMosaic mosaic = test::bayer(8, 8, "RGGB", [](int channel, int, int) {
    return channel == 0 ? 0.4 : channel == 1 ? 0.8 : 0.6;
  });
  for (const double part : grey_world_neutral(mosaic)) EXPECT_GT(part, 0);
  EXPECT_NEAR(grey_world_neutral(mosaic)[0], 0.5, 1e-6);
  balance_white(mosaic, {0.5, 1, 0.75});
  for (const float value : mosaic.values) EXPECT_NEAR(value, 0.8f, 1e-6f);
  for (float& value : mosaic.values) value = 1;
  balance_white(mosaic, {0.5, 1, 0.75});
  for (const float value : mosaic.values) EXPECT_EQ(value, 1);
  EXPECT_THROW(balance_white(mosaic, {1, 1}), InputError);
  EXPECT_THROW(balance_white(mosaic, {1, 0, 1}), InputError);
}

TEST(CameraMatrix, FindsTheLightOfTheNeutral) {
  const Sensor sensor = read_sensor("full-frame-24mp");
  RawImage raw = flat_raw(sensor, {0.3, 0.5, 0.4});
  raw.calibrations = standard_calibrations(sensor);
  // McCamy's polynomial is good to a few kelvins near D65, to some 10 K at A.
  EXPECT_NEAR(camera_matrix(raw, neutral_of(sensor, illuminant("D65"))).temperature_k, 6504, 30);
  EXPECT_NEAR(camera_matrix(raw, neutral_of(sensor, illuminant("A"))).temperature_k, 2856, 30);
  const double d50 = camera_matrix(raw, neutral_of(sensor, illuminant("D50"))).temperature_k;
  EXPECT_GT(d50, 4700);
  EXPECT_LT(d50, 5300);
  raw.calibrations.clear();
  EXPECT_THROW(camera_matrix(raw, {1, 1, 1}), InputError);
}

TEST(Develop, ABalancedGreyIsGrey) {
  for (const char* name : {"full-frame-24mp", "rgbw-1280x960", "quad-bayer-1280x960", "rccb-1280x960"}) {
    const Sensor sensor = read_sensor(name);
    for (const char* light : {"D65", "A"}) {
      const std::vector<double> neutral = neutral_of(sensor, illuminant(light));
      std::vector<double> shares = neutral;
      for (double& share : shares) share *= 0.4;
      RawImage raw = flat_raw(sensor, shares);
      raw.calibrations = standard_calibrations(sensor);
      raw.as_shot_neutral = neutral;
      const Planes picture = develop_planes(raw);
      // A sample is rounded by 1/8000 of white; white balance and matrix weigh that up to 30 times in
      // tungsten light.
      for (const auto& plane : picture.values)
        for (const float value : plane) ASSERT_NEAR(value, 0.4f, 4e-3f) << name << " " << light;
    }
  }
}

TEST(Develop, EveryStepIsTold) {
  const Sensor sensor = read_sensor("full-frame-24mp");
  RawImage raw = flat_raw(sensor, {0.3, 0.5, 0.4});
  raw.calibrations = standard_calibrations(sensor);
  std::vector<std::string> told;
  develop_planes(raw, {}, nullptr, [&](const std::string& name, const Planes& planes) {
    told.push_back(name);
    EXPECT_EQ(planes.values[0].size(), 24u * 16u);
  });
  EXPECT_EQ(told, develop_step_names());
}

TEST(Filters, DoWhatTheySay) {
  Planes step{40, 1, {std::vector<float>(40, 0.0f)}};
  for (std::size_t i = 20; i < 40; ++i) step.values[0][i] = 1;
  sharpen(step, 0.5, 1);
  EXPECT_LT(step.values[0][19], -0.1f);
  EXPECT_GT(step.values[0][20], 1.1f);
  EXPECT_THROW(sharpen(step, 1, 0), InputError);
  Planes bright{3, 1, {{-1, 0.2f, 4}, {0, 0.1f, 2}, {0, 0.1f, 1}}};
  apply_tone(bright, 1, ToneCurve::soft);
  EXPECT_EQ(bright.values[0][0], 0);
  EXPECT_FLOAT_EQ(bright.values[0][1], 0.4f);
  EXPECT_LE(bright.values[0][2], 1);
  EXPECT_FLOAT_EQ(bright.values[0][2] / bright.values[2][2], 4) << "hue stays";
  // White stays white, what brightening lifts beyond it comes back below, and nothing is turned over.
  for (const double ev : {0.0, 1.0, 3.0}) {
    Planes ramp{101, 1, std::vector<std::vector<float>>(3)};
    for (int i = 0; i <= 100; ++i)
      for (auto& plane : ramp.values) plane.push_back(static_cast<float>(i) / 100);
    apply_tone(ramp, ev, ToneCurve::soft);
    EXPECT_FLOAT_EQ(ramp.values[0][100], 1) << ev;
    for (std::size_t i = 1; i <= 100; ++i) EXPECT_GT(ramp.values[1][i], ramp.values[1][i - 1]) << ev;
  }
}

TEST(Filters, AutomaticBrightnessUndoesTheExposure) {
  RandomStream random(9, 0, 0);
  Planes ramp{400, 40, std::vector<std::vector<float>>(3, std::vector<float>(16000))};
  for (auto& plane : ramp.values)
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = static_cast<float>(i % 400) / 400;
  // The 99th of 100 blocks across holds the columns 392 to 395.
  EXPECT_NEAR(automatic_exposure_ev(ramp), -std::log2(393.5 / 400), 1e-5);
  Planes dim = ramp;
  for (auto& plane : dim.values)
    for (float& value : plane) value /= 128;
  EXPECT_NEAR(automatic_exposure_ev(dim), 7 + automatic_exposure_ev(ramp), 1e-5);
  for (auto& plane : dim.values)
    for (float& value : plane) value += static_cast<float>(0.1 / 128 * random.normal());
  // Blocks scatter by 0.025, the greatest of three planes of the brightest hundredth lie some 2.5 of it
  // higher.
  EXPECT_NEAR(automatic_exposure_ev(dim), 7, 0.12);
  Planes black{8, 8, {std::vector<float>(64)}};
  EXPECT_EQ(automatic_exposure_ev(black), 0);
}

/// Four bytes of an ICC file as s15Fixed16Number.
double fixed_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return static_cast<std::int32_t>(value) / 65536.0;
}

std::array<double, 3> colorant(const std::string& profile, const char* tag) {
  const std::size_t entry = profile.find(tag, 128);
  const auto start = static_cast<std::size_t>(std::lround(fixed_at(profile, entry + 4) * 65536));
  return {fixed_at(profile, start + 8), fixed_at(profile, start + 12), fixed_at(profile, start + 16)};
}

TEST(IccProfile, HasThePublishedColorants) {
  // The colorants of the sRGB profile of the ICC (sRGB2014.icc: 0.43607 0.22249 0.01392, …) and of Apple's
  // Display P3 (0.51512 0.2412 -0.00105, …); they round their whites in other places, up to 5e-4.
  const std::string srgb = icc_profile(DisplaySpace::srgb), p3 = icc_profile(DisplaySpace::display_p3);
  const std::pair<const char*, std::array<double, 3>> expected_srgb[] = {
      {"rXYZ", {0.43607, 0.22249, 0.01392}},
      {"gXYZ", {0.38515, 0.71687, 0.09708}},
      {"bXYZ", {0.14307, 0.06061, 0.71410}}};
  const std::pair<const char*, std::array<double, 3>> expected_p3[] = {{"rXYZ", {0.51512, 0.24120, -0.00105}},
                                                                       {"gXYZ", {0.29198, 0.69225, 0.04189}},
                                                                       {"bXYZ", {0.15710, 0.06657, 0.78407}}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(colorant(srgb, expected_srgb[i].first)[k], expected_srgb[i].second[k], 5e-4);
      EXPECT_NEAR(colorant(p3, expected_p3[i].first)[k], expected_p3[i].second[k], 5e-4);
    }
  std::uint32_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<unsigned char>(srgb[i]);
  EXPECT_EQ(size, srgb.size());
  EXPECT_EQ(srgb.substr(36, 4), "acsp");
}

TEST(IccProfile, ExiftoolReadsIt) {
  if (std::system("exiftool -ver >/dev/null 2>&1") != 0) GTEST_SKIP() << "exiftool is not installed";
  const test::Scratch scratch;
  Planes picture{2, 2, {{0, 0.5f, 1, 2}, {0, 0.5f, 1, 2}, {0, 0.5f, 1, 2}}};
  for (const char* name : {"a.png", "a.tif"}) {
    write_display_picture(scratch.path(name), picture, DisplaySpace::display_p3, 8, "test");
    const std::string command =
        "exiftool -s3 -ICC_Profile:ProfileDescription -ICC_Profile:MediaWhitePoint -validate -warning '" +
        scratch.path(name) + "' > '" + scratch.path("said") + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(read_whole_file(scratch.path("said")), "Display P3\n0.9642 1 0.82491\nOK\n") << name;
  }
}

TEST(DisplaySpace, Rec2100HasThePrimariesOfBt2020) {
  // White and red of BT.2020 (x 0.708, y 0.292).
  const ColourMatrix matrix = display_from_xyz(display_space("rec2100-pq"));
  const Xyz white = matrix * display_white(), red = matrix * Xyz{0.708 / 0.292, 1, 0};
  EXPECT_NEAR(white.x, 1, 1e-12);
  EXPECT_NEAR(white.z, 1, 1e-12);
  EXPECT_NEAR(red.y / red.x, 0, 1e-12);
}

TEST(DisplayPicture, CodesAreThoseOfTheCurve) {
  // Against the curve itself, for every 16-bit code: within one code of rounding.
  const test::Scratch scratch;
  const std::string path = scratch.path("codes.tif");
  Planes ramp{1024, 64, {{}}};
  for (int i = 0; i < 65536; ++i) ramp.values[0].push_back(static_cast<float>(srgb_decoded(i / 65535.0)));
  write_display_picture(path, ramp, DisplaySpace::srgb, 16, "");
  const TiffImage image = read_tiff(path);
  const auto& samples = std::get<std::vector<std::uint16_t>>(image.samples);
  for (int i = 0; i < 65536; ++i) EXPECT_NEAR(samples[static_cast<std::size_t>(i)], i, 1);
}

}  // namespace
}  // namespace petzval
