// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/sensor/capture.h>
#include <petzval/sensor/merged_exposures.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/poisson.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "flat_sensor.h"

namespace petzval {
namespace {

PhotoCurrent flat(int columns, int rows, double e_per_s) {
  return {columns, rows, 0, 0,
          std::vector<float>(static_cast<std::size_t>(columns * rows), static_cast<float>(e_per_s))};
}

double mean(const RawImage& raw) {
  double sum = 0;
  for (const std::uint16_t value : raw.samples) sum += value;
  return sum / static_cast<double>(raw.samples.size());
}

/// Temporal variance from the difference of two exposures, in which fixed patterns cancel (EMVA 1288, 6.6).
double temporal_variance(const RawImage& a, const RawImage& b) {
  const double shift = mean(a) - mean(b);
  double sum = 0;
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    const double d = static_cast<double>(a.samples[i]) - b.samples[i] - shift;
    sum += d * d;
  }
  return sum / static_cast<double>(a.samples.size() - 1) / 2;
}

RawImage shot(const Sensor& sensor, double electrons, std::uint64_t seed, CaptureOptions options = {}) {
  options.seed = seed;
  return capture(flat(sensor.geometry.columns, sensor.geometry.rows, electrons), sensor, 1, options);
}

TEST(Capture, WithoutNoiseIsExact) {
  const Sensor sensor = test::mono_sensor(3, 2);
  CaptureOptions options;
  options.without = {NoiseSource::shot};
  for (const double electrons : {0.0, 10.0, 1001.0, 99999.0})
    for (const std::uint16_t value : shot(sensor, electrons, 1, options).samples)
      EXPECT_EQ(value, std::floor(100 + 0.5 * electrons + 0.5));
}

TEST(Capture, ElectronsArePoissonDistributed) {
  // One DN an electron, nothing else: the histogram of 300 x 300 pixels against Boost.Math's probabilities.
  // Four levels; a p value below 1e-4 comes once in 2500 seeds, and the seed is fixed.
  Sensor sensor = test::mono_sensor(300, 300);
  sensor.electronics->gain_modes[0].dn_per_e = 1;
  for (const double level : {0.1, 1.0, 5.0, 50.0}) {
    std::vector<double> counts(65536);
    for (const std::uint16_t value : shot(sensor, level, 4).samples)
      ++counts[static_cast<std::size_t>(value - 100)];
    const boost::math::poisson law(level);
    const double n = 90000;
    double chi2 = 0, expected = 0, seen = 0, left_expected = n, left_seen = n;
    int bins = 0;
    for (std::size_t k = 0; k < 200; ++k) {
      expected += n * pdf(law, static_cast<double>(k));
      seen += counts[k];
      if (expected < 10 || left_expected - expected < 10) continue;
      chi2 += (seen - expected) * (seen - expected) / expected;
      left_expected -= expected, left_seen -= seen, expected = seen = 0;
      ++bins;
    }
    chi2 += (left_seen - left_expected) * (left_seen - left_expected) / left_expected;
    const double p = 1 - cdf(boost::math::chi_squared(bins), chi2);
    EXPECT_GT(p, 1e-4) << level;
    EXPECT_LT(p, 1 - 1e-4) << level;
  }
}

TEST(Capture, PhotonTransferFollowsTheModel) {
  // σ² = K² (σ_r² + μ) + 1/12 (EMVA 1288, equation 12), with non-uniformities that must cancel. Standard
  // error of a variance of n differences: √(2/n); of five levels, each within 4.5 of them (once in 30,000
  // seeds).
  Sensor sensor = test::mono_sensor(200, 200);
  sensor.electronics->gain_modes[0].read_noise_e = 4;
  sensor.electronics->gain_modes[0].adc_noise_dn = 1.5;
  sensor.electronics->prnu = 0.01;
  sensor.electronics->dsnu_e = 3;
  sensor.electronics->column_pattern_e = 2;
  for (const double electrons : {1.0, 10.0, 100.0, 3000.0, 90000.0}) {
    const RawImage a = shot(sensor, electrons, 1), b = shot(sensor, electrons, 2);
    // PRNU of 1 % adds 1e-4 to the mean of the squares of single pixels only; its mean is 0.
    const double expected = 0.25 * (16 + electrons) + 2.25 + 1.0 / 12;
    EXPECT_NEAR(temporal_variance(a, b) / expected, 1, 4.5 * std::sqrt(2.0 / 40000)) << electrons;
    EXPECT_NEAR(
        (mean(a) - 100) / 0.5, electrons,
        4.5 * std::sqrt((electrons + 40 + 1e-4 * electrons * electrons) / 40000) + 2 * 4.5 / std::sqrt(200));
  }
}

TEST(Capture, SaturatesAtTheFullWell) {
  Sensor sensor = test::mono_sensor(20, 20);
  const RawImage raw = shot(sensor, 300000, 1);
  for (const std::uint16_t value : raw.samples) EXPECT_EQ(value, 50100);
  EXPECT_EQ(raw.white_level, 50100);
  CaptureOptions options;
  options.analog_gain = 2;  // now the converter ends first
  for (const std::uint16_t value : shot(sensor, 300000, 1, options).samples) EXPECT_EQ(value, 65535);
}

TEST(Capture, AveragingLeavesTheFixedPattern) {
  Sensor sensor = test::mono_sensor(200, 200);
  sensor.electronics->gain_modes[0].dn_per_e = 0.6;
  sensor.electronics->gain_modes[0].read_noise_e = 10;
  sensor.electronics->prnu = 0.02;
  const double electrons = 1000;
  const double single = temporal_variance(shot(sensor, electrons, 1), shot(sensor, electrons, 2));
  for (const int frames : {4, 16, 64}) {
    CaptureOptions options;
    options.frames = frames;
    const RawImage a = shot(sensor, electrons, 3, options), b = shot(sensor, electrons, 4, options);
    const double steps = a.dn_per_e / 0.6;
    // Twice the standard error of a variance (two are compared), 4.5 times; the rounding of the mean adds
    // 1/12 of a step.
    EXPECT_NEAR((temporal_variance(a, b) - 1.0 / 12) / (steps * steps) * frames / single, 1,
                4.5 * std::sqrt(4.0 / 40000))
        << frames;
    const double level = mean(a);
    double square = 0;
    for (const std::uint16_t value : a.samples) square += std::pow(value - level, 2) / 40000;
    const double spatial = std::sqrt(square - temporal_variance(a, b)) / (level - a.black_level);
    EXPECT_NEAR(spatial, 0.02, 0.02 * 4.5 / std::sqrt(2.0 * 40000) * 1.3)
        << frames;  // noise of the estimate of noise
  }
}

TEST(Capture, SourcesSwitchOffOneByOne) {
  Sensor sensor = test::mono_sensor(40, 40);
  SensorElectronics& e = *sensor.electronics;
  e.white_level_dn = 8191;
  e.gain_modes[0].read_noise_e = 6;
  e.gain_modes[0].full_well_e = 15000;  // which hot pixels exceed
  e.blooming_onset = 1;
  e.prnu = 0.01;
  e.dsnu_e = 20;
  e.column_pattern_e = 30;
  e.row_noise_e = 30;
  e.dark_current_e_per_s = 200;
  e.hot_pixels_per_million = 5000;
  e.hot_current_e_per_s = 20000;
  e.linearity_fractions = {0, 1};
  e.linearity_deviations = {0, -0.2};
  const RawImage all = shot(sensor, 5000, 1);
  for (const std::string& name : noise_source_names()) {
    const NoiseSource source = noise_source(name);
    if (source == NoiseSource::crosstalk || source == NoiseSource::microlens)
      continue;  // of the light, not of the capture
    CaptureOptions options;
    options.without = {source};
    EXPECT_NE(shot(sensor, 5000, 1, options).samples, all.samples) << name;
  }
  // What one source draws does not depend on the others: the read noise of a pixel is the same with and
  // without dark current, so the difference is a constant when nothing is random.
  CaptureOptions no_shot, neither;
  no_shot.without = {NoiseSource::shot, NoiseSource::linearity, NoiseSource::defects};
  neither.without = {NoiseSource::shot, NoiseSource::linearity, NoiseSource::defects, NoiseSource::dark};
  const RawImage a = shot(sensor, 5000, 1, no_shot), b = shot(sensor, 5000, 1, neither);
  for (std::size_t i = 0; i < a.samples.size(); ++i)
    EXPECT_EQ(a.samples[i] - b.samples[i], 100);  // 200 e · 0.5
  EXPECT_THROW(noise_source("shots"), InputError);
}

TEST(Capture, PatternsBelongToTheSerialNumber) {
  Sensor sensor = test::mono_sensor(30, 30);
  sensor.electronics->prnu = 0.05;
  CaptureOptions quiet;
  quiet.without = {NoiseSource::shot};
  const RawImage one = shot(sensor, 9000, 1, quiet), other_exposure = shot(sensor, 9000, 2, quiet);
  EXPECT_EQ(one.samples, other_exposure.samples);
  quiet.serial = 99;
  EXPECT_NE(shot(sensor, 9000, 1, quiet).samples, one.samples);
  // A frame from the middle sees the middle of the pattern.
  quiet.serial.reset();
  PhotoCurrent middle = flat(10, 10, 9000);
  middle.first_column = middle.first_row = 10;
  const RawImage small = capture(middle, sensor, 1, quiet);
  for (std::size_t r = 0; r < 10; ++r)
    for (std::size_t c = 0; c < 10; ++c)
      EXPECT_EQ(small.samples[10 * r + c], one.samples[30 * (r + 10) + c + 10]);
}

TEST(Capture, BytesDoNotDependOnThreads) {
  Sensor sensor = test::mono_sensor(123, 77);
  sensor.electronics->prnu = 0.01;
  sensor.electronics->gain_modes[0].read_noise_e = 3;
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return shot(sensor, 700, 5).samples;
  };
  EXPECT_EQ(with_threads(1), with_threads(2));
  EXPECT_EQ(with_threads(1), with_threads(7));
  EXPECT_NE(shot(sensor, 700, 5).samples, shot(sensor, 700, 6).samples);
}

