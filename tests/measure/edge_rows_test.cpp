// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/chebyshev_lanes.h>
#include <petzval/measure/sfr/edge_rows.h>
#include <petzval/measure/sfr/flux_lanes.h>
#include <petzval/measure/sfr/logistic_lanes.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace petzval {
namespace {

/// The j-th function at a point: splines by truncated powers, centred on a grid about 0, then the others.
double function_at(const EdgeSpreadBasis& basis, int j, const EdgePoint& point) {
  const double d = point.distance, q = 1 / (1 + d * d);
  if (j < basis.splines) {
    const double x = (d + basis.core_px()) / basis.knot_px - j;
    constexpr std::array<double, 7> binomial{1, 6, 15, 20, 15, 6, 1};
    double sum = 0;
    if (x > 0 && x < 6)
      for (int k = 0; k < 7; ++k)
        sum += (k % 2 == 0 ? 1 : -1) * binomial[static_cast<std::size_t>(k)] *
               std::pow(std::max(0.0, x - k), 5) / 120;
    return sum;
  }
  const double along = point.along, across = d / basis.core_px(), l = point.light;
  const std::array<double, 9> others{1,
                                     0.5 + (std::atan(d) + 0.5 * point.missing) / pi,
                                     -d * q + 0.5 * point.missing,
                                     -d * q * q,
                                     l * along,
                                     l * across,
                                     l * along * along,
                                     l * along * across,
                                     l * across * across};
  return others[static_cast<std::size_t>(j - basis.splines)];
}

std::vector<EdgePoint> some_points() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<EdgePoint> points;
  for (int i = 0; i < 203; ++i)  // no multiple of any number of lanes
    points.push_back({6 * share(random), share(random), share(random), share(random), 0.1 * share(random)});
  return points;
}

class EdgeRowsOfOrder : public testing::TestWithParam<int> {};

TEST_P(EdgeRowsOfOrder, SumWhatPlainLoopsSum) {
  EdgeSpreadBasis basis{EdgeSpreadBasis::splines_within(4, 0.25), 0.25, GetParam(), 0};
  const std::vector<EdgePoint> points = some_points();
  std::vector<double> weights;
  for (const EdgePoint& point : points) weights.push_back(1 + point.along);
  EdgeRows rows;
  rows.make(points, basis);
  const EdgeRows::Products products = rows.products(weights);
  const int lanes = rows.fixed_lanes(), stride = EdgeRows::spline_lanes + lanes, size = basis.size();
  const auto product_of = [&](int i, int j) {
    double sum = 0;
    for (std::size_t k = 0; k < points.size(); ++k)
      sum += weights[k] * function_at(basis, i, points[k]) *
             (j < size ? function_at(basis, j, points[k]) : points[k].value);
    return sum;
  };
  // Of the order of 200; sums in another order.
  constexpr double rounding = 1e-11;
  for (int i = 0; i < basis.splines; ++i) {
    const double* const column = &products.columns[static_cast<std::size_t>((i + EdgeRows::margin) * stride)];
    for (int j = i; j < std::min(i + 6, basis.splines); ++j)
      EXPECT_NEAR(column[j - i], product_of(i, j), rounding);
    for (int r = 0; r < basis.fixed(); ++r)
      EXPECT_NEAR(column[EdgeRows::spline_lanes + r], product_of(i, basis.splines + r), rounding);
    EXPECT_NEAR(column[stride - 1], product_of(i, size), rounding);
  }
  for (int r = 0; r < basis.fixed(); ++r) {
    const double* const row = &products.corner[static_cast<std::size_t>(r * lanes)];
    for (int s = 0; s < basis.fixed(); ++s)
      EXPECT_NEAR(row[s], product_of(basis.splines + r, basis.splines + s), rounding);
    EXPECT_NEAR(row[lanes - 1], product_of(basis.splines + r, size), rounding);
  }
}

TEST_P(EdgeRowsOfOrder, EvaluateAndProject) {
  EdgeSpreadBasis basis{EdgeSpreadBasis::splines_within(4, 0.25), 0.25, GetParam(), 0};
  const std::vector<EdgePoint> points = some_points();
  EdgeRows rows;
  rows.make(points, basis);
  std::vector<double> splines(static_cast<std::size_t>(rows.padded() + EdgeRows::spline_lanes)),
      fixed(static_cast<std::size_t>(rows.fixed_lanes()));
  const auto factor = [](int j) { return std::sin(1.3 * j + 0.4); };
  for (int j = 0; j < basis.splines; ++j) splines[static_cast<std::size_t>(EdgeRows::margin + j)] = factor(j);
  for (int r = 0; r < basis.fixed(); ++r) fixed[static_cast<std::size_t>(r)] = factor(basis.splines + r);
  const EdgeRows::Sums sums = rows.evaluate(splines, fixed);
  std::vector<double> functions, projected(static_cast<std::size_t>(2 * basis.size()));
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto value_at = [&](double shift, int size) {
      EdgePoint point = points[k];
      point.distance += shift;
      double sum = 0;
      for (int j = 0; j < size; ++j) sum += factor(j) * function_at(basis, j, point);
      return sum;
    };
    EXPECT_NEAR(sums.values[k], value_at(0, basis.size()), 1e-12);
    constexpr double h = 1e-4;  // differences of third order in it, of 6 (2π/0.25)³ or less
    EXPECT_NEAR(sums.slopes[k], (value_at(h, basis.splines + 4) - value_at(-h, basis.splines + 4)) / (2 * h),
                2e-4);
    functions.push_back(points[k].value), functions.push_back(points[k].along);
    for (int j = 0; j < basis.size(); ++j) {
      const double value = function_at(basis, j, points[k]);
      projected[static_cast<std::size_t>(j)] += value * points[k].value;
      projected[static_cast<std::size_t>(basis.size() + j)] += value * points[k].along;
    }
  }
  const std::vector<double> found = rows.project(functions, 2);
  for (std::size_t k = 0; k < 2; ++k)
    for (int j = 0; j < basis.size(); ++j) {
      const int at = j < basis.splines ? j + EdgeRows::margin
                                       : rows.padded() + EdgeRows::spline_lanes + j - basis.splines;
      EXPECT_NEAR(found[k * rows.projections() + static_cast<std::size_t>(at)],
                  projected[k * static_cast<std::size_t>(basis.size()) + static_cast<std::size_t>(j)], 1e-11);
    }
}

