// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/colour/spectrum.h>

#include <cmath>
#include <limits>

namespace petzval {
namespace {

const Spectrum triangle({400, 500, 600}, {0, 2, 0});

TEST(Spectrum, IsLinearBetweenSamplesAndZeroOutside) {
  EXPECT_DOUBLE_EQ(triangle.at(500), 2);
  EXPECT_DOUBLE_EQ(triangle.at(425), 0.5);
  EXPECT_DOUBLE_EQ(Spectrum({400, 500}, {3, 5}).at(500), 5);
  EXPECT_EQ(Spectrum({400, 500}, {3, 5}).at(399.999), 0);
  EXPECT_EQ(Spectrum({400, 500}, {3, 5}).at(500.001), 0);
  EXPECT_EQ(Spectrum().at(500), 0);
  EXPECT_EQ(triangle.at(std::nan("")), 0);
}

TEST(Spectrum, CarriesItsEndsOnWhenExtended) {
  const Spectrum reflectance({400, 500}, {0.3, 0.5});
  EXPECT_DOUBLE_EQ(reflectance.at_extended(300), 0.3);
  EXPECT_DOUBLE_EQ(reflectance.at_extended(900), 0.5);
  EXPECT_DOUBLE_EQ(reflectance.at_extended(450), 0.4);
}

TEST(Spectrum, IntegralIsTheAreaUnderTheCurve) {
  EXPECT_DOUBLE_EQ(triangle.integral(0, 1000), 200);   // ½ · base 200 · height 2
  EXPECT_DOUBLE_EQ(triangle.integral(400, 450), 25);   // ½ · 50 · 1
  EXPECT_DOUBLE_EQ(triangle.integral(450, 550), 150);  // the rest but two such corners
  EXPECT_DOUBLE_EQ(triangle.integral(450, 400), -25);
  EXPECT_DOUBLE_EQ(triangle.integral(700, 800), 0);
  EXPECT_DOUBLE_EQ(triangle.scaled(3).integral(0, 1000), 600);
}

TEST(Spectrum, RefusesWhatIsNoSpectrum) {
  EXPECT_THROW(Spectrum({}, {}), InputError);
  EXPECT_THROW(Spectrum({400}, {1, 2}), InputError);
  EXPECT_THROW(Spectrum({500, 400}, {1, 2}), InputError);
  EXPECT_THROW(Spectrum({400, 400}, {1, 2}), InputError);
  EXPECT_THROW(Spectrum({0, 400}, {1, 2}), InputError);
  EXPECT_THROW(Spectrum({400, std::numeric_limits<double>::infinity()}, {1, 2}), InputError);
  EXPECT_THROW(Spectrum({400, 500}, {1, std::nan("")}), InputError);
}

TEST(BandWidths, AreThoseOfTheTrapezoidRule) {
  EXPECT_EQ(band_widths_nm(std::vector<double>{400, 410, 430}), (std::vector<double>{5, 15, 10}));
  EXPECT_EQ(band_widths_nm(std::vector<double>{555}), std::vector<double>{1});
  EXPECT_TRUE(band_widths_nm(std::vector<double>{}).empty());
}

}  // namespace
}  // namespace petzval
