// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/numeric/interpolation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace petzval {
namespace {

using Start = MonotoneCubic::Start;
using Beyond = MonotoneCubic::Beyond;

std::vector<double> grid(double from, double to, int count) {
  std::vector<double> x;
  for (int i = 0; i < count; ++i) x.push_back(from + (to - from) * i / (count - 1));
  return x;
}

template <typename Function>
std::vector<double> values_of(const Function& f, const std::vector<double>& x) {
  std::vector<double> y;
  for (const double at : x) y.push_back(f(at));
  return y;
}

template <typename Function, typename Curve>
double largest_error(const Function& f, const Curve& curve, double from, double to) {
  double error = 0;
  for (const double x : grid(from, to, 1001)) error = std::max(error, std::abs(curve(x) - f(x)));
  return error;
}

TEST(Bracket, FindsTheIntervalAndClampsAtTheEnds) {
  const std::vector<double> x{0, 1, 3, 7};
  EXPECT_EQ(bracket(x, -5), 0u);
  EXPECT_EQ(bracket(x, 0), 0u);
  EXPECT_EQ(bracket(x, 1), 1u);
  EXPECT_EQ(bracket(x, 2.999), 1u);
  EXPECT_EQ(bracket(x, 3), 2u);
  EXPECT_EQ(bracket(x, 7), 2u);
  EXPECT_EQ(bracket(x, 99), 2u);
}

TEST(MonotoneCubic, PassesThroughItsPoints) {
  const std::vector<double> x{0, 0.4, 1, 2.5, 2.6}, y{1, 1, 3, -2, 8};
  const MonotoneCubic curve(x, y);
  for (std::size_t i = 0; i < x.size(); ++i)
    EXPECT_NEAR(curve(x[i]), y[i], 1e-14);  // rounding of one Horner step
  EXPECT_EQ(curve.front(), 0);
  EXPECT_EQ(curve.back(), 2.6);
}

// A cubic has exact slopes from the five-point stencil, and a Hermite cubic with exact slopes is that cubic.
TEST(MonotoneCubic, ReproducesAMonotoneCubic) {
  const auto cubic = [](double x) { return 2 + 3 * x + 0.2 * x * x + 0.5 * x * x * x; };
  const std::vector<double> x{0, 0.3, 0.5, 1.1, 1.6, 2};
  EXPECT_LT(largest_error(cubic, MonotoneCubic(x, values_of(cubic, x)), 0, 2), 1e-13);
}

// Fourth order: halving the spacing must divide the error by 16 (13 allows for the next term of the series).
TEST(MonotoneCubic, IsOfFourthOrderOnASmoothMonotoneCurve) {
  const auto f = [](double x) { return std::sinh(x) + x; };
  double coarse = 0, fine = 0;
  for (const Start start : {Start::free, Start::odd}) {
    coarse = largest_error(f, MonotoneCubic(grid(0, 2, 11), values_of(f, grid(0, 2, 11)), start), 0, 2);
    fine = largest_error(f, MonotoneCubic(grid(0, 2, 21), values_of(f, grid(0, 2, 21)), start), 0, 2);
    EXPECT_GT(coarse / fine, 13);
    EXPECT_LT(fine, 1e-5);
  }
}

TEST(MonotoneCubic, EvenStartHasNoSlopeAndIsOfFourthOrder) {
  const auto cos4 = [](double x) { return std::pow(std::cos(x), 4); };
  const auto at = [&](int count) {
    return MonotoneCubic(grid(0, 0.7, count), values_of(cos4, grid(0, 0.7, count)), Start::even);
  };
  EXPECT_EQ(at(11).derivative(0), 0);
  const double coarse = largest_error(cos4, at(11), 0, 0.7), fine = largest_error(cos4, at(21), 0, 0.7);
  EXPECT_GT(coarse / fine, 13);
  EXPECT_LT(fine, 2e-6);
}

// The promise of the class, for data as wild as can be: between two points the curve stays between their
// values and never turns. 1e-12 of the jump is rounding.
TEST(MonotoneCubic, NeverOvershootsNorTurnsBetweenPoints) {
  std::mt19937 random(20260101);
  std::uniform_real_distribution<double> step(0.01, 1), value(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> x{0}, y{value(random)};
    for (int i = 1; i < 12; ++i) {
      x.push_back(x.back() + step(random) * (i % 3 == 0 ? 0.01 : 1));
      y.push_back(i % 4 == 0 ? y.back() : value(random));
    }
    const MonotoneCubic curve(x, y, static_cast<Start>(trial % 3));
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      double previous = y[i];
      for (int k = 1; k <= 50; ++k) {
        const double next = curve(x[i] + (x[i + 1] - x[i]) * k / 50.0);
        const double rise = y[i + 1] - y[i];
        EXPECT_GE((next - previous) * (rise < 0 ? -1 : 1), -1e-12 * std::max(1.0, std::abs(rise)));
        if (rise == 0) {
          EXPECT_NEAR(next, y[i], 1e-12);
        }
        previous = next;
      }
    }
  }
}

