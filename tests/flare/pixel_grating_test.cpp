// SPDX-License-Identifier: BSD-3-Clause
// Shares of the orders of microlenses: against a sum over samples of the phase, and by what they add up to.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/pixel_grating.h>

#include <cmath>
#include <complex>

namespace petzval {
namespace {

TEST(PixelGrating, OrdersAreTheFourierCoefficientsOfThePhase) {
  const double pitch_um = 3, sag_um = 0.5, wavelength_um = 0.55;
  constexpr int samples = 400;
  for (const GratingOrder& order : pixel_grating_orders({0.1, pitch_um, sag_um}, 1000 * wavelength_um, 0.2)) {
    std::complex<double> sum = 0;
    for (int j = 0; j < samples; ++j)
      for (int i = 0; i < samples; ++i) {
        const double x = (i + 0.5) / samples - 0.5, y = (j + 0.5) / samples - 0.5;
        const double depth_um = sag_um * (x * x + y * y) / 0.5;  // the corner is at x² + y² = 1/2
        sum +=
            std::polar(1.0, -4 * pi * depth_um / wavelength_um - 2 * pi * (order.right * x + order.up * y));
      }
    EXPECT_NEAR(order.share, std::norm(sum / double(samples * samples)), 1e-4)
        << order.right << " " << order.up;
  }
}

// Shares sum to 1 (Parseval), and so does the mean square of the slope that light is turned by, which is
// that of twice the slope of the surface: 64 sag²/(12 pitch²) a side.
TEST(PixelGrating, KeepsLightAndItsSpreadOfDirections) {
  const double pitch_um = 100, sag_um = 6, wavelength_um = 0.5;
  double light = 0, square = 0;
  for (const GratingOrder& order : pixel_grating_orders({0.1, pitch_um, sag_um}, 1000 * wavelength_um, 0)) {
    light += order.share;
    square += order.share * std::pow(order.right * wavelength_um / pitch_um, 2);
  }
  EXPECT_NEAR(light, 1, 1e-3);
  EXPECT_NEAR(square / (64 * sag_um * sag_um / (12 * pitch_um * pitch_um)), 1, 0.02);
}

TEST(PixelGrating, WithoutMicrolensesIsAMirror) {
  const std::vector<GratingOrder> orders = pixel_grating_orders({0.1, 3, 0}, 550);
  ASSERT_EQ(orders.size(), 1U);
  EXPECT_EQ(orders[0], GratingOrder());
  EXPECT_EQ(orders[0].share, 1);
}

TEST(PixelGrating, RefusesWhatCannotBe) {
  EXPECT_THROW(SensorReflection(1.5).validate(), InputError);
  EXPECT_THROW(SensorReflection(0.1, 3, -1).validate(), InputError);
  EXPECT_THROW(SensorReflection(0.1, 0, 1).validate(), InputError);
}

}  // namespace
}  // namespace petzval
