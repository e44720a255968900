// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_spread_model.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double b = 1;  // pixels: scale of the closed-form part

constexpr double usual_tail_spread_px = 0.06;

/// Least weight of the roughness, for samples without noise.
constexpr double least_smoothing = 1e-12;
/// Third differences of the coefficients of a sharp edge with knots a quarter of a pixel apart, over the
/// step.
constexpr double edge_roughness = 0.1;
/// Greatest weight of the roughness far from the edge, over that at the edge.
constexpr double most_weight = 1e8;

/// Values and slopes [1/knot] of the six quintic cardinal B-splines that cover an interval between knots, at
/// a share 0 ≤ t < 1 of it.
void quintic(double t, double* values, double* slopes) {
  const double u = 1 - t;
  const auto p4 = [](double x) { return x * x * x * x; };
  // Σ_k (−1)^k C(6, k) (x − k)^5/120 from either end.
  const double u0 = p4(u), u1 = p4(u + 1), u2 = p4(u + 2), t0 = p4(t), t1 = p4(t + 1), t2 = p4(t + 2);
  const double v0 = u * u0, v1 = (u + 1) * u1, v2 = (u + 2) * u2;
  const double w0 = t * t0, w1 = (t + 1) * t1, w2 = (t + 2) * t2;
  values[0] = v0 / 120;
  values[1] = (v1 - 6 * v0) / 120;
  values[2] = (v2 - 6 * v1 + 15 * v0) / 120;
  values[3] = (w2 - 6 * w1 + 15 * w0) / 120;
  values[4] = (w1 - 6 * w0) / 120;
  values[5] = w0 / 120;
  slopes[0] = -u0 / 24;
  slopes[1] = -(u1 - 6 * u0) / 24;
  slopes[2] = -(u2 - 6 * u1 + 15 * u0) / 24;
  slopes[3] = (t2 - 6 * t1 + 15 * t0) / 24;
  slopes[4] = (t1 - 6 * t0) / 24;
  slopes[5] = t0 / 24;
}

double knot_sinc(double x) {
  return x == 0 ? 1 : std::sin(pi * x) / (pi * x);
}

/// What the samples leave of the normal equations once a smoothing is chosen.
struct Solved {
  double criterion = HUGE_VAL;  ///< −2 log of the restricted likelihood, but for a constant
  Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> llt;
  Eigen::VectorXd solution;
};

}  // namespace

EdgeSpreadModel::Row EdgeSpreadModel::row_of(const EdgePoint& point) const {
  Row row;
  const double d = point.distance, q = 1 / (d * d + b * b);
  row.values[0] = 1;
  row.values[1] = 0.5 + std::atan(d / b) / pi + 0.5 * b / pi * point.missing;
  row.values[2] = -d * q + 0.5 * point.missing;
  row.values[3] = -d * q * q;
  row.fixed = fixed();
  if (options_.varying_light) {
    row.values[4] = point.light * point.along;
    row.values[5] = point.light * d / options_.core_px;
  }
  // Knots lie at −core + i·knot; spline j covers the six intervals from knot j on.
  const double at = (d + options_.core_px) / options_.knot_px, cell = std::floor(at);
  if (!(cell >= 0) || cell >= splines_ + support - 1) return row;
  double all[support], slopes[support];
  quintic(at - cell, all, slopes);
  const int first = static_cast<int>(cell) - (support - 1);
  const int from = std::max(0, -first), to = std::min(support, splines_ - first);
  row.first = row.fixed + first + from;
  for (int i = from; i < to; ++i) row.values[row.fixed + row.splines++] = all[i];
  return row;
}

EdgeSpreadModel::ValueAndSlope EdgeSpreadModel::evaluate(double d) const {
  const double q = 1 / (d * d + b * b), dq = d * q;
  ValueAndSlope at;
  at.value = coefficients_[0] + coefficients_[1] * (0.5 + std::atan(d / b) / pi) - coefficients_[2] * dq -
             coefficients_[3] * dq * q;
  at.slope = coefficients_[1] * b * q / pi - coefficients_[2] * (q - 2 * dq * dq) -
             coefficients_[3] * q * (q - 4 * dq * dq);
  const double place = (d + options_.core_px) / options_.knot_px, cell = std::floor(place);
  if (!(cell >= 0) || cell >= splines_ + support - 1) return at;
  double values[support], slopes[support];
  quintic(place - cell, values, slopes);
  const int first = static_cast<int>(cell) - (support - 1);
  for (int i = std::max(0, -first); i < std::min(support, splines_ - first); ++i) {
    const double coefficient = coefficients_[fixed() + first + i];
    at.value += coefficient * values[i];
    at.slope += coefficient * slopes[i] / options_.knot_px;
  }
  return at;
}

