// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>

#include <cmath>

namespace petzval {
namespace {

// The tables have the 5 or 10 nm spacing and the 370..730 nm range that they have; CIE's chromaticities come
// from 1 nm tables to 830 nm. The difference is below 1e-3 for the smooth illuminants. F11 is a line
// spectrum, every 10 nm only.
constexpr double smooth_tolerance = 1e-3, line_tolerance = 3e-3;

struct KnownWhite {
  const char* name;
  double x, y, tolerance;
};

class Whites : public testing::TestWithParam<KnownWhite> {};

TEST_P(Whites, HaveTheChromaticityOfCie15) {
  const auto [name, x, y, tolerance] = GetParam();
  const Chromaticity white = chromaticity(Observer::cie_1931().xyz(illuminant(name)));
  EXPECT_NEAR(white.x, x, tolerance);
  EXPECT_NEAR(white.y, y, tolerance);
}

INSTANTIATE_TEST_SUITE_P(Observer, Whites,
                         testing::Values(KnownWhite{"D65", 0.3127, 0.3290, smooth_tolerance},
                                         KnownWhite{"D50", 0.3457, 0.3585, smooth_tolerance},
                                         KnownWhite{"A", 0.4476, 0.4074, smooth_tolerance},
                                         KnownWhite{"E", 1.0 / 3, 1.0 / 3, smooth_tolerance},
                                         KnownWhite{"D55", 0.3324, 0.3474, smooth_tolerance},
                                         KnownWhite{"D75", 0.2990, 0.3149, smooth_tolerance},
                                         KnownWhite{"F11", 0.3805, 0.3769, line_tolerance}),
                         [](const auto& info) { return std::string(info.param.name); });

/// By brute force: the piecewise linear spectrum times the observer on a very fine grid.
Xyz midpoint_sum(const Spectrum& spectrum, double step_nm) {
  Xyz sum;
  const auto steps = static_cast<int>(std::lround((spectrum.back_nm() - spectrum.front_nm()) / step_nm));
  for (int i = 0; i < steps; ++i) {
    const double nm = spectrum.front_nm() + (i + 0.5) * step_nm;
    sum = sum + (step_nm * spectrum.at(nm)) * Observer::cie_1931().weights(std::vector<double>{nm})[0];
  }
  return sum;
}

TEST(Observer, IntegratesAPiecewiseLinearSpectrumExactlyOnAnyGrid) {
  const Spectrum spectra[] = {Spectrum({450, 550, 650}, {1, 3, 2}),           // coarse
                              Spectrum({486.13, 587.56, 656.27}, {1, 3, 2}),  // off the nodes of the observer
                              Spectrum({500.2, 500.5, 500.9}, {4, 1, 2}),     // finer than the observer
                              Spectrum({200, 710.3, 2000}, {1, 2, 5})};       // wider than the observer
  for (const Spectrum& spectrum : spectra) {
    const Xyz got = Observer::cie_1931().xyz(spectrum), want = midpoint_sum(spectrum, 0.01);
    // The midpoint rule with 0.01 nm steps on this observer (second derivatives below 1e-2 /nm²) errs by less
    // than 1e-6 of the sum.
    EXPECT_NEAR(got.x, want.x, 1e-6 * want.y);
    EXPECT_NEAR(got.y, want.y, 1e-6 * want.y);
    EXPECT_NEAR(got.z, want.z, 1e-6 * want.y);
  }
}

TEST(Observer, TheWeightsOfAnyGridSumToTheIntegralOfTheObserver) {
  // ∫ȳ dλ = 106.857 nm over 360..830 nm (CIE 15, 5 nm table: 21.371 · 5).
  for (const double step : {1.0, 5.0, 10.0, 20.0}) {
    std::vector<double> grid;
    for (double nm = 360; nm <= 740; nm += step) grid.push_back(nm);
    double sum = 0;
    for (const Xyz& weight : Observer::cie_1931().weights(grid)) sum += weight.y;
    EXPECT_NEAR(sum, 106.857, 0.02) << step;
  }
}

TEST(Observer, ASingleSampleStandsForOneNanometre) {
  const std::vector<Xyz> weight = Observer::cie_1931().weights(std::vector<double>{555});
  ASSERT_EQ(weight.size(), 1u);
  EXPECT_NEAR(weight[0].y, 1.0, 1e-4);  // ȳ(555 nm) = 1.0000 by definition
  EXPECT_EQ(Observer::cie_1931().weights(std::vector<double>{1000})[0].y, 0);
  EXPECT_TRUE(Observer::cie_1931().weights(std::vector<double>{}).empty());
}

TEST(Luminance, OfOneWattAtTheTopOfTheCurveIs683Lumens) {
  // 1 W in a triangle 2 nm wide at 555 nm. ȳ is flat there to 1e-4.
  EXPECT_NEAR(luminance(Spectrum({554, 555, 556}, {0, 1, 0})), 683.0, 0.1);
}

TEST(Luminance, OfTheBlackBodyAtThePlatinumPointIsSixtyCandelasPerSquareCentimetre) {
  // The candela of 1948: a black body at freezing platinum (2041.4 K, IPTS-68 2042 K) has 60 cd/cm². The
  // redefinition of 1979 chose 683 lm/W to keep it to a few parts in a thousand; 0.1 % of temperature is 1 %
  // of luminance.
  std::vector<double> grid;
  for (double nm = 360; nm <= 780; nm += 1) grid.push_back(nm);
  EXPECT_NEAR(luminance(blackbody(2041.4, grid)), 60e4, 0.01 * 60e4);
}

TEST(Chromaticity, AndBackIsTheSameColourWithUnitY) {
  const Xyz white = xyz_of(Chromaticity{0.3127, 0.3290});
  EXPECT_DOUBLE_EQ(white.y, 1);
  const Chromaticity back = chromaticity(7 * white);
  EXPECT_NEAR(back.x, 0.3127, 1e-15);
  EXPECT_NEAR(back.y, 0.3290, 1e-15);
  EXPECT_EQ(chromaticity({0, 0, 0}).x, 0);
  EXPECT_THROW(xyz_of(Chromaticity{0.3, 0}), InputError);
}

}  // namespace
}  // namespace petzval