TEST(MonotoneCubic, DerivativeIsTheSlopeOfTheCurve) {
  const std::vector<double> x{0, 0.4, 1, 2.5, 2.6}, y{1, 1.2, 3, 2, 8};
  const MonotoneCubic curve(x, y, Start::free, Beyond::linear);
  const double step = 1e-6;
  for (const double at :
       {-1.0, 0.2, 0.7, 1.9, 2.55, 4.0})  // central difference: error about step² × third derivative
    EXPECT_NEAR(curve.derivative(at), (curve(at + step) - curve(at - step)) / (2 * step), 1e-5) << at;
}

TEST(MonotoneCubic, HoldsOrGoesOnOutside) {
  const std::vector<double> x{1, 2, 3, 4}, y{2, 4, 6, 8};
  const MonotoneCubic held(x, y), onward(x, y, Start::free, Beyond::linear);
  EXPECT_EQ(held(0), 2);
  EXPECT_EQ(held(10), 8);
  EXPECT_EQ(held.derivative(10), 0);
  EXPECT_NEAR(onward(0), 0, 1e-14);
  EXPECT_NEAR(onward(10), 20, 1e-13);
}

TEST(MonotoneCubic, InverseUndoesTheCurve) {
  const auto f = [](double x) { return std::atan(x) + 0.05 * x; };
  for (const double sign : {1.0, -1.0}) {
    const std::vector<double> x = grid(0, 3, 13);
    std::vector<double> y = values_of(f, x);
    for (double& value : y) value *= sign;
    const MonotoneCubic curve(x, y, Start::odd, Beyond::linear);
    for (const double at : grid(-1, 5, 601)) EXPECT_NEAR(curve.inverse(curve(at)), at, 2e-14) << at;
  }
  const MonotoneCubic held({0, 1, 2}, {0, 1, 5});
  EXPECT_EQ(held.inverse(-3), 0);
  EXPECT_EQ(held.inverse(9), 2);
}

// Points that rise by twice, then by half of what they did: the quartic through them falls at the last.
TEST(MonotoneCubic, RisesWhereItCarriesOn) {
  const std::vector<double> x{0, 1, 2, 3, 4, 5, 6};
  for (const std::vector<double>& y : {std::vector<double>{0, 1, 2, 3, 5, 7, 7.5},
                                       {0, 1, 1.5, 3.5, 4, 6, 6.5},
                                       {0, 2, 2.1, 2.2, 5, 5.1, 9}}) {
    const MonotoneCubic curve(x, y, Start::odd, Beyond::linear);
    for (const double at : grid(-1, 8, 901)) {
      EXPECT_GT(curve.derivative(at), 0.01) << at;
      EXPECT_NEAR(curve.inverse(curve(at)), at, 1e-12) << at;
    }
  }
}

