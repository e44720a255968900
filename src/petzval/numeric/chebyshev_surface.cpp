// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
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

/// The terms r^p T_m(u) T_n(v) at the points, r = x/x_scale, p = 0 and for what is odd in x 1. Each is a
/// product of a function of x and one of y, and no list of all of them is kept: their sums over the points
/// are products of matrices that are a dozen times smaller.
class PointTerms {
 public:
  PointTerms(std::span<const double> x, std::span<const double> y, double x_scale, double y_middle,
             double y_scale, int degree, ChebyshevSurface::Symmetry symmetry) {
    const auto points = static_cast<Eigen::Index>(x.size());
    const Eigen::Index highest = degree, most = highest / 2;
    for (Eigen::Index m = 0; m <= most; ++m) factors_.push_back({0, m, highest - 2 * m + 1});
    if (symmetry == ChebyshevSurface::Symmetry::none)
      for (Eigen::Index m = 0; 2 * m < highest; ++m) factors_.push_back({1, m, highest - 2 * m});
    const Eigen::ArrayXd ratio = Eigen::Map<const Eigen::ArrayXd>(x.data(), points) / x_scale;
    const Eigen::ArrayXd v = (Eigen::Map<const Eigen::ArrayXd>(y.data(), points) - y_middle) / y_scale;
    of_u_ = chebyshev_columns(2 * ratio.square() - 1, 2 * most + 1);
    of_v_ = chebyshev_columns(v, 2 * highest + 1);
    ratio_ = ratio.matrix();
    of_x_.resize(points, static_cast<Eigen::Index>(factors_.size()));
    for (Eigen::Index k = 0; const Factor& factor : factors_)
      of_x_.col(k++) =
          (factor.power == 0 ? Eigen::ArrayXd::Ones(points) : ratio) * of_u_.col(factor.m).array();
    of_y_ = of_v_.leftCols(highest + 1);
  }

  /// Every term, a column each.
  Eigen::MatrixXd all() const {
    Eigen::MatrixXd terms(of_x_.rows(), unknowns());
    for (Eigen::Index k = 0, to = 0; const Factor& factor : factors_) {
      terms.middleCols(to, factor.length) =
          of_y_.leftCols(factor.length).array().colwise() * of_x_.col(k++).array();
      to += factor.length;
    }
    return terms;
  }

  /// The sum over the points of each term times these values.
  Eigen::VectorXd projected(const Eigen::VectorXd& values) const {
    const Eigen::MatrixXd sums = of_y_.transpose() * (of_x_.array().colwise() * values.array()).matrix();
    Eigen::VectorXd result(unknowns());
    for (Eigen::Index k = 0, to = 0; const Factor& factor : factors_) {
      result.segment(to, factor.length) = sums.col(k++).head(factor.length);
      to += factor.length;
    }
    return result;
  }

  /// The polynomial at the points.
  Eigen::VectorXd values(const Eigen::VectorXd& coefficients) const {
    Eigen::MatrixXd of_factor = Eigen::MatrixXd::Zero(of_y_.cols(), of_x_.cols());
    for (Eigen::Index k = 0, from = 0; const Factor& factor : factors_) {
      of_factor.col(k++).head(factor.length) = coefficients.segment(from, factor.length);
      from += factor.length;
    }
    return (of_y_ * of_factor).cwiseProduct(of_x_).rowwise().sum();
  }

  /// The sums of products of two terms; the lower half. As T_m T_k = (T_{m+k} + T_|m−k|)/2, they are those of
  /// single terms of twice the degree.
  Eigen::MatrixXd normal_equations() const {
    std::array<Eigen::MatrixXd, 3> moments;  // by the power of r
    for (int power = 0; power <= 2 * factors_.back().power; ++power)
      moments[static_cast<std::size_t>(power)] =
          of_v_.transpose() * (of_u_.array().colwise() * ratio_.array().pow(power)).matrix();
    Eigen::MatrixXd normal(unknowns(), unknowns());
    Eigen::Index column = 0;
    for (auto one = factors_.begin(); one != factors_.end(); column += one++->length) {
      Eigen::Index row = column;
      for (auto other = one; other != factors_.end(); row += other++->length) {
        const Eigen::MatrixXd& moment = moments[static_cast<std::size_t>(one->power + other->power)];
        const Eigen::VectorXd of_n =
            0.25 * (moment.col(one->m + other->m) + moment.col(std::abs(one->m - other->m)));
        for (Eigen::Index n = 0; n < one->length; ++n)
          for (Eigen::Index q = 0; q < other->length; ++q)
            normal(row + q, column + n) = of_n[n + q] + of_n[std::abs(n - q)];
      }
    }
    return normal;
  }

 private:
  /// r^power T_m(u), which stands before T_0(v) … T_{length−1}(v).
  struct Factor {
    int power;
    Eigen::Index m, length;
  };

  Eigen::Index unknowns() const {
    Eigen::Index count = 0;
    for (const Factor& factor : factors_) count += factor.length;
    return count;
  }
  /// T_0 … T_{count−1}, a column each.
  static Eigen::MatrixXd chebyshev_columns(const Eigen::ArrayXd& t, Eigen::Index count) {
    Eigen::MatrixXd columns(t.size(), count);
    columns.col(0).setOnes();
    if (count > 1) columns.col(1) = t.matrix();
    for (Eigen::Index n = 2; n < count; ++n)
      columns.col(n) = (2 * t * columns.col(n - 1).array()).matrix() - columns.col(n - 2);
    return columns;
  }

