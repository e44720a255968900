// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/numeric/chebyshev_surface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace petzval {
namespace {

struct Points {
  std::vector<double> x, y, value;
};

/// Rings over half a disc about (0, 3).
template <class F>
Points sample(const F& f) {
  Points points;
  for (int ring = 1; ring <= 8; ++ring)
    for (int i = 0; i < 24; ++i) {
      const double r = 0.25 * ring, azimuth = (i + 0.5) * 3.14159265358979 / 24;
      points.x.push_back(r * std::sin(azimuth));
      points.y.push_back(3 + r * std::cos(azimuth));
      points.value.push_back(f(points.x.back(), points.y.back()));
    }
  return points;
}

ChebyshevSurface fit_one(const Points& points, int degree) {
  const std::array<std::span<const double>, 1> values{points.value};
  const std::vector<ChebyshevSurface> surfaces = ChebyshevSurface::fit(points.x, points.y, values, degree);
  return surfaces.empty() ? ChebyshevSurface() : surfaces.front();
}

TEST(ChebyshevSurface, MeetsPolynomialsOfItsDegreeEverywhere) {
  const auto f = [](double x, double y) {
    return 2 - y + 0.5 * y * y * x * x + x * x * x * x - std::pow(y, 4);
  };
  const ChebyshevSurface surface = fit_one(sample(f), 4);
  EXPECT_LT(surface.max_residual(), 1e-12);  // rounding of values up to 600
  for (const double x : {-1.3, 0.0, 0.7})
    for (const double y : {1.5, 3.0, 4.4}) EXPECT_NEAR(surface(x, y), f(x, y), 1e-11) << x << " " << y;
}

TEST(ChebyshevSurface, ConvergesOnSmoothFunctions) {
  const auto f = [](double x, double y) { return std::exp(0.3 * y) * std::cos(0.5 * x); };
  double last = 1;
  for (const int degree : {4, 8, 12}) {
    const ChebyshevSurface surface = fit_one(sample(f), degree);
    EXPECT_LT(surface.rms_residual(), 0.02 * last) << degree;  // each four degrees gain far more than that
    EXPECT_GE(surface.max_residual(), surface.rms_residual());
    last = surface.rms_residual();
    EXPECT_NEAR(surface(0.4, 3.3), f(0.4, 3.3), 3 * surface.max_residual());
  }
}

TEST(ChebyshevSurface, MeetsPolynomialsWithoutSymmetry) {
  const auto f = [](double x, double y) {
    return 2 - y + 0.5 * x * y * y - x * x * x + 0.3 * x * x * y + std::pow(y, 4);
  };
  Points points;
  for (int i = 0; i <= 12; ++i)
    for (int j = 0; j <= 12; ++j) {
      points.x.push_back(-1.5 + 0.2 * i), points.y.push_back(1 + 0.25 * j);
      points.value.push_back(f(points.x.back(), points.y.back()));
    }
  const std::array<std::span<const double>, 1> values{points.value};
  const auto none = ChebyshevSurface::Symmetry::none;
  const std::vector<ChebyshevSurface> fitted = ChebyshevSurface::fit(points.x, points.y, values, 4, none);
  ASSERT_EQ(fitted.size(), 1u);
  for (const double x : {-1.3, 0.1, 0.8})
    for (const double y : {1.1, 2.2, 3.9}) EXPECT_NEAR(fitted[0](x, y), f(x, y), 1e-11) << x << " " << y;
  // A surface that must be even cannot be this one, and a polynomial of two variables has (d+1)(d+2)/2 terms.
  EXPECT_GT(ChebyshevSurface::fit(points.x, points.y, values, 4)[0].max_residual(), 0.1);
  EXPECT_EQ(ChebyshevSurface::unknowns(4, none), 15u);
}

/// The law of least squares: what is left of the values is orthogonal to every term.
void expect_orthogonal_residual(ChebyshevSurface::Symmetry symmetry) {
  const int degree = 12;
  Points points = sample([](double x, double y) { return std::sin(1e4 * x) + std::sin(1e4 * y); });
  if (symmetry == ChebyshevSurface::Symmetry::none)
    for (std::size_t i = 0, half = points.x.size(); i < half; ++i) {
      points.x.push_back(-1.01 * points.x[i]), points.y.push_back(points.y[i]);
      points.value.push_back(std::sin(7e4 * points.x[i]));
    }
  const std::array<std::span<const double>, 1> values{points.value};
  const std::vector<ChebyshevSurface> fitted =
      ChebyshevSurface::fit(points.x, points.y, values, degree, symmetry);
  ASSERT_EQ(fitted.size(), 1u);
  const auto [low, high] = std::minmax_element(points.y.begin(), points.y.end());
  EXPECT_GT(fitted[0].rms_residual(), 0.1);  // there is something left
  const int odd = symmetry == ChebyshevSurface::Symmetry::none ? 1 : 0;
  for (int power = 0; power <= odd; ++power)
    for (int m = 0; 2 * m + power <= degree; ++m)
      for (int n = 0; 2 * m + power + n <= degree; ++n) {
        double sum = 0;
        for (std::size_t i = 0; i < points.x.size(); ++i) {
          const double r = points.x[i] / fitted[0].x_scale();
          const double u = std::clamp(2 * r * r - 1, -1.0, 1.0);
          const double v = std::clamp((2 * points.y[i] - *low - *high) / (*high - *low), -1.0, 1.0);
          sum += (points.value[i] - fitted[0](points.x[i], points.y[i])) * std::pow(r, power) *
                 std::cos(m * std::acos(u)) * std::cos(n * std::acos(v));
        }
        EXPECT_NEAR(sum, 0, 1e-9) << power << " " << m << " " << n;
      }
}

TEST(ChebyshevSurface, LeavesWhatIsOrthogonalToEveryTerm) {
  expect_orthogonal_residual(ChebyshevSurface::Symmetry::even_in_x);
  expect_orthogonal_residual(ChebyshevSurface::Symmetry::none);
}

TEST(ChebyshevSurface, GivesItsSeriesAlongX) {
  const ChebyshevSurface surface = fit_one(sample([](double x, double y) { return x * x * y + y * y; }), 6);
  std::vector<double> series(surface.terms());
  surface.series(3.5, series);
  for (const double x : {0.0, 0.9, -1.6}) {
    const double ratio = x / surface.x_scale();
    EXPECT_NEAR(chebyshev_sum(series, 2 * ratio * ratio - 1), x * x * 3.5 + 3.5 * 3.5, 1e-11);
  }
}

TEST(ChebyshevSurface, MeetsPolynomialsAlongLinesBothWays) {
  const auto f = [](double x, double y) { return 1 + x - 0.5 * y * x * x + x * x * x * y - y * y * y; };
  Points points = sample(f);
  for (std::size_t i = 0, half = points.x.size(); i < half; ++i) {  // the other half of the disc
    points.x.push_back(-points.x[i]);
    points.y.push_back(points.y[i]);
    points.value.push_back(f(-points.x[i], points.y[i]));
  }
  const std::array<std::span<const double>, 1> values{points.value};
  const std::vector<ChebyshevSurface> surfaces =
      ChebyshevSurface::fit(points.x, points.y, values, 4, ChebyshevSurface::Symmetry::none);
  ASSERT_EQ(surfaces.size(), 1u);
  for (const double x : {-1.5, -0.25, 0.0, 0.7})
    for (const double y : {1.9, 3.0, 4.25}) {
      EXPECT_NEAR(surfaces[0].at_y(y)(x), f(x, y), 1e-10);
      EXPECT_NEAR(surfaces[0].at_x(x)(y), f(x, y), 1e-10);
    }
}

TEST(ChebyshevSurface, SaysWhenPointsDoNotDetermineIt) {
  Points line = sample([](double, double y) { return y; });
  for (double& y : line.y) y = 1;
  const std::array<std::span<const double>, 1> on_line{line.value};
  EXPECT_TRUE(ChebyshevSurface::fit(line.x, line.y, on_line, 4).empty());
  const Points few{{0.1, 0.2}, {1, 2}, {3, 4}};
  const std::array<std::span<const double>, 1> values{few.value};
  EXPECT_TRUE(ChebyshevSurface::fit(few.x, few.y, values, 4).empty());
  Points bad = few;
  bad.x[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ChebyshevSurface::fit(bad.x, bad.y, values, 1), InputError);
}

TEST(ChebyshevSurface, IsTheSameInAnotherFrame) {
  const auto f = [](double x, double y) { return 1 + y * x * x - 0.3 * std::pow(x, 4) + std::pow(y - 2, 3); };
  const ChebyshevSurface own = fit_one(sample(f), 6);
  const ChebyshevSurface moved = own.in_frame({1.7, 2.5, 2.2});
  EXPECT_EQ(moved.frame().y_middle, 2.5);
  for (double x = 0; x <= 2; x += 0.4)
    for (double y = 1; y <= 5; y += 0.5) EXPECT_NEAR(moved(x, y), f(x, y), 1e-10) << x << ' ' << y;
}

TEST(ChebyshevSurface, BlendsTermByTerm) {
  // Of two polynomials in one frame, and of degrees that differ.
  const auto f = [](double x, double y) { return y * x * x; };
  const auto g = [](double x, double y) { return std::pow(y, 6) - x * x; };
  const std::vector<ChebyshevSurface> surfaces{fit_one(sample(f), 4), fit_one(sample(g), 8)};
  const std::array<double, 2> weights{0.25, 0.75};
  const ChebyshevSurface sum = ChebyshevSurface::blend(surfaces, weights);
  for (double x = 0; x <= 1; x += 0.25)
    for (double y = 2; y <= 4; y += 0.5)
      EXPECT_NEAR(sum(x, y), 0.25 * f(x, y) + 0.75 * g(x, y), 1e-8 * std::pow(y, 6)) << x << ' ' << y;
}

}  // namespace
}  // namespace petzval