INSTANTIATE_TEST_SUITE_P(Light, EdgeRowsOfOrder, testing::Values(0, 1, 2));

TEST(EdgeLanes, SumChebyshevPolynomials) {
  constexpr int along = 3, across = 4, stride = 5;
  std::vector<double> coefficients(along * stride, 100.0), x, y;
  for (std::size_t i = 0; i < along; ++i)
    for (std::size_t j = 0; j < across; ++j)
      coefficients[i * stride + j] = std::sin(static_cast<double>(7 * i + 3 * j + 1));
  for (int k = 0; k < 11; ++k) x.push_back(1.2 - 0.23 * k), y.push_back(-1.1 + 0.2 * k);
  std::vector<double> sums(x.size());
  chebyshev_sums({coefficients.data(), along, across, stride}, x, y, sums);
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double a = std::acos(std::clamp(x[k], -1.0, 1.0)), b = std::acos(std::clamp(y[k], -1.0, 1.0));
    double sum = 0;
    for (std::size_t i = 0; i < along; ++i)
      for (std::size_t j = 0; j < across; ++j)
        sum += coefficients[i * stride + j] * std::cos(static_cast<double>(i) * a) *
               std::cos(static_cast<double>(j) * b);
    EXPECT_NEAR(sums[k], sum, 1e-14);
  }
}

TEST(EdgeLanes, SumTheFluxOfSides) {
  FluxSides sides;
  double expected = 0;
  for (int i = 0; i < 11; ++i) {
    const double x = 3 * std::cos(2.0 * i), y = 3 * std::sin(2.0 * i), wx = 9 * std::cos(0.7 * i),
                 wy = 9 * std::sin(0.7 * i);
    sides.add(x + 1, y + 2, wx, wy);
    // Some of them are seen under more than a right angle. By the rule of midpoints, of (r·n)/r³ ds with n ds
    // = (wy, −wx) dt.
    constexpr int pieces = 20000;
    for (int k = 0; k < pieces; ++k) {
      const double t = (k + 0.5) / pieces, rx = x + t * wx, ry = y + t * wy;
      expected += (rx * wy - ry * wx) / std::pow(rx * rx + ry * ry, 1.5) / pieces;
    }
  }
  EXPECT_NEAR(sides.flux(1, 2), expected, 1e-8);
}

TEST(EdgeLanes, SumLogisticEdges) {
  LogisticSamples samples;
  for (int i = 0; i < 16; ++i) {
    const bool is_one = i < 13;
    samples.x.push_back(is_one ? 2 * std::sin(3.0 * i) : 0),
        samples.y.push_back(is_one ? std::cos(5.0 * i) : 0);
    samples.value.push_back(is_one ? std::sin(1.0 * i) : 0), samples.weight.push_back(is_one ? 1 : 0);
  }
  const LogisticEdge edge{0.2, 0.3, -0.4, 0.1, 0.9};
  const auto model = [&](const LogisticEdge& e, std::size_t i) {
    const double z = (samples.x[i] * std::cos(e[1]) + samples.y[i] * std::sin(e[1]) - e[0]) / std::exp(e[2]);
    return e[3] + (e[4] - e[3]) / (1 + std::exp(-z));
  };
  double square = 0;
  std::array<std::array<double, 5>, 5> normal{};
  std::array<double, 5> right{};
  for (std::size_t i = 0; i < 13; ++i) {
    const double residual = samples.value[i] - model(edge, i);
    std::array<double, 5> derivative{};
    for (std::size_t r = 0; r < 5; ++r) {
      constexpr double h = 1e-5;
      LogisticEdge more = edge, less = edge;
      more[r] += h, less[r] -= h;
      derivative[r] = (model(more, i) - model(less, i)) / (2 * h);
    }
    square += residual * residual;
    for (std::size_t r = 0; r < 5; ++r) {
      right[r] += residual * derivative[r];
      for (std::size_t s = 0; s < 5; ++s) normal[r][s] += derivative[r] * derivative[s];
    }
  }
  const LogisticSums sums = logistic_sums(samples, edge);
  EXPECT_NEAR(sums.square, square, 1e-13);
  for (std::size_t r = 0, at = 0; r < 5; ++r) {
    EXPECT_NEAR(sums.right[r], right[r], 1e-8);  // differences of second order in 1e-5
    for (std::size_t s = 0; s <= r; ++s, ++at) EXPECT_NEAR(sums.normal[at], normal[r][s], 1e-8);
  }
}

}  // namespace
}  // namespace petzval
