// SPDX-License-Identifier: BSD-3-Clause
// Reflectances made from colours: they have the colour, and never leave [0, 1].
#include <gtest/gtest.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/colour/rgb_to_spectrum.h>

#include <cmath>

namespace petzval {
namespace {

/// The colour of a reflectance under D65, by a sum over 1 nm, as fine as the observer's own table.
LinearRgb colour_of(const SigmoidReflectance& reflectance) {
  std::vector<double> nm, light, white;
  const Spectrum d65 = illuminant("D65");
  for (double at = 380; at <= 730; at += 1) {
    nm.push_back(at);
    white.push_back(d65.at(at));
    light.push_back(d65.at(at) * reflectance.at(at));
  }
  const Xyz full = Observer::cie_1931().xyz(Spectrum(nm, white)),
            xyz = Observer::cie_1931().xyz(Spectrum(nm, light));
  const Xyz display = display_white();
  return linear_srgb({xyz.x / full.x * display.x, xyz.y / full.y * display.y, xyz.z / full.z * display.z});
}

double distance(LinearRgb a, LinearRgb b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

TEST(RgbToSpectrum, HasTheColourAndStaysWithinBounds) {
  double worst = 0;
  for (double r = 0.05; r < 1; r += 0.3)
    for (double g = 0.05; g < 1; g += 0.3)
      for (double b = 0.05; b < 1; b += 0.3) {
        const SigmoidReflectance reflectance = reflectance_of({r, g, b});
        worst = std::max(worst, distance(colour_of(reflectance), {r, g, b}));
        for (double nm = 300; nm <= 900; nm += 5) {
          EXPECT_GE(reflectance.at(nm), 0);
          EXPECT_LE(reflectance.at(nm), 1);
        }
      }
  // The fit sums over 10 nm, the check over 1 nm.
  EXPECT_LT(worst, 2e-3);
}

TEST(RgbToSpectrum, GreyIsConstant) {
  for (const double grey : {0.0, 0.18, 0.5, 1.0}) {
    const SigmoidReflectance reflectance = reflectance_of({grey, grey, grey});
    for (double nm = 350; nm <= 800; nm += 50) EXPECT_NEAR(reflectance.at(nm), grey, 1e-12);
  }
  EXPECT_NEAR(reflectance_of({2, 2, 2}).at(550), 1, 1e-12);
  EXPECT_NEAR(reflectance_of({-1, NAN, -3}).at(550), 0, 1e-12);
}

TEST(RgbToSpectrum, TableIsNearTheFit) {
  const ReflectanceTable table;
  double worst = 0;
  for (double r = 0.03; r < 1; r += 0.16)
    for (double g = 0.03; g < 1; g += 0.16)
      for (double b = 0.03; b < 1; b += 0.16)
        worst = std::max(worst, distance(colour_of(table({r, g, b})), {r, g, b}));
  // Half a step of an 8-bit picture is 0.002 at white.
  EXPECT_LT(worst, 6e-3);
}

}  // namespace
}  // namespace petzval
