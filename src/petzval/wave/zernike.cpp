// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/wave/zernike.h>

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <cstdlib>

namespace petzval {

namespace {

/// Row n holds the indices n(n+1)/2 + 1 … (n+1)(n+2)/2, |m| rising; even indices are cosines.
ZernikeTerm noll_term(int index) {
  int n = 0;
  while ((n + 1) * (n + 2) / 2 < index) ++n;
  const int place = index - n * (n + 1) / 2;
  const int m = n % 2 == 0 ? 2 * (place / 2) : 2 * ((place - 1) / 2) + 1;
  return {n, index % 2 == 0 ? m : -m};
}

/// Group s = (n + |m|)/2 ends with index (s + 1)², |m| falling, cosine before sine.
ZernikeTerm fringe_term(int index) {
  if (index == largest_fringe_index) return {12, 0};
  int s = 0;
  while ((s + 1) * (s + 1) < index) ++s;
  const int from_end = (s + 1) * (s + 1) - index;
  const int m = (from_end + 1) / 2;
  return {2 * s - m, from_end % 2 == 0 ? m : -m};
}

double norm(ZernikeOrder order, const ZernikeTerm& term) {
  if (order == ZernikeOrder::fringe) return 1;
  return std::sqrt((term.m == 0 ? 1.0 : 2.0) * (term.n + 1));
}

double value_at(ZernikeOrder order, const ZernikeTerm& term, double rho, double theta) {
  const int m = std::abs(term.m);
  const double angular = term.m < 0 ? std::sin(m * theta) : std::cos(m * theta);
  return norm(order, term) * zernike_radial(term.n, m, rho) * angular;
}

void require_points(int terms, std::span<const double> x, std::span<const double> y,
                    std::span<const double> values, std::span<const double> weights) {
  if (x.size() != y.size() || x.size() != values.size() || x.size() != weights.size())
    throw InputError(fmt::format("a Zernike fit got {} x, {} y, {} values and {} weights; give one each",
                                 x.size(), y.size(), values.size(), weights.size()));
  std::size_t counting = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i]) || !std::isfinite(values[i]) ||
        !(weights[i] >= 0 && std::isfinite(weights[i])))
      throw InputError(fmt::format(
          "point {} of a Zernike fit is ({}, {}) with value {} and weight {}; all must be finite and the "
          "weight not negative",
          i, x[i], y[i], values[i], weights[i]));
    counting += weights[i] > 0;
  }
  if (counting < static_cast<std::size_t>(terms))
    throw InputError(
        fmt::format("{} Zernike terms need as many points with a weight, there are {}", terms, counting));
}

}  // namespace

ZernikeTerm zernike_term(ZernikeOrder order, int index) {
  const int largest = order == ZernikeOrder::noll ? largest_noll_index : largest_fringe_index;
  if (index < 1 || index > largest)
    throw InputError(fmt::format("there is no {} Zernike term {}; 1 to {} would be right",
                                 order == ZernikeOrder::noll ? "Noll" : "Fringe", index, largest));
  return order == ZernikeOrder::noll ? noll_term(index) : fringe_term(index);
}

std::string zernike_name(const ZernikeTerm& term) {
  constexpr std::array<const char*, 7> by_order = {"piston",    "tilt",      "astigmatism", "trefoil",
                                                   "tetrafoil", "pentafoil", "hexafoil"};
  constexpr std::array<const char*, 3> degrees = {"", "secondary ", "tertiary "};
  const int m = std::abs(term.m), above = (term.n - m) / 2;
  if (m == 0) {
    if (term.n == 0) return "piston";
    if (term.n == 2) return "defocus";
    const int degree = above - 2;
    if (degree < 3) return fmt::format("{}spherical", degrees[static_cast<std::size_t>(degree)]);
    return fmt::format("Z({}, 0)", term.n);
  }
  const char* axis = term.m > 0 ? "x" : "y";
  if (m == 1) {
    if (term.n == 1) return fmt::format("tilt {}", axis);
    if (above - 1 < 3) return fmt::format("{}coma {}", degrees[static_cast<std::size_t>(above - 1)], axis);
  } else if (m < 7 && above < 3) {
    const std::string kind = degrees[static_cast<std::size_t>(above)];
    const char* name = by_order[static_cast<std::size_t>(m)];
    if (m == 2) return fmt::format("{}{} {}", kind, name, term.m > 0 ? "0°" : "45°");
    return fmt::format("{}{} {}", kind, name, axis);
  }
  return fmt::format("Z({}, {})", term.n, term.m);
}

double zernike_radial(int n, int m, double rho) {
  // ρ^m times the Jacobi polynomial P_k^(0, m) of 2ρ² − 1.
  const int k_last = (n - m) / 2;
  const double x = 2 * rho * rho - 1, b = m;
  double before = 1, value = k_last == 0 ? 1 : 1 + 0.5 * (b + 2) * (x - 1);
  for (int k = 2; k <= k_last; ++k) {
    const double s = 2 * k + b;
    const double next =
        ((s - 1) * (s * (s - 2) * x - b * b) * value - 2 * (k - 1) * (k + b - 1) * s * before) /
        (2 * k * (k + b) * (s - 2));
    before = value;
    value = next;
  }
  return std::pow(rho, m) * value;
}

double zernike(ZernikeOrder order, int index, double x, double y) {
  return value_at(order, zernike_term(order, index), std::hypot(x, y), std::atan2(y, x));
}

double zernike_sum(ZernikeOrder order, std::span<const double> coefficients, double x, double y) {
  const double rho = std::hypot(x, y), theta = std::atan2(y, x);
  double sum = 0;
  for (std::size_t j = 0; j < coefficients.size(); ++j)
    if (coefficients[j] != 0)
      sum += coefficients[j] * value_at(order, zernike_term(order, static_cast<int>(j) + 1), rho, theta);
  return sum;
}

ZernikeFit fit_zernike(ZernikeOrder order, int terms, std::span<const double> x, std::span<const double> y,
                       std::span<const double> values, std::span<const double> weights) {
  zernike_term(order, terms);
  require_points(terms, x, y, values, weights);
  const auto rows = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd design(rows, terms);
  Eigen::VectorXd right(rows);
  double total = 0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double root = std::sqrt(weights[at]), rho = std::hypot(x[at], y[at]),
                 theta = std::atan2(y[at], x[at]);
    for (int j = 0; j < terms; ++j)
      design(i, j) = root * value_at(order, zernike_term(order, j + 1), rho, theta);
    right(i) = root * values[at];
    total += weights[at];
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(design);
  if (factors.rank() < terms)
    throw InputError(fmt::format(
        "the points of a Zernike fit cannot tell {} terms apart; fewer terms or more points would be right",
        terms));
  const Eigen::VectorXd solution = factors.solve(right);
  ZernikeFit fit;
  fit.coefficients.assign(solution.data(), solution.data() + solution.size());
  fit.rms_residual = (design * solution - right).norm() / std::sqrt(total);
  return fit;
}

}  // namespace petzval
