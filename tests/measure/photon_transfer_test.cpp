// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/measure/photon_transfer.h>

#include <cmath>

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
  // One level is a twentieth of the full well.
  EXPECT_NEAR(test.transfer.saturation_e, 20000, 1100);
  const double least = std::sqrt(16 + 2.25 + 25 / 12.0 + 0.25) + 0.5;
  EXPECT_NEAR(test.transfer.dynamic_range_db, 20 * std::log10(20000 / least), 0.6);
  EXPECT_NEAR(test.transfer.snr_max_db, 10 * std::log10(20000), 0.3);
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

TEST(PhotonTransfer, BundledSensorsMeasureAsTheyAreDescribed) {
  for (const char* name : {"raspberry-pi-hq", "icx625-mono"}) {
    const Sensor sensor = read_sensor(name);
    const GainMode& mode = sensor.electronics->gain_modes[0];
    const SensorTest test = test_sensor(sensor, {}, 0, 160, 24, 8);
    EXPECT_NEAR(test.transfer.dn_per_e / mode.dn_per_e, 1, 0.03) << name;
    EXPECT_NEAR(test.transfer.dark_noise_e, std::hypot(mode.read_noise_e, mode.adc_noise_dn / mode.dn_per_e),
                0.05 * mode.read_noise_e + 0.1)
        << name;
  }
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