void EdgeSpreadModel::add_priors(Eigen::MatrixXd& normal, double step_guess) const {
  // In units of the noise: the first tail is about the usual one, the second below it at twice the blur.
  const double noise = std::max(options_.noise, 1e-7 * step_guess);
  const double weight1 = noise / (usual_tail_spread_px * step_guess);
  const double offset = b / pi - usual_tail_px;
  normal(1, 1) += weight1 * weight1 * offset * offset;
  normal(2, 1) += weight1 * weight1 * offset;
  normal(2, 2) += weight1 * weight1;
  const double weight3 =
      noise / (usual_tail_spread_px * step_guess * 4 * options_.blur_px * options_.blur_px);
  normal(3, 3) += weight3 * weight3;
}

Eigen::MatrixXd EdgeSpreadModel::roughness() const {
  const int n = fixed() + splines_;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (int j = 0; j + 3 < splines_; ++j) {
    // A line spread that falls as 1/d² has curvature that falls as 1/d⁴.
    const double d = (j + 1.5 - 0.5 * (splines_ - 1)) * options_.knot_px / options_.blur_px;
    const double weight = std::min(std::pow(1 + d * d, 4), most_weight);
    constexpr double difference[4] = {-1, 3, -3, 1};
    for (int p = 0; p < 4; ++p)
      for (int q = 0; q <= p; ++q)
        matrix(fixed() + j + p, fixed() + j + q) += weight * difference[p] * difference[q];
  }
  return matrix;
}

EdgeSpreadModel::EdgeSpreadModel(std::span<const EdgePoint> points, const EdgeSpreadOptions& options)
    : options_(options) {
  splines_ = std::max(0, static_cast<int>(2 * options.core_px / options.knot_px) - (support - 1));
  options_.core_px = 0.5 * options.knot_px * (splines_ + support - 1);
  const int n = fixed() + splines_;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  double low = points.empty() ? 0 : points[0].value, high = low, square = 0;
  for (const EdgePoint& point : points) {
    low = std::min(low, point.value), high = std::max(high, point.value);
    square += point.value * point.value;
    const Row row = row_of(point);
    // Column by column below the diagonal: the unknowns rise.
    for (int j = 0; j < row.size(); ++j) {
      const double value = row.values[j];
      double* column = normal.data() + static_cast<std::ptrdiff_t>(row.unknown(j)) * n;
      right[row.unknown(j)] += value * point.value;
      for (int i = j; i < row.size(); ++i) column[row.unknown(i)] += value * row.values[i];
    }
  }
  data_normal_ = normal;
  add_priors(normal, high - low);
  const double unit = static_cast<double>(points.size()) * options.knot_px / (2 * options_.core_px);
  const Eigen::MatrixXd penalty = unit * roughness();
  const double rank = std::max(0, splines_ - 3), unpenalised = n - rank;
  const auto solve = [&](double smoothing) {
    Solved solved{HUGE_VAL, Eigen::LLT<Eigen::MatrixXd, Eigen::Lower>(normal + smoothing * penalty), {}};
    if (solved.llt.info() != Eigen::Success || !right.allFinite())
      throw InputError("the pixels do not determine the edge's profile; a larger ROI is needed");
    solved.solution = solved.llt.solve(right);
    const double rest = std::max(square - right.dot(solved.solution), 1e-14 * square);
    const double log_determinant = 2 * solved.llt.matrixLLT().diagonal().array().log().sum();
    solved.criterion = (static_cast<double>(points.size()) - unpenalised) * std::log(rest) + log_determinant -
                       rank * std::log(smoothing);
    return solved;
  };
  Solved best;
  if (options_.smoothing < 0) {
    // The evidence may not call a profile smoother than edges are.
    const double roughness =
        edge_roughness * std::pow(options_.knot_px / (0.25 * options_.blur_px), 3) * (high - low);
    const double most = std::max(least_smoothing, std::pow(options_.noise / roughness, 2) / unit);
    constexpr double factor = 4;
    const double from = std::max(least_smoothing, 1e-6 * most);
    for (double smoothing = from; smoothing < factor * most; smoothing *= factor)
      if (Solved solved = solve(std::min(smoothing, most)); solved.criterion < best.criterion) {
        best = std::move(solved);
        options_.smoothing = std::min(smoothing, most);
      }
  } else {
    options_.smoothing = std::max(options_.smoothing, least_smoothing);
    best = solve(options_.smoothing);
  }
  priors_ = normal - data_normal_ + options_.smoothing * penalty;
  coefficients_ = best.solution;
  factor_ = best.llt.matrixL();
  dark_ = coefficients_[0];
  step_ = coefficients_[1];
}

double EdgeSpreadModel::tail_px() const {
  return b / pi + coefficients_[2] / step_;
}