TEST(Capture, DarkCurrentDoubles) {
  Sensor sensor = test::mono_sensor(100, 100);
  sensor.electronics->dark_current_e_per_s = 1000;
  sensor.electronics->dark_temperature_c = 20;
  sensor.electronics->dark_doubling_c = 8;
  for (const double temperature : {20.0, 28.0, 44.0}) {
    CaptureOptions options;
    options.temperature_c = temperature;
    const double expected = 1000 * std::exp2((temperature - 20) / 8);
    EXPECT_NEAR((mean(shot(sensor, 0, 1, options)) - 100) / 0.5, expected, 5 * std::sqrt(expected / 1e4));
  }
}

TEST(Capture, LinearizationUndoesTheDeparture) {
  Sensor sensor = test::mono_sensor(4, 4);
  sensor.electronics->bits = 14;
  sensor.electronics->white_level_dn = 16383;
  sensor.electronics->gain_modes[0].dn_per_e = 0.16;
  sensor.electronics->linearity_fractions = {0, 0.5, 1};
  sensor.electronics->linearity_deviations = {0, 0.01, -0.08};
  CaptureOptions options;
  options.without = {NoiseSource::shot};
  for (const double electrons : {0.0, 100.0, 20000.0, 70000.0, 99000.0}) {
    const RawImage raw = shot(sensor, electrons, 1, options);
    raw.validate();
    // Half a DN of the converter is 3.1 e, and the curve steepens it by less than 1.2.
    EXPECT_NEAR((raw.pixel(1, 1) - raw.black_level) / raw.dn_per_e, electrons, 4) << electrons;
  }
}

