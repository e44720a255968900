// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/colour/cielab.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/colour/spectra_files.h>
#include <petzval/sensor/colour_calibration.h>

#include <cmath>
#include <numeric>
#include <optional>

#include "flat_sensor.h"

namespace petzval {
namespace {

/// A sensor that sees as the eye does: its channels are the colour-matching functions (per photon).
Sensor luther_sensor() {
  Sensor sensor = test::bayer_sensor(4, 4);
  const Observer& eye = Observer::cie_1931();
  std::vector<double> nm;
  for (double at = 380; at <= 730; at += 5) nm.push_back(at);
  std::vector<double> x, y, z;
  const std::vector<Xyz> weights = eye.weights(nm);
  for (std::size_t i = 0; i < nm.size(); ++i) {
    // What 5 nm weigh, per photon: energy per photon goes as 1/λ.
    x.push_back(weights[i].x / 5 * 200 / nm[i]), y.push_back(weights[i].y / 5 * 200 / nm[i]);
    z.push_back(weights[i].z / 5 * 200 / nm[i]);
  }
  sensor.electronics->channels = {
      {"red", Spectrum(nm, x)}, {"green", Spectrum(nm, y)}, {"blue", Spectrum(nm, z)}};
  return sensor;
}

TEST(ColourFit, IsExactForASensorThatSeesAsTheEyeDoes) {
  // Luther's condition. What is left comes of the two piecewise linear forms of the functions: under 0.1.
  const ColourFit fit = fit_colour(luther_sensor(), illuminant("D65"));
  EXPECT_LT(fit.max_delta_e_2000, 0.1);
}

// The more noise counts, the less of it the matrix makes: a law of minima of weighted sums.
TEST(ColourFit, NoiseIsTradedForColour) {
  for (const char* name : {"full-frame-24mp", "rccb-1280x960", "rgbw-1280x960"}) {
    const Sensor sensor = read_sensor(name);
    double noise = 1e9;
    for (const std::optional<double> white_e :
         {std::optional<double>(), std::optional(1e4), std::optional(1e3)}) {
      const ColourFit fit = fit_colour(sensor, illuminant("D65"), white_e);
      EXPECT_LT(fit.noise_delta_e_ab, noise) << name;
      noise = fit.noise_delta_e_ab;
    }
  }
}

/// The patches under a light, white at Y = 1, and white behind them.
std::vector<Xyz> patches_seen_by_the_eye(const Spectrum& light) {
  const Observer& eye = Observer::cie_1931();
  const double y = eye.xyz(light).y;
  std::vector<Xyz> seen;
  for (const NamedSpectrum& patch : read_spectrum_set("colorchecker_reflectance").spectra) {
    std::vector<double> values;
    for (const double nm : light.wavelengths_nm())
      values.push_back(light.at(nm) * patch.spectrum.at_extended(nm));
    seen.push_back((1 / y) * eye.xyz(Spectrum(light.wavelengths_nm(), values)));
  }
  seen.push_back((1 / y) * eye.xyz(light));
  return seen;
}

double response_to(const ColourFit& fit, std::size_t channel, const Xyz& colour) {
  const double* row = fit.camera_from_xyz.data() + 3 * channel;
  return row[0] * colour.x + row[1] * colour.y + row[2] * colour.z;
}

// By shaking one channel of one patch at a time a little, and asking for ΔE*ab.
TEST(ColourFit, NoiseIsThatOfAColourThatIsShaken) {
  const Sensor sensor = luther_sensor();
  const ColourFit fit = fit_colour(sensor, illuminant("D65"));
  std::vector<Xyz> seen = patches_seen_by_the_eye(illuminant("D65"));
  const Xyz white = seen.back();
  seen.pop_back();
  double sum = 0;
  for (const Xyz& patch : seen)
    for (std::size_t c = 0; c < 3; ++c) {
      const double deviation = std::sqrt(response_to(fit, c, patch) / noisy_white_e), step = 1e-4;
      const Xyz moved{patch.x + step * deviation * fit.xyz_from_camera[c],
                      patch.y + step * deviation * fit.xyz_from_camera[3 + c],
                      patch.z + step * deviation * fit.xyz_from_camera[6 + c]};
      sum += std::pow(delta_e_ab(cielab(moved, white), cielab(patch, white)) / step, 2);
    }
  // The two ways of integrating the patches differ by 0.1 of ΔE.
  EXPECT_NEAR(fit.noise_delta_e_ab / std::sqrt(sum / 24), 1, 0.01);
}

TEST(ColourFit, KeepsWhite) {
  for (const char* name : {"A", "D50", "D65", "F11"}) {
    const Spectrum light = illuminant(name);
    const ColourFit fit = fit_colour(read_sensor("full-frame-24mp"), light);
    const Xyz white = Observer::cie_1931().xyz(light);
    const double expected[] = {white.x / white.y, 1, white.z / white.y};
    for (std::size_t r = 0; r < 3; ++r) {
      double sum = 0;
      for (std::size_t c = 0; c < 3; ++c) sum += fit.xyz_from_camera[3 * r + c] * fit.neutral[c];
      EXPECT_NEAR(sum, expected[r], 1e-9) << name;
    }
  }
}

TEST(ColourFit, BundledSensorsSeeColourChecker) {
  for (const std::string& name : bundled_names("sensors", ".json")) {
    const Sensor sensor = read_sensor(name);
    if (!sensor.electronics || sensor.electronics->channels.size() < 3) continue;
    for (const char* light : {"D65", "D50", "A"}) {
      const ColourFit fit = fit_colour(sensor, illuminant(light));
      EXPECT_LT(fit.mean_delta_e_2000, 3) << name << " under " << light;
      EXPECT_GT(fit.max_delta_e_2000, fit.mean_delta_e_2000);
    }
  }
}

TEST(Calibration, TakesBalancedWhiteToD50) {
  for (const ColourCalibration& calibration : standard_calibrations(read_sensor("full-frame-24mp"))) {
    const double d50[] = {0.9642, 1, 0.8251};  // ICC.1: the connection space's white, to four decimals
    for (std::size_t r = 0; r < 3; ++r) {
      const auto row = calibration.pcs_from_balanced.begin() + static_cast<std::ptrdiff_t>(3 * r);
      EXPECT_NEAR(std::accumulate(row, row + 3, 0.0), d50[r], 3e-4);
    }
  }
}

TEST(Calibration, NeedsThreeChannels) {
  EXPECT_TRUE(standard_calibrations(test::mono_sensor(4, 4)).empty());
  EXPECT_THROW(fit_colour(test::mono_sensor(4, 4), illuminant("D65")), InputError);
}

}  // namespace
}  // namespace petzval
