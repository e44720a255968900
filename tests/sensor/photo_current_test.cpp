// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/sensor/exposure.h>
#include <petzval/sensor/photo_current.h>

#include <cmath>
#include <numbers>

#include "flat_sensor.h"

namespace petzval {
namespace {

constexpr double h_js = 6.62607015e-34, c_m_per_s = 299792458;

TEST(PhotoCurrent, OfAWallIsTheHandCalculation) {
  // A wall of radiance 0.02 W/(m² sr nm) from 400 to 700 nm through 0.2212 sr: E = 0.004424 W/(m² nm).
  // Electrons per second in (5 µm)² at an efficiency of 0.5: 0.5 A E / (h c) ∫ λ dλ = 0.5 A E / (h c) (700² −
  // 400²)/2 nm².
  const double e = 0.02 * 0.2212, area_m2 = 25e-12, nm = 1e-9;
  const double expected = 0.5 * area_m2 * e / (h_js * c_m_per_s) * (700.0 * 700 - 400 * 400) / 2 * nm;
  const PhotoCurrent current = photo_current(test::uniform_light(6, 4, e), test::mono_sensor(6, 4));
  for (const float rate : current.e_per_s) EXPECT_NEAR(static_cast<double>(rate) / expected, 1, 1e-6);
}

TEST(PhotoCurrent, WeightsIntegrateProductsExactly) {
  // Light and efficiency that are both linear: ∫ (a + bλ)(c + dλ) λ dλ has an antiderivative. 1e-12:
  // rounding.
  const Spectrum efficiency({400, 700}, {0.2, 0.8});
  const double nm[] = {400, 430, 520, 700};
  const auto weights = electron_weights(efficiency, nm, 2);
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += weights[i] * (1 + 0.01 * nm[i]);
  const auto antiderivative = [](double x) {
    const double a = 1, b = 0.01, c = 0.2 - 0.6 * 400 / 300, d = 0.6 / 300;
    return a * c * x * x / 2 + (a * d + b * c) * x * x * x / 3 + b * d * x * x * x * x / 4;
  };
  const double expected = 4e-12 * 1e-9 / (h_js * c_m_per_s) * (antiderivative(700) - antiderivative(400));
  EXPECT_NEAR(sum / expected, 1, 1e-10);
}

TEST(PhotoCurrent, ASingleBandStandsForOneNanometre) {
  const double nm[] = {550};
  const Spectrum efficiency({400, 700}, {0.5, 0.5});
  EXPECT_NEAR(electron_weights(efficiency, nm, 1)[0] / (0.5 * 1e-12 * 550e-9 / (h_js * c_m_per_s)), 1, 1e-12);
}

TEST(PhotoCurrent, PixelsAreNotBlurredAgain) {
  // A pattern that alternates from pixel to pixel keeps all of its contrast: sense has no aperture of its
  // own.
  SpectralImage image(8, 2, {500, 600}, 5);
  for (int band = 0; band < 2; ++band)
    for (int row = 0; row < 2; ++row)
      for (int column = 0; column < 8; ++column) image.at(band, row, column) = column % 2 ? 3.0f : 1.0f;
  const PhotoCurrent current = photo_current(image, test::mono_sensor(8, 2));
  for (std::size_t i = 0; i < 16; i += 2)
    EXPECT_NEAR(static_cast<double>(current.e_per_s[i + 1] / current.e_per_s[i]), 3, 1e-6);
}

TEST(PhotoCurrent, EachPixelSeesItsOwnChannel) {
  // Monochromatic light: the currents of two pixels are as the efficiencies of their channels.
  for (const std::string order : {"RGGB", "BGGR", "GRBG", "GBRG"}) {
    const Sensor sensor = test::bayer_sensor(6, 4, order);
    SpectralImage image(6, 4, {600}, 5);
    for (float& value : image.band(0)) value = 1;
    const PhotoCurrent current = photo_current(image, sensor);
    const double per_efficiency = 25e-12 * 600e-9 / (h_js * c_m_per_s);
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 6; ++column) {
        const char letter = order[static_cast<std::size_t>(row % 2 * 2 + column % 2)];
        const double efficiency = letter == 'R' ? 0.5 : letter == 'G' ? 0.6 - 0.55 * 0.6 : 0;
        EXPECT_NEAR(static_cast<double>(current.e_per_s[static_cast<std::size_t>(row * 6 + column)]),
                    efficiency * per_efficiency, 1e-6 * per_efficiency);
      }
  }
}

TEST(PhotoCurrent, SmallFramesKeepThePhaseOfTheMosaic) {
  const PhotoCurrent current = photo_current(test::uniform_light(6, 4, 1), test::bayer_sensor(100, 63));
  EXPECT_EQ(current.first_column, 46);  // (100 − 6)/2 = 47, down to an even one
  EXPECT_EQ(current.first_row, 28);
}

TEST(PhotoCurrent, CrosstalkHandsElectronsOn) {
  Sensor sensor = test::mono_sensor(5, 5);
  sensor.electronics->crosstalk = {{{0, 0.02, 0}, {0.01, 0.9, 0.04}, {0, 0.03, 0}}};
  SpectralImage image(5, 5, {500}, 5);
  image.at(0, 2, 2) = 1;
  const PhotoCurrent without = photo_current(image, sensor, {false, true, {}});
  const PhotoCurrent with = photo_current(image, sensor);
  const double all = static_cast<double>(without.e_per_s[12]);
  const auto share = [&](std::size_t i) { return static_cast<double>(with.e_per_s[i]) / all; };
  EXPECT_NEAR(share(12), 0.9, 1e-6);
  EXPECT_NEAR(share(7), 0.02, 1e-6);   // above
  EXPECT_NEAR(share(17), 0.03, 1e-6);  // below
  EXPECT_NEAR(share(11), 0.01, 1e-6);  // to the left
  EXPECT_NEAR(share(13), 0.04, 1e-6);
  double sum = 0;
  for (std::size_t i = 0; i < 25; ++i) sum += share(i);
  EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(PhotoCurrent, ColoursAreReckonedWithCrosstalkInThem) {
  Sensor sensor = test::bayer_sensor(20, 20, "GRBG");
  sensor.electronics->crosstalk = {{{0.01, 0.02, 0.005}, {0.03, 0.85, 0.04}, {0.002, 0.015, 0.008}}};
  // Away from the edges, where what is mirrored is not what the kernel would have met.
  const PhotoCurrent current = photo_current(test::uniform_light(20, 20, 1), sensor);
  const std::vector<double> expected = channel_currents(sensor, Spectrum({400, 500, 600, 700}, {1, 1, 1, 1}));
  std::vector<double> sums(3), counts(3);
  for (int row = 2; row < 18; ++row)
    for (int column = 2; column < 18; ++column) {
      const auto channel = static_cast<std::size_t>(sensor.electronics->mosaic.channel(row, column));
      sums[channel] += static_cast<double>(current.e_per_s[static_cast<std::size_t>(row * 20 + column)]);
      ++counts[channel];
    }
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(sums[i] / counts[i] / expected[i], 1, 1e-6) << i;
}

TEST(PhotoCurrent, MicrolensesLoseLightAtOtherAnglesThanTheirs) {
  Sensor sensor = test::mono_sensor(2000, 2);
  sensor.electronics->microlens = Microlens{{0, 10, 30}, {1, 0.9, 0.1}, {0, 10}, {0, 20}};
  const SpectralImage image = test::uniform_light(2000, 2, 1);
  EXPECT_THROW(photo_current(image, sensor), InputError) << "no exit pupil is known";
  const PhotoCurrent current = photo_current(image, sensor, {true, true, -8.0});
  // At x = 2.5 mm: chief ray atan(2.5/8) = 17.354°, the microlens is made for 5°: 12.354° off → 0.9 − 0.8
  // · 2.354/20.
  const double bare = static_cast<double>(photo_current(image, sensor, {true, false, {}}).e_per_s[1000]);
  const std::size_t there = 1500;  // its middle lies at 2.5025 mm
  const double angle = std::atan(2.5025 / 8) * 180 / std::numbers::pi - 2 * 2.5025;
  EXPECT_NEAR(static_cast<double>(current.e_per_s[there]) / bare, 0.9 - 0.8 * (angle - 10) / 20, 1e-5);
}

TEST(PhotoCurrent, LightForAnotherSensorIsRefused) {
  const Sensor sensor = test::mono_sensor(6, 4);
  EXPECT_THROW(photo_current(test::uniform_light(7, 4, 1), sensor), InputError) << "too wide";
  EXPECT_THROW(photo_current(SpectralImage(6, 4, {500}, 5.01), sensor), InputError) << "another pitch";
  EXPECT_THROW(photo_current(SpectralImage(6, 4, {500}, 5, PixelAperture::point), sensor), InputError);
  Sensor small_sites = sensor;
  small_sites.photosite.width = 0.7;
  EXPECT_THROW(photo_current(test::uniform_light(6, 4, 1), small_sites), InputError)
      << "a box, not its photosite";
  SpectralImage fitting(6, 4, {500}, 5, PixelAperture::photosite);
  fitting.photosite = small_sites.photosite.text();
  EXPECT_NO_THROW(photo_current(fitting, small_sites));
  EXPECT_THROW(photo_current(fitting, sensor), InputError);
  Sensor frame = sensor;
  frame.electronics.reset();
  EXPECT_THROW(photo_current(test::uniform_light(6, 4, 1), frame), InputError);
}

TEST(Exposure, FollowsItsRule) {
  PhotoCurrent current{10, 10, 0, 0, std::vector<float>(100, 50.0f)};
  current.e_per_s[3] = 1e6f;  // the one pixel of a hundred that may be brighter
  EXPECT_NEAR(metered_exposure_s(current, 1000, {}), 0.8 * 1000 / 50, 1e-9);
  EXPECT_NEAR(metered_exposure_s(current, 1000, {Metering::Rule::highlights, -1}), 0.4 * 1000 / 50, 1e-9);
  current.e_per_s[3] = 50;
  EXPECT_NEAR(metered_exposure_s(current, 1000, {Metering::Rule::average, 0}), 0.127 * 1000 / 50, 1e-9);
  current.e_per_s.assign(100, 0.0f);
  EXPECT_THROW(metered_exposure_s(current, 1000, {}), InputError);
  EXPECT_DOUBLE_EQ(exposure_of_ev_s(12, 8), 1.0 / 64);
}

TEST(Exposure, SaturationSpeedIsByItsDefinition) {
  // Green light of 555 nm, where one W/m² is 683 · ȳ(555) lx, ȳ = 1: the band stands for 1 nm.
  const Sensor sensor = test::mono_sensor(4, 4);
  const GainMode& mode = sensor.electronics->gain_modes[0];
  const Spectrum light({555}, {1});
  const double e_per_s = 0.5 * 25e-12 * 555e-9 / (h_js * c_m_per_s);
  // The 100,000 e of the full well come first, the 65,435 DN / 0.5 DN/e of the converter later.
  const double speed = saturation_speed(sensor, mode, 1, light);
  EXPECT_NEAR(speed, 78 / (100000 / e_per_s * 683), 1e-4 * speed);  // ȳ as tabulated: 1.0000
  EXPECT_NEAR(saturation_speed(sensor, mode, 2, light), 78 / (65435 / e_per_s * 683), 2e-4 * speed);
}

TEST(Exposure, NoiseSpeedsAreByTheirDefinition) {
  Sensor sensor = test::mono_sensor(4, 4);
  SensorElectronics& electronics = *sensor.electronics;
  GainMode& mode = electronics.gain_modes[0];
  const Spectrum light({555}, {1});
  const double lx_s_per_e = 683 / (0.5 * 25e-12 * 555e-9 / (h_js * c_m_per_s));
  electronics.dsnu_e = electronics.prnu = mode.adc_noise_dn = 0;
  // Shot noise, and quantisation in steps of 2 e: 1600 e give 40 but for 1/3 e² of variance.
  mode.read_noise_e = 0;
  EXPECT_NEAR(*noise_speed(sensor, mode, 1, light, 40) * lx_s_per_e, 10.0 / 1600, 10.0 / 1600 * 4e-4);
  // Whatever the noises are, the ratio at that exposure is what was asked for.
  mode.read_noise_e = 7, mode.adc_noise_dn = 1.5, electronics.dsnu_e = 2, electronics.prnu = 0.01;
  for (const double snr : {10.0, 40.0}) {
    const double e = 10 / (*noise_speed(sensor, mode, 1, light, snr) * lx_s_per_e);
    const double step_e = 1 / mode.dn_per_e;
    const double variance = e + 49 + (2.25 + 1.0 / 12) * step_e * step_e + 4 + 1e-4 * e * e;
    EXPECT_NEAR(e / std::sqrt(variance), snr, 1e-3 * snr);
  }
  electronics.prnu = 0.03;  // never better than 33
  EXPECT_FALSE(noise_speed(sensor, mode, 1, light, 40));
  EXPECT_TRUE(noise_speed(sensor, mode, 1, light, 10));
  mode.full_well_e = 50;
  EXPECT_FALSE(noise_speed(sensor, mode, 1, light, 10));
}

}  // namespace
}  // namespace petzval
