// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_spread_model.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double b = 1;  // pixels: scale of the closed-form part

constexpr double usual_tail_spread_px = 0.06;

/// Third differences of the splines' coefficients count this much against the data.
constexpr double smoothness = 1e-10;

/// The quintic cardinal B-spline pieces at offset 0 ≤ t < 1: values of the six splines that cover it, and
/// slopes.
void quintic(double t, double* values) {
  const double u = 1 - t;
  const auto p5 = [](double x) { return x * x * x * x * x; };
  // Σ_k (−1)^k C(6, k) (x − k)^5/120 from either end.
  values[0] = p5(u) / 120;
  values[1] = (p5(u + 1) - 6 * p5(u)) / 120;
  values[2] = (p5(u + 2) - 6 * p5(u + 1) + 15 * p5(u)) / 120;
  values[3] = (p5(t + 2) - 6 * p5(t + 1) + 15 * p5(t)) / 120;
  values[4] = (p5(t + 1) - 6 * p5(t)) / 120;
  values[5] = p5(t) / 120;
}

double knot_sinc(double x) {
  return x == 0 ? 1 : std::sin(pi * x) / (pi * x);
}

}  // namespace

int EdgeSpreadModel::spline_values(double distance, double* values) const {
  // Knots lie at −core + i·knot; spline j covers the six intervals from knot j on.
  const double at = (distance + options_.core_px) / options_.knot_px;
  const double cell = std::floor(at);
  if (!(cell >= 0) || cell >= splines_ + support - 1) return -support;
  double all[support];
  quintic(at - cell, all);
  const int first = static_cast<int>(cell) - (support - 1);
  for (int i = 0; i < support; ++i) values[i] = first + i >= 0 && first + i < splines_ ? all[i] : 0;
  return first;
}

void EdgeSpreadModel::fixed_values(double d, double* values) const {
  const double q = 1 / (d * d + b * b);
  values[0] = 1;
  values[1] = 0.5 + std::atan(d / b) / pi;
  values[2] = -d * q;
  values[3] = -d * q * q;
}

EdgeSpreadModel::EdgeSpreadModel(std::span<const EdgePoint> points, const EdgeSpreadOptions& options)
    : options_(options) {
  splines_ = std::max(0, static_cast<int>(2 * options.core_px / options.knot_px) - (support - 1));
  options_.core_px = 0.5 * options.knot_px * (splines_ + support - 1);
  const int n = fixed + splines_;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  double low = points.empty() ? 0 : points[0].value, high = low;
  for (const EdgePoint& point : points) {
    low = std::min(low, point.value), high = std::max(high, point.value);
    double row[fixed + support];
    fixed_values(point.distance, row);
    const int first = spline_values(point.distance, row + fixed);
    int index[fixed + support] = {0, 1, 2, 3};
    int count = fixed;
    for (int i = 0; i < support && first > -support; ++i)
      if (first + i >= 0 && first + i < splines_ && splines_ > 0) {
        index[count] = fixed + first + i;
        row[count++] = row[fixed + i];
      }
    for (int i = 0; i < count; ++i) {
      right[index[i]] += row[i] * point.value;
      for (int j = 0; j <= i; ++j)
        normal(std::max(index[i], index[j]), std::min(index[i], index[j])) += row[i] * row[j];
    }
  }
  // Priors, in units of the noise: the first tail is about the usual one, the second below it at twice the
  // blur.
  const double step_guess = high - low;
  const double noise = std::max(options.noise, 1e-7 * step_guess);
  const double weight1 = noise / (usual_tail_spread_px * step_guess);
  const double offset = b / pi - usual_tail_px;
  normal(1, 1) += weight1 * weight1 * offset * offset;
  normal(2, 1) += weight1 * weight1 * offset;
  normal(2, 2) += weight1 * weight1;
  const double weight3 = noise / (usual_tail_spread_px * step_guess * 4 * options.blur_px * options.blur_px);
  normal(3, 3) += weight3 * weight3;
  const double penalty =
      smoothness * static_cast<double>(points.size()) * options.knot_px / (2 * options_.core_px);
  for (int j = 0; j + 3 < splines_; ++j) {
    constexpr double difference[4] = {-1, 3, -3, 1};
    for (int p = 0; p < 4; ++p)
      for (int q = 0; q <= p; ++q)
        normal(fixed + j + p, fixed + j + q) += penalty * difference[p] * difference[q];
  }
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> llt(normal);
  if (llt.info() != Eigen::Success || !right.allFinite())
    throw InputError("the pixels do not determine the edge's profile; a larger ROI is needed");
  const Eigen::VectorXd solution = llt.solve(right);
  coefficients_.assign(solution.data(), solution.data() + n);
  const Eigen::MatrixXd factor = llt.matrixL();
  factor_.assign(factor.data(), factor.data() + factor.size());
  dark_ = coefficients_[0];
  step_ = coefficients_[1];
}

