// SPDX-License-Identifier: BSD-3-Clause
// What each band has of a light, against integrals of the light.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/colour/band_light.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace petzval {
namespace {

double total(const std::vector<double>& light, const std::vector<double>& bands_nm) {
  const std::vector<double> widths = band_widths_nm(bands_nm);
  return std::inner_product(light.begin(), light.end(), widths.begin(), 0.0);
}

std::vector<double> range(double from, double step, double to) {
  std::vector<double> nm;
  for (double at = from; at <= to + 1e-9; at += step) nm.push_back(at);
  return nm;
}

/// Of a Gaussian: its maximum times its width at half maximum times √(π/ln 16).
const double led_total = 30 * std::sqrt(std::numbers::pi / std::log(16.0));

TEST(BandLight, ALineFallsIntoTheBandsWholly) {
  for (const auto& bands : {std::vector<double>{850},
                            {845},
                            {800, 850, 900},
                            {843, 851},
                            {852, 870, 900},
                            range(840, 10, 860),
                            range(400, 7, 1000)})
    EXPECT_NEAR(total(band_light(illuminant("850nm"), bands), bands), 1, 1e-6) << bands.size();
  // Between two bands, as a straight line shares it.
  const std::vector<double> shares = band_light(illuminant("842nm"), std::vector<double>{840, 850});
  EXPECT_NEAR(shares[1] / (shares[0] + shares[1]), 0.2, 1e-6);
}

TEST(BandLight, AnLedFallsIntoTheBandsThatAreMeantForItWholly) {
  for (const auto& bands : {std::vector<double>{850}, range(840, 10, 860), range(700, 5, 1000)})
    EXPECT_NEAR(total(band_light(illuminant("LED-850"), bands), bands) / led_total, 1, 2e-3) << bands.size();
  EXPECT_EQ(band_light(illuminant("LED-850"), std::vector<double>{550})[0], 0) << "another colour";
}

TEST(BandLight, BroadLightIsSharedOutBetweenTheFirstAndTheLastBand) {
  for (const char* name : {"D65", "A", "F11", "LED-B3", "E", "3200K"}) {
    const Spectrum light = illuminant(name);
    for (const auto& bands : {range(400, 10, 700), range(400, 50, 700), std::vector<double>{450, 550, 650}})
      EXPECT_NEAR(total(band_light(light, bands), bands) / light.integral(bands.front(), bands.back()), 1,
                  1e-6)
          << name << ' ' << bands.size();
    EXPECT_EQ(band_light(light, std::vector<double>{550})[0], light.at(550)) << "1 nm of it";
    EXPECT_FALSE(is_narrow(light)) << name;
  }
}

TEST(BandLight, AtItsOwnSamplesIsTheLight) {
  const Spectrum light({450, 500, 520, 600}, {1, 7, 2, 5});
  EXPECT_EQ(band_light(light, light.wavelengths_nm()), light.values());
}

TEST(BandLight, OfAWidthIsTheIntegralOverIt) {
  const Spectrum light = illuminant("A");
  const std::vector<double> bands{500, 560};
  EXPECT_NEAR(total(band_light(light, bands, 20), bands), light.integral(490, 510) + light.integral(550, 570),
              1e-9);
  EXPECT_NEAR(band_light(light, std::vector<double>{560}, 20)[0], light.integral(550, 570), 1e-9);
  EXPECT_THROW(band_light(light, bands, 0), InputError);
}

TEST(Illuminants, SingleColoursAndLedsByName) {
  EXPECT_NEAR(illuminant("632.8nm").integral(600, 700), 1, 1e-9);
  EXPECT_NEAR(illuminant("940nm/40").at(920), 0.5, 1e-3) << "half the maximum at half the width";
  // CIE 015:2018: chromaticities of LED-B1 and LED-B5, 2 degrees; the spectra here are every 5 nm.
  for (const auto& [name, x, y] : {std::tuple{"LED-B1", 0.4560, 0.4078}, {"LED-B5", 0.3118, 0.3236}}) {
    const Chromaticity c = chromaticity(Observer::cie_1931().xyz(illuminant(name)));
    EXPECT_NEAR(c.x, x, 5e-4) << name;
    EXPECT_NEAR(c.y, y, 5e-4) << name;
  }
  EXPECT_THROW(illuminant("850nm/0"), InputError);
  EXPECT_THROW(illuminant("0.85nm"), InputError);
  EXPECT_GT(illuminant("3200K").at(1500), 0);
}

}  // namespace
}  // namespace petzval