TEST(Capture, BracketsReachBeyondSaturation) {
  Sensor sensor = test::mono_sensor(50, 2);
  PhotoCurrent ramp = flat(50, 2, 0);
  for (std::size_t i = 0; i < 100; ++i)
    ramp.e_per_s[i] = static_cast<float>(std::exp2(static_cast<double>(i % 50) / 3 + 4));
  std::vector<RawImage> frames;
  for (const double seconds : {1.0, 4.0, 16.0}) {
    CaptureOptions options;
    options.seed = static_cast<std::uint64_t>(seconds);
    frames.push_back(capture(ramp, sensor, seconds, options));
  }
  const RawImage merged = merge_bracket(frames);
  merged.validate();
  EXPECT_EQ(merged.exposure_s, 1);
  for (std::size_t i = 0; i < 100; ++i) {
    const double rate = static_cast<double>(ramp.e_per_s[i]);
    if (rate > 90000) continue;
    const double seconds = 16 * rate < 85000 ? 21 : 4 * rate < 85000 ? 5 : 1;
    const double value = (merged.samples[i] - merged.black_level) / merged.dn_per_e;
    EXPECT_NEAR(value, rate, 5 * std::sqrt(rate / seconds) + 2)
        << rate;  // shot noise of all frames that count; rounding
  }
  EXPECT_THROW(merge_bracket({}), InputError);
}