TEST(MonotoneCubic, TakesFewPoints) {
  const MonotoneCubic one({3}, {7}), two({0, 2}, {1, 5}), even({0, 1}, {4, 3}, Start::even);
  EXPECT_EQ(one(-1), 7);
  EXPECT_EQ(one(99), 7);
  EXPECT_EQ(one.derivative(3), 0);
  EXPECT_EQ(one.inverse(0), 3);
  EXPECT_DOUBLE_EQ(two(0.5), 2);
  EXPECT_NEAR(even(0.5), 3.75, 1e-15);  // 4 − x²: the parabola through (−1, 3), (0, 4), (1, 3)
}

TEST(MonotoneCubic, RefusesWhatIsNoCurve) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(MonotoneCubic({}, {}), InputError);
  EXPECT_THROW(MonotoneCubic({0, 1}, {0}), InputError);
  EXPECT_THROW(MonotoneCubic({0, 1, 1}, {0, 1, 2}), InputError);
  EXPECT_THROW(MonotoneCubic({1, 0}, {0, 1}), InputError);
  EXPECT_THROW(MonotoneCubic({0, nan}, {0, 1}), InputError);
  EXPECT_THROW(MonotoneCubic({0, 1}, {0, nan}), InputError);
}

TEST(FitPolynomial, RecoversPolynomialsOfEachKind) {
  const std::vector<double> x = grid(0, 40, 15);
  const auto all = [](double u) { return 1 - 2 * u + 0.5 * u * u - 0.01 * std::pow(u, 5); };
  const auto even = [](double u) { return 3 - u * u + 1e-3 * std::pow(u, 8); };
  const auto odd = [](double u) { return 2 * u - 1e-4 * std::pow(u, 7); };
  const auto no_constant = [](double u) { return 2 * u - 0.3 * u * u; };
  const auto check = [&](const auto& f, int order, Powers powers) {
    const std::vector<double> y = values_of(f, x);
    const PolynomialFit fit = fit_polynomial(x, y, order, powers);
    const double size =
        *std::max_element(y.begin(), y.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    // condition of the scaled design matrix at order 8 is some 1e6, so 1e-9 relative
    EXPECT_LT(largest_error(f, fit, 0, 40), 1e-9 * std::abs(size));
    EXPECT_LT(fit.max_residual, 1e-9 * std::abs(size));
    EXPECT_LE(fit.rms_residual, fit.max_residual);
  };
  check(all, 5, Powers::all);
  check(all, 8, Powers::all);
  check(even, 8, Powers::even);
  check(odd, 7, Powers::odd);
  check(no_constant, 4, Powers::no_constant);
}

// Least squares by hand: the line through (0,0), (1,1), (2,1) is 1/6 + x/2, its residuals 1/6, −1/3, 1/6.
TEST(FitPolynomial, GivesTheLeastSquaresLineAndItsResiduals) {
  const std::vector<double> x{0, 1, 2}, y{0, 1, 1};
  const PolynomialFit fit = fit_polynomial(x, y, 1);
  EXPECT_NEAR(fit(0), 1.0 / 6, 1e-14);
  EXPECT_NEAR(fit.derivative(1.3), 0.5, 1e-14);
  EXPECT_NEAR(fit.max_residual, 1.0 / 3, 1e-14);
  EXPECT_NEAR(fit.rms_residual, std::sqrt(1.0 / 18), 1e-14);
}

TEST(FitPolynomial, RefusesTooLittleData) {
  const std::vector<double> x{0, 1, 2}, y{0, 1, 4}, mirrored{-1, 0, 1};
  EXPECT_THROW(fit_polynomial(x, y, 3), InputError);
  EXPECT_THROW(fit_polynomial(x, y, 0), InputError);
  EXPECT_THROW(fit_polynomial(x, y, 9), InputError);
  EXPECT_THROW(fit_polynomial(mirrored, y, 4, Powers::even),
               InputError);  // ±1 are one point to an even power
  EXPECT_THROW(fit_polynomial(x, std::vector<double>{0, 1}, 1), InputError);
  EXPECT_THROW(fit_polynomial(x, std::vector<double>{0, 1, std::nan("")}, 1), InputError);
  EXPECT_NO_THROW(fit_polynomial(x, y, 4, Powers::even));
}

}  // namespace
}  // namespace petzval
