// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/numeric/lattice_spline.h>

#include <cmath>
#include <functional>

namespace petzval {
namespace {

LatticeSpline spline_of(const std::vector<double>& x, const std::vector<double>& y,
                        const std::function<double(double, double)>& f) {
  std::vector<double> values;
  for (const double at_y : y)
    for (const double at_x : x) values.push_back(f(at_x, at_y));
  return {x, y, values};
}

TEST(LatticeSpline, MeetsBicubicsEverywhere) {
  // A spline without knots where four points end is the cubic through them.
  const auto f = [](double x, double y) {
    return (1 + x - 2 * x * x * x) * (3 - y + y * y + 0.5 * y * y * y);
  };
  const LatticeSpline spline = spline_of({-1, -0.3, 0.2, 0.9, 1.4}, {-2, -1, 0.5, 1, 2.5}, f);
  constexpr double h = 1e-6;
  for (const double x : {-1.0, -0.7, 0.0, 0.21, 1.3})
    for (const double y : {-1.9, -0.4, 0.7, 2.5}) {
      const LatticeSpline::Tangent at = spline.at(x, y);
      EXPECT_NEAR(at.value, f(x, y), 1e-12) << x << " " << y;
      EXPECT_NEAR(at.along_x, (f(x + h, y) - f(x - h, y)) / (2 * h), 1e-7);
      EXPECT_NEAR(at.along_y, (f(x, y + h) - f(x, y - h)) / (2 * h), 1e-7);
    }
}

TEST(LatticeSpline, HasTwoContinuousDerivatives) {
  const auto f = [](double x, double y) { return std::sin(3 * x) * std::cos(2 * y); };
  const std::vector<double> knots{-1, -0.6, -0.1, 0.3, 0.7, 1};
  const LatticeSpline spline = spline_of(knots, knots, f);
  constexpr double h = 1e-4;
  for (const double knot : {-0.1, 0.3}) {
    const auto bend = [&](double at) {
      return (spline(at + h, 0.2) - 2 * spline(at, 0.2) + spline(at - h, 0.2)) / (h * h);
    };
    // Third derivatives of 27 jump: h times that.
    EXPECT_NEAR(bend(knot - 2 * h), bend(knot + 2 * h), 0.05);
  }
}

TEST(LatticeSpline, ErrsWithTheFourthPowerOfTheSpacing) {
  const auto f = [](double x, double y) { return std::exp(x + 0.5 * y); };
  const auto worst = [&](int count) {
    std::vector<double> knots;
    for (int i = 0; i < count; ++i) knots.push_back(-1 + 2.0 * i / (count - 1));
    const LatticeSpline spline = spline_of(knots, knots, f);
    double error = 0;
    for (double x = -1; x <= 1; x += 0.013)
      for (double y = -1; y <= 1; y += 0.017) error = std::max(error, std::abs(spline(x, y) - f(x, y)));
    return error;
  };
  // 16 by the order; 12 leaves room for the ends.
  EXPECT_GT(worst(9) / worst(17), 12);
}

TEST(LatticeSpline, RowsAreTheSurface) {
  const auto f = [](double x, double y) { return x * x * y + std::sin(x - y); };
  const std::vector<double> x{0, 1, 1.5, 2.5, 3}, y{-1, 0, 1, 2};
  LatticeSpline spline = spline_of(x, y, f);
  spline.flatten(1, 2);
  std::vector<CubicStretch> values, along_y;
  for (const double at_y : {-1.3, -0.5, 1.2, 2.4}) {
    spline.row(at_y, values, along_y);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double at_x = 0.3 * x[i] + 0.7 * x[i + 1];
      EXPECT_NEAR(values[i](at_x), spline(at_x, at_y), 1e-12);
      EXPECT_NEAR(along_y[i](at_x), spline.at(at_x, at_y).along_y, 1e-12);
      EXPECT_NEAR(values[i].derivative(at_x), spline.at(at_x, at_y).along_x,
                  at_y < -1 || at_y > 2 ? 3 : 1e-12);
    }
  }
  EXPECT_NEAR(spline(1.25, 1.5), (f(1, 1) + f(1.5, 1) + f(1, 2) + f(1.5, 2)) / 4, 1e-12) << "the flat patch";
}

TEST(LatticeSpline, RefusesWhatIsNoLattice) {
  EXPECT_THROW(LatticeSpline({0}, {0, 1}, {1, 2}), InputError);
  EXPECT_THROW(LatticeSpline({0, 0}, {0, 1}, {1, 2, 3, 4}), InputError);
  EXPECT_THROW(LatticeSpline({0, 1}, {0, 1}, {1, 2, 3}), InputError);
}

}  // namespace
}  // namespace petzval
