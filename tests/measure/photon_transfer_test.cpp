// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/measure/photon_transfer.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace petzval {
namespace {

Sensor sensor_under_test() {
  Sensor sensor;
  sensor.name = "test";
  sensor.geometry = {300, 300, 5};
  SensorElectronics electronics;
  electronics.channels = {{"grey", Spectrum({400, 700}, {0.5, 0.5})}};
  electronics.gain_modes = {{"base", 20000, 0.2, 4, 0.3, 8}};
  electronics.bits = 12;
  electronics.white_level_dn = 4095;
  electronics.black_level_dn = 60;
  electronics.prnu = 0.012;
  electronics.dsnu_e = 7;
  sensor.electronics = electronics;
  return sensor;
}

const SensorTest& tested() {
  static const SensorTest test = test_sensor(sensor_under_test(), {}, 0, 256, 24, 40);
  return test;
}

TEST(PhotonTransfer, RecoversTheSensor) {
  const SensorTest& test = tested();
  // 65,536 pixels: a variance is known to √(2/65536) = 0.55 %, the slope over 14 levels to 0.15 %; 5 of
  // those.
  EXPECT_NEAR(test.transfer.dn_per_e, 0.2, 0.2 * 0.01);
  // The dark variance is 0.64 + 0.09 + 1/12 DN².
  EXPECT_NEAR(test.transfer.dark_noise_e, std::hypot(4, 0.3 / 0.2), 0.1);
  EXPECT_FALSE(test.transfer.quantisation_limited);
  ASSERT_TRUE(test.transfer.full_signal_e);
  EXPECT_NEAR(*test.transfer.full_signal_e, 20000, 20000 * 0.01);
  const double least = std::sqrt(16 + 2.25 + 25 / 12.0 + 0.25) + 0.5;
  EXPECT_NEAR(test.transfer.dynamic_range_db, 20 * std::log10(test.transfer.saturation_e / least), 0.1);
  EXPECT_NEAR(test.transfer.snr_max_db, 10 * std::log10(20000), 0.3);
}

// ISO 15739 at 0.18/√2 of 20,000 e: photons, read noise, steps; PRNU and DSNU. Known as said below.
TEST(GreyNoise, HasThePartsThatTheSensorHas) {
  const GreyNoise& grey = tested().grey;
  const double e = 0.18 / std::sqrt(2.0) * 20000, read2 = 16 + 2.25 + 25 / 12.0;
  const double temporal = std::sqrt(e + read2), fixed = std::hypot(0.012 * e, 7);
  EXPECT_NEAR(grey.signal_e / e, 1, 0.01);
  EXPECT_NEAR(grey.temporal_snr / (e / temporal), 1, 0.01);
  EXPECT_NEAR(grey.fixed_pattern_snr / (e / fixed), 1, 0.015);
  EXPECT_NEAR(grey.total_snr / (e / std::hypot(temporal, fixed)), 1, 0.01);
  EXPECT_NEAR(grey.dynamic_range_db, 20 * std::log10(tested().transfer.saturation_e / std::sqrt(read2)), 0.1);
}

TEST(NonUniformity, IsRecoveredWithinTwoPercent) {
  // Standard error of a standard deviation of 65,536 values: 0.28 %. Of DSNU, temporal noise (4.5 e) over √40
  // adds little.
  const SensorTest& test = tested();
  EXPECT_NEAR(test.uniformity.dsnu_e / 7, 1, 0.02);
  EXPECT_NEAR(test.uniformity.prnu_percent / 1.2, 1, 0.02);
}

TEST(NonUniformity, IsNoneWhereThereIsNone) {
  CaptureOptions options;
  options.without = {NoiseSource::prnu, NoiseSource::dsnu};
  const SensorTest test = test_sensor(sensor_under_test(), options, 0, 200, 20, 40);
  // What is left is the uncertainty of the subtraction: a temporal variance of (1 %)²/40, known to
  // √(2/40000), so that three standard errors look like 0.023 % of PRNU; of DSNU, (4.5 e)²/40 in the same way
  // like 0.1 e.
  EXPECT_LT(test.uniformity.dsnu_e, 0.15);
  EXPECT_LT(test.uniformity.prnu_percent, 0.03);
}

double standard_normal(double x) {
  return std::exp(-x * x / 2) / std::sqrt(2 * 3.14159265358979);
}

struct ClippedSignal {
  double mean_e = 0, variance_e2 = 0;
};

/// Closed form: the mean and the temporal variance of min(X, full) with X normal about its own variance, over
/// pixels whose gains are normal about 1.
ClippedSignal clipped_signal(double light_e, double full_e, double prnu) {
  ClippedSignal sum;
  double weights = 0;
  for (double deviate = -5; deviate <= 5; deviate += 0.125) {
    const double mean = light_e * (1 + prnu * deviate), deviation = std::sqrt(mean);
    const double room = (full_e - mean) / deviation, below = std::erfc(-room / std::sqrt(2.0)) / 2;
    const double first = mean * below - deviation * standard_normal(room) + full_e * (1 - below);
    const double second = (mean * mean + mean) * below - deviation * (mean + full_e) * standard_normal(room) +
                          full_e * full_e * (1 - below);
    const double weight = standard_normal(deviate);
    sum.mean_e += weight * first;
    sum.variance_e2 += weight * (second - first * first);
    weights += weight;
  }
  return {sum.mean_e / weights, sum.variance_e2 / weights};
}

/// Signals at which the variance is within `share` of its greatest: where a noisy curve may have its top.
std::pair<double, double> top_of_variance(double full_e, double prnu, double share) {
  std::vector<ClippedSignal> curve;
  for (double light = 0.85; light < 1.1; light += 5e-4)
    curve.push_back(clipped_signal(light * full_e, full_e, prnu));
  double greatest = 0;
  for (const ClippedSignal& point : curve) greatest = std::max(greatest, point.variance_e2);
  std::pair<double, double> range{full_e, 0};
  for (const ClippedSignal& point : curve)
    if (point.variance_e2 >= (1 - share) * greatest)
      range = {std::min(range.first, point.mean_e), std::max(range.second, point.mean_e)};
  return range;
}

TEST(PhotonTransfer, BundledSensorsMeasureAsTheyAreDescribed) {
  for (const char* name : {"example-vga", "full-frame-24mp", "icx625-mono", "imx363", "quad-bayer-1280x960",
                           "raspberry-pi-hq", "rccb-1280x960", "rgbw-1280x960", "third-inch-1280x960"}) {
    SCOPED_TRACE(name);
    const Sensor sensor = read_sensor(name);
    const GainMode& mode = sensor.electronics->gain_modes[0];
    constexpr int side = 160;
    const PhotonTransfer transfer = test_sensor(sensor, {}, 0, side, 24, 8).transfer;
    const std::vector<int>& cells = sensor.electronics->mosaic.cells;
    const double pixels = side * side * static_cast<double>(std::count(cells.begin(), cells.end(), 0)) /
                          static_cast<double>(cells.size());
    const double variance_error = std::sqrt(2 / pixels);
    // The slope through a dozen levels, the upper ones counting most: as well known as by five of them.
    const double gain_error = 4 * variance_error / std::sqrt(5.0);
    EXPECT_NEAR(transfer.dn_per_e / mode.dn_per_e, 1, gain_error);
    const double dark_e = std::hypot(mode.read_noise_e, mode.adc_noise_dn / mode.dn_per_e);
    const double variance_dn2 = std::pow(dark_e * mode.dn_per_e, 2) + 1.0 / 12;
    constexpr double least_told = 0.24;  // EMVA 1288, section 6.6
    EXPECT_EQ(transfer.quantisation_limited, variance_dn2 < least_told);
    if (transfer.quantisation_limited)
      EXPECT_GT(transfer.dark_noise_e, dark_e);
    else
      EXPECT_NEAR(transfer.dark_noise_e / dark_e, 1, 4 * variance_error + gain_error);

    const double full_e = sensor.electronics->saturation_e(mode, 1);
    ASSERT_TRUE(transfer.full_signal_e);
    EXPECT_NEAR(*transfer.full_signal_e / full_e, 1, gain_error);
    // Four pairs a level; the difference of two levels has √2 of their error.
    const auto [least, most] = top_of_variance(full_e, sensor.electronics->prnu,
                                               4 * std::sqrt(2.0) * variance_error / std::sqrt(4.0));
    EXPECT_GT(transfer.saturation_e, least * (1 - gain_error));
    EXPECT_LT(transfer.saturation_e, most * (1 + gain_error));
  }
}

TEST(PhotonTransfer, SaysWhatStepsHide) {
  Sensor sensor = sensor_under_test();
  SensorElectronics& electronics = *sensor.electronics;
  electronics.gain_modes = {{"base", 20000, 0.05, 2, 0, 8}};  // 0.1 DN of noise, 0.05 DN of pattern
  electronics.dsnu_e = 1;
  const SensorTest test = test_sensor(sensor, {}, 0, 128, 12, 8);
  EXPECT_TRUE(test.transfer.quantisation_limited);
  EXPECT_TRUE(test.uniformity.dsnu_quantisation_limited);
  EXPECT_NEAR(test.transfer.dark_noise_e, std::sqrt(0.24 - 1.0 / 12) / 0.05, 0.1);
  EXPECT_GT(test.uniformity.dsnu_e, 1);
}

TEST(PhotonTransfer, CountsStoredStepsOfANonlinearConverter) {
  Sensor sensor = sensor_under_test();
  sensor.electronics->linearity_fractions = {0, 0.5, 1};
  sensor.electronics->linearity_deviations = {0, -0.01, -0.03};
  const SensorTest test = test_sensor(sensor, {}, 0, 256, 24, 8);
  EXPECT_NEAR(test.transfer.dn_per_e, 0.2, 0.2 * 0.01) << "as RecoversTheSensor";
  EXPECT_NEAR(*test.transfer.full_signal_e, 20000, 20000 * 0.01);
}

TEST(TransferPoint, RefusesWhatIsNoPair) {
  const Sensor sensor = sensor_under_test();
  const RawImage a = capture({2, 2, 0, 0, {1, 1, 1, 1}}, sensor, 1, {}),
                 b = capture({1, 2, 0, 0, {1, 1}}, sensor, 1, {});
  EXPECT_THROW(transfer_point(a, b, 0), InputError);
  EXPECT_THROW(transfer_point(a, a, 1), InputError);
  EXPECT_THROW(photon_transfer({{0, 60, 1}}), InputError);
  EXPECT_THROW(photon_transfer({{0, 60, 1}, {1, 60, 1}, {1, 60, 1}}), InputError);
}

}  // namespace
}  // namespace petzval