double EdgeSpreadModel::variation(const EdgePoint& point) const {
  const double missing = 0.5 * (b / pi * coefficients_[1] + coefficients_[2]) * point.missing;
  if (!options_.varying_light) return missing;
  return missing + point.light * (coefficients_[4] * point.along +
                                  coefficients_[5] * point.distance / options_.core_px);
}

EdgeSpreadModel::Variation EdgeSpreadModel::variation_over(double reach_px, double noise) const {
  Variation result;
  if (!options_.varying_light) return result;
  for (int k = 0; k < light_terms; ++k) {
    Eigen::VectorXd unit = Eigen::VectorXd::Zero(coefficients_.size());
    unit[closed_forms + k] = 1;
    factor_.triangularView<Eigen::Lower>().solveInPlace(unit);
    const double coefficient = std::abs(coefficients_[closed_forms + k]);
    const double reach = k % 2 == 0 ? 1 : reach_px / options_.core_px;
    result.significance = std::max(result.significance, coefficient / std::max(1e-300, noise * unit.norm()));
    result.share = std::max(result.share, coefficient * reach / std::abs(step_));
  }
  return result;
}

double EdgeSpreadModel::unknowns() const {
  // tr(N⁻¹ N_data) = ‖L⁻¹ L_data‖², by N_data = Σ row rowᵀ without its roots: the trace of L⁻¹ N_data L⁻ᵀ.
  Eigen::MatrixXd share = data_normal_.selfadjointView<Eigen::Lower>();
  factor_.triangularView<Eigen::Lower>().solveInPlace(share);
  share.transposeInPlace();
  factor_.triangularView<Eigen::Lower>().solveInPlace(share);
  return share.trace();
}

Eigen::VectorXcd EdgeSpreadModel::transform_row(double f) const {
  const double fade = std::exp(-2 * pi * b * std::abs(f));
  Eigen::VectorXcd row = Eigen::VectorXcd::Zero(coefficients_.size());
  row[1] = fade;
  row[2] = -2 * pi * pi * std::abs(f) * fade;
  row[3] = -2 * pi * pi * pi / b * f * f * fade;
  const double window = std::pow(knot_sinc(f * options_.knot_px), support) * options_.knot_px;
  const std::complex<double> turn = std::polar(1.0, -2 * pi * f * options_.knot_px);
  std::complex<double> phase = std::complex<double>(0, 2 * pi * f) * window *
                               std::polar(1.0, pi * f * (splines_ - 1) * options_.knot_px);
  for (int j = 0; j < splines_; ++j, phase *= turn) row[fixed() + j] = phase;
  return row;
}

std::complex<double> EdgeSpreadModel::transform(double f) const {
  return (transform_row(f).array() * coefficients_.array()).sum() / step_;
}

EdgeSpreadModel::Deviation::Deviation(const EdgeSpreadModel& model, std::span<const EdgePoint> points,
                                      std::span<const double> variance, const QuantisationNoise& rounding)
    : model_(model) {
  const Eigen::Index n = model.coefficients_.size();
  spread_ = Eigen::MatrixXd::Zero(n, n);
  double mean = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Row row = model.row_of(points[i]);
    mean += variance[i] / static_cast<double>(points.size());
    for (int j = 0; j < row.size(); ++j) {
      const double value = variance[i] * row.values[j];
      double* column = spread_.data() + static_cast<std::ptrdiff_t>(row.unknown(j)) * n;
      for (int k = j; k < row.size(); ++k) column[row.unknown(k)] += value * row.values[k];
    }
  }
  // What the priors say of the profile is as uncertain as they are weak.
  spread_.triangularView<Eigen::Lower>() += mean * model.priors_;
  rounding.add_spread(
      [&](std::size_t i, const std::function<void(int, double)>& entry) {
        const Row row = model.row_of(points[i]);
        for (int j = 0; j < row.size(); ++j) entry(row.unknown(j), row.values[j]);
      },
      spread_);
  spread_ = spread_.selfadjointView<Eigen::Lower>();
}

double EdgeSpreadModel::Deviation::of_modulus(double f) const {
  const Eigen::VectorXcd row = model_.transform_row(f);
  const std::complex<double> value = (row.array() * model_.coefficients_.array()).sum() / model_.step_;
  const double modulus = std::abs(value);
  const std::complex<double> turn = modulus > 0 ? std::conj(value) / modulus : 1;
  Eigen::VectorXd gradient = (turn * row).real() / model_.step_;
  gradient[1] -= modulus / model_.step_;
  model_.factor_.triangularView<Eigen::Lower>().solveInPlace(gradient);
  model_.factor_.transpose().triangularView<Eigen::Upper>().solveInPlace(gradient);
  return std::sqrt(std::max(0.0, gradient.dot(spread_ * gradient)));
}

}  // namespace petzval