/// Mean and variance of even light's pixels.
std::pair<double, double> mean_and_variance(const RawImage& raw) {
  double sum = 0, squares = 0;
  for (int row = 0; row < raw.rows; ++row)
    for (int column = 0; column < raw.columns; ++column) {
      const double value = raw.pixel(row, column) - raw.black_level;
      sum += value, squares += value * value;
    }
  const auto n = static_cast<double>(raw.samples.size());
  return {sum / n, (squares - sum * sum / n) / (n - 1)};
}

// What is stated of the noise against that of stacks. A variance of 10,000 pixels is known to 1.4 %, four
// standard errors are 6 %: of averaged frames that is the bound. A line cannot be both the noise of all
// exposures and that of the shortest: the bound of times 1 : 4 : 16 is the root of 21, and 6 %.
TEST(Capture, StatedNoiseIsThatOfMeansAndOfBrackets) {
  Sensor sensor = test::mono_sensor(100, 100);
  sensor.electronics->gain_modes[0].read_noise_e = 5;
  for (const double electrons : {0.0, 30.0, 1000.0, 80000.0}) {
    CaptureOptions options;
    options.frames = 16;
    const RawImage mean = shot(sensor, electrons, 1, options);
    const auto [level, variance] = mean_and_variance(mean);
    EXPECT_NEAR((mean.noise_slope() * level + mean.noise_offset()) / variance, 1, 0.06) << electrons;
  }
  sensor.electronics->gain_modes[0].read_noise_e =
      50;  // 2.7 steps of the merged numbers, whatever rounding does
  double least = 1e9, most = 0;
  for (const double rate : {0.0, 1.0, 10.0, 100.0, 1000.0, 4000.0, 8000.0, 20000.0, 40000.0, 85000.0}) {
    std::vector<RawImage> frames;
    for (const double seconds : {1.0, 4.0, 16.0}) {
      CaptureOptions options;
      options.seed = static_cast<std::uint64_t>(seconds);
      frames.push_back(capture(flat(100, 100, rate), sensor, seconds, options));
    }
    const RawImage merged = merge_bracket(frames);
    const auto [level, variance] = mean_and_variance(merged);
    const double ratio = (merged.noise_slope() * level + merged.noise_offset()) / variance;
    least = std::min(least, ratio), most = std::max(most, ratio);
    if (rate == 0) {
      EXPECT_NEAR(ratio, 1, 0.06);
    }
    EXPECT_LT(std::abs(std::log(ratio)), std::log(1.06 * std::sqrt(21.0))) << rate;
  }
  RecordProperty("least", std::to_string(least)), RecordProperty("most", std::to_string(most));
}

