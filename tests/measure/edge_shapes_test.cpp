// SPDX-License-Identifier: BSD-3-Clause
// Shapes of edges against straight integrals over their MTFs.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_shapes.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace petzval {
namespace {

double sinc(double x) {
  return x == 0 ? 1 : std::sin(pi * x) / (pi * x);
}
double circular_mtf(double nu) {
  return nu < 1 ? 2 / pi * (std::acos(nu) - nu * std::sqrt(1 - nu * nu)) : 0;
}

/// ½ + ∫ M sin(2πfd)/(πf) df, by midpoints.
double edge_of(const std::function<double(double)>& mtf, double d) {
  constexpr double step = 2e-4, highest = 8;
  double sum = 0.5;
  for (double f = 0.5 * step; f < highest; f += step)
    sum += mtf(f) * std::sin(2 * pi * f * d) / (pi * f) * step;
  return sum;
}

/// A frequency at which a falling MTF is a half.
double mtf50(const std::function<double(double)>& mtf) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) (mtf(0.5 * (low + high)) > 0.5 ? low : high) = 0.5 * (low + high);
  return low;
}

TEST(EdgeShapes, AreThoseOfTheirMtfs) {
  for (const double angle_deg : {0.0, 12.0, 45.0, 100.0}) {
    const double angle = angle_deg * pi / 180;
    const auto photosite = [=](double f) { return sinc(f * std::cos(angle)) * sinc(f * std::sin(angle)); };
    for (const double sigma : {0.35, 0.8, 2.5}) {
      const auto gauss = [&](double wider) {
        return [=](double f) { return std::exp(-2 * std::pow(pi * f * sigma * wider, 2)) * photosite(f); };
      };
      const double half = mtf50(gauss(1));
      // The circular pupil with the same.
      double low = 0.01, high = 20;
      for (int i = 0; i < 60; ++i) {
        const double cutoff = 0.5 * (low + high);
        (circular_mtf(half / cutoff) * photosite(half) < 0.5 ? low : high) = cutoff;
      }
      const auto circular = [&](double wider) {
        return [=](double f) { return circular_mtf(f * wider / low) * photosite(f); };
      };
      const EdgeShapes shapes(half, angle);
      for (const double d : {-7.0, -1.3, -0.2, 0.0, 0.6, 2.0, 11.0}) {
        const auto found = shapes(d);
        const double g = edge_of(gauss(1), d), c = edge_of(circular(1), d);
        EXPECT_NEAR(found[0], 0.5 * (g + c), 2e-5) << angle_deg << ' ' << sigma << ' ' << d;
        EXPECT_NEAR(found[2], g - c, 4e-5) << angle_deg << ' ' << sigma << ' ' << d;
        const double wider = 0.5 * (edge_of(gauss(1.01), d) + edge_of(circular(1.01), d)),
                     narrower = 0.5 * (edge_of(gauss(0.99), d) + edge_of(circular(0.99), d));
        EXPECT_NEAR(found[1], (wider - narrower) / 0.02, 2e-4) << angle_deg << ' ' << sigma << ' ' << d;
      }
    }
  }
}

TEST(EdgeShapes, NeedAnEdgeLessSharpThanAPhotosite) {
  EXPECT_TRUE(EdgeShapes::possible(0.5, 0));
  EXPECT_FALSE(EdgeShapes::possible(0.6, 0)) << "sinc 0.6 is 0.505";
  EXPECT_FALSE(EdgeShapes::possible(0, 0));
  EXPECT_THROW(EdgeShapes(0.62, 0), InputError);
}

}  // namespace
}  // namespace petzval
