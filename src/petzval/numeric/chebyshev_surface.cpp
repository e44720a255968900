// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/numeric/chebyshev_surface.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace petzval {

namespace {

/// Directions that the points tell apart less than this, against the best one, are rounding.
constexpr double least_pivot = 1e-13;

/// Room for T_0 … T_highest_degree.
using Terms = std::array<double, ChebyshevSurface::highest_degree + 1>;

/// T_0 … T_{count−1} at t.
void chebyshev(double t, std::size_t count, double* values) {
  values[0] = 1;
  if (count > 1) values[1] = t;
  for (std::size_t n = 2; n < count; ++n) values[n] = 2 * t * values[n - 1] - values[n - 2];
}

void require_points(std::span<const double> x, std::span<const double> y,
                    std::span<const std::span<const double>> values) {
  bool good = x.size() == y.size() && !x.empty();
  const auto finite = [](std::span<const double> list) {
    return std::all_of(list.begin(), list.end(), [](double value) { return std::isfinite(value); });
  };
  good = good && finite(x) && finite(y);
  for (const auto& list : values) good = good && list.size() == x.size() && finite(list);
  if (!good) throw InputError("a surface fit needs as many finite values as points, and at least one point");
}

}  // namespace

std::size_t ChebyshevSurface::unknowns(int degree, Symmetry symmetry) {
  std::size_t count = 0;
  for (int m = 0; 2 * m <= degree; ++m) count += static_cast<std::size_t>(degree - 2 * m + 1);
  return symmetry == Symmetry::even_in_x ? count : count + unknowns(degree - 1);
}