double EdgeSpreadModel::value(double d) const {
  double row[fixed + support];
  fixed_values(d, row);
  double sum = 0;
  for (int i = 0; i < fixed; ++i) sum += coefficients_[static_cast<std::size_t>(i)] * row[i];
  const int first = spline_values(d, row);
  for (int i = 0; i < support && first > -support; ++i)
    if (first + i >= 0 && first + i < splines_)
      sum += coefficients_[static_cast<std::size_t>(fixed + first + i)] * row[i];
  return sum;
}

double EdgeSpreadModel::slope(double d) const {
  // A central difference a fiftieth of a knot wide: 1e-8 of the slope, for drawing and for aligning the edge.
  const double h = options_.knot_px / 50;
  return (value(d + h) - value(d - h)) / (2 * h);
}

double EdgeSpreadModel::tail_px() const {
  return b / pi + coefficients_[2] / step_;
}

std::vector<std::complex<double>> EdgeSpreadModel::transform_row(double f) const {
  const double fade = std::exp(-2 * pi * b * std::abs(f));
  std::vector<std::complex<double>> row{0, fade, -2 * pi * pi * std::abs(f) * fade,
                                        -2 * pi * pi * pi / b * f * f * fade};
  const double window = std::pow(knot_sinc(f * options_.knot_px), support) * options_.knot_px;
  for (int j = 0; j < splines_; ++j) {
    const double centre = (j - 0.5 * (splines_ - 1)) * options_.knot_px;
    row.push_back(std::complex<double>(0, 2 * pi * f) * window * std::polar(1.0, -2 * pi * f * centre));
  }
  return row;
}

std::complex<double> EdgeSpreadModel::transform(double f) const {
  const std::vector<std::complex<double>> row = transform_row(f);
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < row.size(); ++i) sum += row[i] * coefficients_[i];
  return sum / step_;
}

std::vector<double> EdgeSpreadModel::modulus_deviation(std::span<const double> frequencies_cpp,
                                                       std::span<const EdgePoint> points,
                                                       std::span<const double> variance,
                                                       const QuantisationNoise& rounding) const {
  const auto n = static_cast<Eigen::Index>(coefficients_.size());
  const Eigen::Map<const Eigen::MatrixXd> factor(factor_.data(), n, n);
  std::vector<double> deviation;
  for (const double f : frequencies_cpp) {
    const std::vector<std::complex<double>> row = transform_row(f);
    const std::complex<double> value = transform(f);
    const double modulus = std::abs(value);
    const std::complex<double> turn = modulus > 0 ? std::conj(value) / modulus : 1;
    Eigen::VectorXd gradient(n);
    for (Eigen::Index i = 0; i < n; ++i)
      gradient[i] = std::real(turn * row[static_cast<std::size_t>(i)]) / step_;
    gradient[1] -= modulus / step_;
    factor.triangularView<Eigen::Lower>().solveInPlace(gradient);
    factor.transpose().triangularView<Eigen::Upper>().solveInPlace(gradient);
    double sum = 0;
    std::vector<double> influence(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      double values[fixed + support];
      fixed_values(points[i].distance, values);
      double change = 0;
      for (int k = 0; k < fixed; ++k) change += values[k] * gradient[k];
      const int first = spline_values(points[i].distance, values);
      for (int k = 0; k < support && first > -support; ++k)
        if (first + k >= 0 && first + k < splines_) change += values[k] * gradient[fixed + first + k];
      influence[i] = change;
      sum += variance[i] * change * change;
    }
    deviation.push_back(std::sqrt(sum + rounding.variance(influence)));
  }
  return deviation;
}

}  // namespace petzval
