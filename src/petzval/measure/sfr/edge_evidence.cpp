// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/edge_evidence.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace petzval {

namespace {

constexpr std::size_t highest_order = 5;
/// Light without an edge: a slope, then profiles across of ever higher order, then all that is as smooth.
constexpr std::array smooth_terms{3, 4, 5, 6, 7, 9, 12, 16, 21};
using SmoothRow = Eigen::Matrix<double, 1, smooth_terms.back()>;

/// Products of Chebyshev polynomials of places across and along.
SmoothRow smooth_row(double across, double along) {
  std::array<double, highest_order + 1> d{1, across}, t{1, along};
  for (std::size_t i = 2; i <= highest_order; ++i)
    d[i] = 2 * across * d[i - 1] - d[i - 2], t[i] = 2 * along * t[i - 1] - t[i - 2];
  SmoothRow row;
  row.head<smooth_terms.front()>() << 1, across, along;
  Eigen::Index term = smooth_terms.front();
  for (std::size_t order = 2; order <= highest_order; ++order) row[term++] = d[order];
  for (std::size_t order = 2; order <= highest_order; ++order)
    for (std::size_t i = 0; i < order; ++i) row[term++] = d[i] * t[order - i];
  return row;
}

/// Residuals in the box about them, zero where there are none.
struct ResidualBox {
  std::size_t columns = 0, rows = 0;
  std::vector<double> values;

  /// 1 + 2 Σ ρ over shifts by whole multiples of `columns_apart` and `rows_apart`.
  double autocorrelation_time(std::size_t columns_apart, std::size_t rows_apart) const {
    const double square = sum_at(0, 0);
    double time = 1;
    for (std::size_t lag = 1; lag * columns_apart < columns && lag * rows_apart < rows; ++lag) {
      const double sum = sum_at(lag * columns_apart, lag * rows_apart);
      if (!(sum > 0)) break;
      time += 2 * sum / square;
    }
    return time;
  }

 private:
  double sum_at(std::size_t right, std::size_t down) const {
    double sum = 0;
    for (std::size_t row = 0; row + down < rows; ++row) {
      using Part = Eigen::Map<const Eigen::VectorXd>;
      const double* const start = values.data() + row * columns;
      const auto length = static_cast<Eigen::Index>(columns - right);
      sum += Part(start, length).dot(Part(start + down * columns + right, length));
    }
    return sum;
  }
};

}  // namespace

double independent_samples(std::span<const EdgeSample> residuals, int spacing) {
  int left = std::numeric_limits<int>::max(), top = left, right = 0, bottom = 0;
  for (const EdgeSample& r : residuals) {
    const int x = static_cast<int>(r.x), y = static_cast<int>(r.y);
    left = std::min(left, x), right = std::max(right, x), top = std::min(top, y),
    bottom = std::max(bottom, y);
  }
  ResidualBox box{static_cast<std::size_t>(right - left) + 1, static_cast<std::size_t>(bottom - top) + 1, {}};
  box.values.resize(box.columns * box.rows);
  for (const EdgeSample& r : residuals)
    box.values[static_cast<std::size_t>(static_cast<int>(r.y) - top) * box.columns +
               static_cast<std::size_t>(static_cast<int>(r.x) - left)] = r.value;
  const auto apart = static_cast<std::size_t>(spacing);
  return static_cast<double>(residuals.size()) /
         (box.autocorrelation_time(apart, 0) * box.autocorrelation_time(0, apart));
}

double edge_evidence(const EdgeProfile& profile, const std::vector<EdgeSample>& samples, int spacing,
                     double unknowns, double enough) {
  const std::size_t size = profile.points.size();
  std::vector<EdgeSample> residuals(size);
  for (std::size_t i = 0; i < size; ++i) {
    residuals[i] = samples[profile.sample[i]];
    residuals[i].value = profile.points[i].value - profile.fitted[i].value - profile.variation[i];
  }
  const double independent = independent_samples(residuals, spacing) / static_cast<double>(size);
  const double middle = 0.5 * (profile.low + profile.high), half = 0.5 * (profile.high - profile.low);

  const auto evidence_of_every = [&](std::size_t stride) {
    const std::size_t count = (size + stride - 1) / stride;
    Eigen::MatrixXd rows(count, SmoothRow::ColsAtCompileTime);
    Eigen::VectorXd values(count);
    double edge_square = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const EdgePoint& point = profile.points[i * stride];
      const auto at = static_cast<Eigen::Index>(i);
      rows.row(at) = smooth_row((point.distance - middle) / half, point.along);
      values[at] = point.value - profile.fitted.front().value;
      edge_square += residuals[i * stride].value * residuals[i * stride].value;
    }
    // A little more on the diagonal, where samples in few rows cannot tell all terms apart.
    Eigen::MatrixXd normal = rows.transpose() * rows;
    normal.diagonal().array() += 1e-12 * static_cast<double>(count);
    const Eigen::LLT<Eigen::MatrixXd> factor(normal);
    const Eigen::VectorXd explained = factor.matrixL().solve(rows.transpose() * values);
    const double n = independent * static_cast<double>(count), per_unknown = std::log(std::max(1.0, n));
    const double settled = std::min(unknowns, n);  // no more than there are independent samples
    double least = HUGE_VAL;
    for (const int terms : smooth_terms) {
      const double square = values.squaredNorm() - explained.head(terms).squaredNorm();
      least = std::min(least, n * std::log(square / edge_square) + (terms - settled) * per_unknown);
    }
    return least;
  };

  // Some hundred samples are enough where they say several times what is needed, as of edges without noise.
  constexpr std::size_t fewest = 120, few = 500;
  constexpr double plainly = 4;
  if (const std::size_t stride = size / fewest; stride > 1)
    if (const double evidence = evidence_of_every(stride); evidence > plainly * enough) return evidence;
  if (const std::size_t stride = size / few; stride > 1)
    if (const double evidence = evidence_of_every(stride); evidence > enough) return evidence;
  return evidence_of_every(1);
}

}  // namespace petzval