// One exposure, read at two conversion gains. Photons are the same in both readings, read noise is not: with
// weights 1/σ² the variance is μ + 1/Σ(1/σ²), beyond the smaller well μ + σ² of the larger. 10,000 pixels
// tell a variance to 1.4 %.
TEST(Capture, ReadingsAtTwoGainsAreMergedWithTheLeastNoise) {
  Sensor sensor = test::mono_sensor(100, 100);
  sensor.electronics->gain_modes = {{"low", 100000, 0.5, 20, 0, 1}, {"high", 10000, 5, 2, 0, 1}};
  const auto merged = [&](double electrons, std::set<NoiseSource> without) {
    std::vector<RawImage> readings;
    for (const char* mode : {"low", "high"}) {
      CaptureOptions options;
      options.gain_mode = mode;
      options.without = without;
      options.reading = static_cast<int>(readings.size());
      readings.push_back(capture(flat(100, 100, static_cast<float>(electrons)), sensor, 1, options));
    }
    return merge_readings(readings);
  };
  const auto statistics = [](const RawImage& raw) {
    double mean = 0, square = 0;
    for (const std::uint16_t sample : raw.samples) {
      const double e = (sample - raw.black_level) / raw.dn_per_e;
      mean += e / 1e4;
      square += e * e / 1e4;
    }
    return std::pair(mean, square - mean * mean);
  };
  constexpr double of_both = 1 / (1 / 4.0 + 1 / 400.0), bound = 4.5 * 0.0142;
  const RawImage dark = merged(0, {});
  const double step2 = 1 / (12 * dark.dn_per_e * dark.dn_per_e);
  EXPECT_NEAR(dark.read_noise_e * dark.read_noise_e / (of_both + step2), 1, 0.01);
  for (const auto& [electrons, variance] :
       {std::pair{0.0, of_both}, {50.0, 50 + of_both}, {5000.0, 5000 + of_both}, {40000.0, 40000 + 400.0}}) {
    const auto [mean, measured] = statistics(merged(electrons, {}));
    EXPECT_NEAR(measured / (variance + step2), 1, bound) << electrons;
    EXPECT_NEAR(mean, electrons, 4.5 * std::sqrt(variance) / 100) << electrons;
  }
  EXPECT_NEAR(statistics(merged(300, {NoiseSource::shot})).second / (of_both + step2), 1, bound);
  EXPECT_THROW(merge_readings({}), InputError);
}

TEST(Capture, AbsurdOrdersAreRefused) {
  const Sensor sensor = test::mono_sensor(4, 4);
  const PhotoCurrent light = flat(4, 4, 1);
  CaptureOptions options;
  options.analog_gain = 17;
  EXPECT_THROW(capture(light, sensor, 1, options), InputError);
  options.analog_gain = 0.5;
  EXPECT_THROW(capture(light, sensor, 1, options), InputError);
  options.analog_gain = std::nan("");
  EXPECT_THROW(capture(light, sensor, 1, options), InputError);
  EXPECT_THROW(capture(light, sensor, -1, {}), InputError);
  EXPECT_THROW(capture(light, sensor, INFINITY, {}), InputError);
  options = {};
  options.frames = 0;
  EXPECT_THROW(capture(light, sensor, 1, options), InputError);
  options = {};
  options.gain_mode = "none";
  EXPECT_THROW(capture(light, sensor, 1, options), InputError);
}

}  // namespace
}  // namespace petzval