  std::vector<Factor> factors_;
  Eigen::VectorXd ratio_;
  Eigen::MatrixXd of_u_, of_v_;  ///< to twice the degree
  Eigen::MatrixXd of_x_, of_y_;  ///< of each factor, and T_n(v)
};

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

  const PointTerms terms(x, y, frame.x_scale_, frame.y_middle_, frame.y_scale_, frame.degree_, symmetry);
  const Eigen::LDLT<Eigen::MatrixXd, Eigen::Lower> solver(terms.normal_equations());
  const auto pivots = solver.vectorD();
  const bool well_determined =
      solver.info() == Eigen::Success && pivots.minCoeff() > least_pivot * pivots.maxCoeff();
  // Points that leave much of their box empty tell the terms apart by less than the normal equations resolve.
  std::optional<Eigen::HouseholderQR<Eigen::MatrixXd>> orthogonal;
  if (!well_determined) {
    orthogonal.emplace(terms.all());
    const Eigen::ArrayXd diagonal = orthogonal->matrixQR().diagonal().array().abs();
    if (!(diagonal.minCoeff() > least_pivot * diagonal.maxCoeff())) return {};
  }

  std::vector<ChebyshevSurface> surfaces;
  for (const auto& list : values) {
    const Eigen::Map<const Eigen::VectorXd> wanted(list.data(), static_cast<Eigen::Index>(list.size()));
    Eigen::VectorXd solution, residual;
    if (orthogonal) {
      solution = orthogonal->solve(wanted);
    } else {
      solution = solver.solve(terms.projected(wanted));
      residual = wanted - terms.values(solution);
      solution += solver.solve(terms.projected(residual));  // what the squared condition number took
    }
    residual = wanted - terms.values(solution);
    ChebyshevSurface surface = frame;
    const auto even = solution.begin() + static_cast<std::ptrdiff_t>(unknowns(frame.degree_));
    surface.coefficients_.assign(solution.begin(), even);
    surface.odd_.assign(even, solution.end());
    surface.rms_residual_ = residual.norm() / std::sqrt(static_cast<double>(residual.size()));
    surface.max_residual_ = residual.lpNorm<Eigen::Infinity>();
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

ChebyshevSurface ChebyshevSurface::in_frame(const Frame& frame) const {
  ChebyshevSurface moved;
  moved.degree_ = degree_;
  moved.x_scale_ = frame.x_scale, moved.y_middle_ = frame.y_middle, moved.y_scale_ = frame.y_scale;
  moved.rms_residual_ = rms_residual_, moved.max_residual_ = max_residual_;
  moved.coefficients_.assign(coefficients_.size(), 0.0);
  // Values at Chebyshev points of the new frame; the terms follow by discrete orthogonality.
  const auto order = static_cast<std::size_t>(degree_) + 1;
  std::vector<double> at_u(terms()), of_m(terms());
  Terms of_u, of_v;
  for (std::size_t j = 0; j < order; ++j) {
    const double v = std::cos(pi * (static_cast<double>(j) + 0.5) / static_cast<double>(order));
    series(frame.y_middle + frame.y_scale * v, at_u);
    std::fill(of_m.begin(), of_m.end(), 0.0);
    for (std::size_t i = 0; i < terms(); ++i) {
      const double u = std::cos(pi * (static_cast<double>(i) + 0.5) / static_cast<double>(terms()));
      const double square = 0.5 * (u + 1) * frame.x_scale * frame.x_scale;
      const double value = chebyshev_sum(at_u, 2 * square / (x_scale_ * x_scale_) - 1);
      chebyshev(u, terms(), of_u.data());
      for (std::size_t m = 0; m < terms(); ++m)
        of_m[m] += (m == 0 ? 1 : 2) / static_cast<double>(terms()) * value * of_u[m];
    }
    chebyshev(v, order, of_v.data());
    double* to = moved.coefficients_.data();
    for (std::size_t m = 0; m < terms(); ++m)
      for (std::size_t n = 0; n + 2 * m < order; ++n)
        *to++ += (n == 0 ? 1 : 2) / static_cast<double>(order) * of_m[m] * of_v[n];
  }
  return moved;
}

ChebyshevSurface ChebyshevSurface::blend(std::span<const ChebyshevSurface> surfaces,
                                         std::span<const double> weights) {
  ChebyshevSurface sum;
  for (const ChebyshevSurface& surface : surfaces) sum.degree_ = std::max(sum.degree_, surface.degree_);
  sum.coefficients_.assign(unknowns(sum.degree_), 0.0);
  sum.x_scale_ = sum.y_scale_ = 0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const ChebyshevSurface& surface = surfaces[i];
    sum.x_scale_ += weights[i] * surface.x_scale_;
    sum.y_middle_ += weights[i] * surface.y_middle_;
    sum.y_scale_ += weights[i] * surface.y_scale_;
    sum.rms_residual_ = std::max(sum.rms_residual_, surface.rms_residual_);
    sum.max_residual_ = std::max(sum.max_residual_, surface.max_residual_);
    const double* from = surface.coefficients_.data();
    double* to = sum.coefficients_.data();
    for (std::size_t m = 0; m < surface.terms(); ++m, to += sum.degree_ - surface.degree_)
      for (int n = 0; n + 2 * static_cast<int>(m) <= surface.degree_; ++n) *to++ += weights[i] * *from++;
  }
  return sum;
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
