// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/numeric/interpolation.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

namespace petzval {

namespace {

constexpr int max_order = 8;

std::vector<int> powers_up_to(int order, Powers powers) {
  const bool from_zero = powers == Powers::all || powers == Powers::even;
  const int step = powers == Powers::even || powers == Powers::odd ? 2 : 1;
  std::vector<int> list;
  for (int power = from_zero ? 0 : 1; power <= order; power += step) list.push_back(power);
  return list;
}

/// What the powers can tell apart: |x| for even and odd ones, and zero says nothing without a constant.
std::size_t distinct_points(std::span<const double> x, Powers powers) {
  std::set<double> distinct;
  for (const double value : x) {
    const bool folded = powers == Powers::even || powers == Powers::odd;
    const bool mute = value == 0 && (powers == Powers::odd || powers == Powers::no_constant);
    if (!mute) distinct.insert(folded ? std::abs(value) : value);
  }
  return distinct.size();
}

void require_fit(std::span<const double> x, std::span<const double> y, int order, Powers powers,
                 std::size_t unknowns) {
  if (order < 1 || order > max_order)
    throw InputError(
        fmt::format("a polynomial of order {} was asked for; 1 to {} can be fitted", order, max_order));
  if (x.size() != y.size())
    throw InputError(fmt::format("a polynomial fit needs as many values as points (there are {} and {})",
                                 y.size(), x.size()));
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i]) || !std::isfinite(y[i]))
      throw InputError(
          fmt::format("point {} of a polynomial fit is ({}, {}); both must be finite", i, x[i], y[i]));
  if (const std::size_t points = distinct_points(x, powers); points < unknowns)
    throw InputError(fmt::format("a polynomial of order {} needs {} different points, there are {}", order,
                                 unknowns, points));
}

}  // namespace

double PolynomialFit::operator()(double x) const {
  const double u = x / scale;
  double value = 0;
  for (std::size_t power = coefficients.size(); power-- > 0;) value = value * u + coefficients[power];
  return value;
}

double PolynomialFit::derivative(double x) const {
  const double u = x / scale;
  double value = 0;
  for (std::size_t power = coefficients.size(); power-- > 1;)
    value = value * u + static_cast<double>(power) * coefficients[power];
  return value / scale;
}

PolynomialFit fit_polynomial(std::span<const double> x, std::span<const double> y, int order, Powers powers) {
  const std::vector<int> list = powers_up_to(order, powers);
  require_fit(x, y, order, powers, list.size());

  PolynomialFit fit;
  fit.scale = 0;
  for (const double value : x) fit.scale = std::max(fit.scale, std::abs(value));
  if (fit.scale == 0) fit.scale = 1;

  const auto rows = static_cast<Eigen::Index>(x.size()), columns = static_cast<Eigen::Index>(list.size());
  Eigen::MatrixXd design(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < columns; ++j)
      design(i, j) = std::pow(x[static_cast<std::size_t>(i)] / fit.scale, list[static_cast<std::size_t>(j)]);
  const Eigen::Map<const Eigen::VectorXd> values(y.data(), rows);
  const Eigen::VectorXd solution = design.colPivHouseholderQr().solve(values);

  fit.coefficients.assign(static_cast<std::size_t>(order) + 1, 0.0);
  for (std::size_t j = 0; j < list.size(); ++j)
    fit.coefficients[static_cast<std::size_t>(list[j])] = solution(static_cast<Eigen::Index>(j));
  const Eigen::VectorXd residual = design * solution - values;
  fit.rms_residual = std::sqrt(residual.squaredNorm() / static_cast<double>(rows));
  fit.max_residual = residual.cwiseAbs().maxCoeff();
  return fit;
}

}  // namespace petzval