std::vector<ChebyshevSurface> ChebyshevSurface::fit(std::span<const double> x, std::span<const double> y,
                                                    std::span<const std::span<const double>> values,
                                                    int degree, Symmetry symmetry) {
  require_points(x, y, values);
  if (degree > highest_degree)
    throw InputError(fmt::format("a surface of degree {}; at most {} is fitted", degree, highest_degree));
  const auto [low, high] = std::minmax_element(y.begin(), y.end());
  ChebyshevSurface frame;
  frame.degree_ = std::max(degree, 0);
  frame.y_middle_ = 0.5 * (*low + *high);
  frame.y_scale_ = 0.5 * (*high - *low);
  frame.x_scale_ = 0;
  for (const double value : x) frame.x_scale_ = std::max(frame.x_scale_, std::abs(value));
  if (!(frame.x_scale_ > 0) || !(frame.y_scale_ > 0) || x.size() < unknowns(degree, symmetry)) return {};

  const auto rows = static_cast<Eigen::Index>(x.size()),
             columns = static_cast<Eigen::Index>(unknowns(degree, symmetry));
  Eigen::MatrixXd basis(columns, rows);  // a column a point
  std::vector<double> of_u(frame.terms()), of_v(static_cast<std::size_t>(frame.degree_) + 1);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double ratio = x[static_cast<std::size_t>(i)] / frame.x_scale_;
    chebyshev(2 * ratio * ratio - 1, of_u.size(), of_u.data());
    chebyshev((y[static_cast<std::size_t>(i)] - frame.y_middle_) / frame.y_scale_, of_v.size(), of_v.data());
    double* to = basis.col(i).data();
    for (std::size_t m = 0; m < of_u.size(); ++m)
      for (std::size_t n = 0; n + 2 * m < of_v.size(); ++n) *to++ = of_u[m] * of_v[n];
    if (symmetry == Symmetry::even_in_x) continue;
    for (std::size_t m = 0; 2 * m + 1 < of_v.size(); ++m)
      for (std::size_t n = 0; n + 2 * m + 1 < of_v.size(); ++n) *to++ = ratio * of_u[m] * of_v[n];
  }
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(columns, columns);
  normal.selfadjointView<Eigen::Lower>().rankUpdate(basis);
  const Eigen::LDLT<Eigen::MatrixXd, Eigen::Lower> solver(normal);
  const auto pivots = solver.vectorD();
  const bool well_determined =
      solver.info() == Eigen::Success && pivots.minCoeff() > least_pivot * pivots.maxCoeff();
  // Points that leave much of their box empty tell the terms apart by less than the normal equations resolve.
  std::optional<Eigen::HouseholderQR<Eigen::MatrixXd>> orthogonal;
  if (!well_determined) {
    orthogonal.emplace(basis.transpose());
    const Eigen::ArrayXd diagonal = orthogonal->matrixQR().diagonal().array().abs();
    if (!(diagonal.minCoeff() > least_pivot * diagonal.maxCoeff())) return {};
  }

  std::vector<ChebyshevSurface> surfaces;
  for (const auto& list : values) {
    const Eigen::Map<const Eigen::VectorXd> wanted(list.data(), rows);
    Eigen::VectorXd solution, residual;
    if (orthogonal) {
      solution = orthogonal->solve(wanted);
    } else {
      solution = solver.solve(basis * wanted);
      residual = wanted - basis.transpose() * solution;
      solution += solver.solve(basis * residual);  // gives back what the squared condition number took
    }
    residual = wanted - basis.transpose() * solution;
    ChebyshevSurface surface = frame;
    const auto even = solution.begin() + static_cast<std::ptrdiff_t>(unknowns(frame.degree_));
    surface.coefficients_.assign(solution.begin(), even);
    surface.odd_.assign(even, solution.end());
    surface.rms_residual_ = residual.norm() / std::sqrt(static_cast<double>(rows));
    surface.max_residual_ = residual.lpNorm<Eigen::Infinity>();
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

void ChebyshevSurface::series(double y, std::span<double> series) const {
  const auto order = static_cast<std::size_t>(degree_) + 1;
  Terms of_v;
  chebyshev((y - y_middle_) / y_scale_, order, of_v.data());
  const double* from = coefficients_.data();
  for (std::size_t m = 0; m < terms(); ++m) {
    series[m] = 0;
    for (std::size_t n = 0; n + 2 * m < order; ++n) series[m] += *from++ * of_v[n];
  }
}

ChebyshevSurface::Line ChebyshevSurface::at_y(double y) const {
  Line line;
  line.scale = x_scale_;
  if (odd_.empty()) {
    line.count = terms();
    line.folded = true;
    series(y, line.terms);
    return line;
  }
  const auto order = static_cast<std::size_t>(degree_);
  line.count = order + 1;
  Terms even, of_v;
  series(y, even);
  std::fill_n(line.terms.begin(), line.count, 0.0);
  for (std::size_t m = 0; 2 * m < line.count; ++m) line.terms[2 * m] = even[m];  // T_m(2r² − 1) = T_2m(r)
  chebyshev((y - y_middle_) / y_scale_, order, of_v.data());
  const double* from = odd_.data();
  for (std::size_t m = 0; 2 * m < order; ++m) {
    double odd = 0;
    for (std::size_t n = 0; n + 2 * m < order; ++n) odd += *from++ * of_v[n];
    // r T_2m = (T_2m+1 + T_|2m−1|)/2
    line.terms[2 * m + 1] += 0.5 * odd;
    line.terms[m == 0 ? 1 : 2 * m - 1] += 0.5 * odd;
  }
  return line;
}

ChebyshevSurface::Line ChebyshevSurface::at_x(double x) const {
  Line line;
  line.middle = y_middle_;
  line.scale = y_scale_;
  line.count = static_cast<std::size_t>(degree_) + 1;
  std::fill_n(line.terms.begin(), line.count, 0.0);
  const double ratio = x / x_scale_;
  Terms of_u;
  chebyshev(2 * ratio * ratio - 1, terms(), of_u.data());
  const double* from = coefficients_.data();
  for (std::size_t m = 0; 2 * m < line.count; ++m)
    for (std::size_t n = 0; n + 2 * m < line.count; ++n) line.terms[n] += *from++ * of_u[m];
  from = odd_.data();
  for (std::size_t m = 0; 2 * m + 1 < line.count && !odd_.empty(); ++m)
    for (std::size_t n = 0; n + 2 * m + 1 < line.count; ++n) line.terms[n] += *from++ * ratio * of_u[m];
  return line;
}

double ChebyshevSurface::operator()(double x, double y) const {
  return at_y(y)(x);
}

double ChebyshevSurface::Line::operator()(double along) const {
  const double ratio = (along - middle) / scale;
  return chebyshev_sum(std::span(terms).first(count), folded ? 2 * ratio * ratio - 1 : ratio);
}

double chebyshev_sum(std::span<const double> series, double u) {
  double later = 0, latest = 0;
  for (std::size_t m = series.size() - 1; m > 0; --m) {
    const double next = 2 * u * latest - later + series[m];
    later = latest;
    latest = next;
  }
  return u * latest - later + series[0];
}

}  // namespace petzval
