// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/bordered_band.h>
#include <petzval/measure/sfr/bordered_lanes.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

constexpr int corner = BorderedBand::width + 1;  // where the border's entries of a column begin

/// How many entries a column has below the diagonal within the band.
int below(const BorderedBand& matrix, int column) {
  return std::min(BorderedBand::width, matrix.band() - 1 - column);
}

}  // namespace

BorderedBand::BorderedBand(int band, int border)
    : band_(band), border_(border), entries_(static_cast<std::size_t>(band + border) * stride()) {}

void BorderedBand::add(double factor, const BorderedBand& other) {
  for (std::size_t i = 0; i < entries_.size(); ++i) entries_[i] += factor * other.entries_[i];
}

std::array<double, BorderedBand::lanes> BorderedBand::quadratic(const Block& vectors) const {
  std::array<double, lanes> result;
  quadratic_of_eight({entries_.data(), band_, border_}, vectors.data(), result.data());
  return result;
}

BorderedCholesky::BorderedCholesky(BorderedBand matrix)
    : factor_(std::move(matrix)), per_diagonal_(static_cast<std::size_t>(factor_.size())) {
  good_ = factor_in_place(factor_.column(0), factor_.band(), factor_.border(), per_diagonal_.data());
}

double BorderedCholesky::log_determinant() const {
  constexpr int together = 4;  // of whose products a logarithm is taken
  double sum = 0;
  for (int first = 0; first < factor_.size(); first += together) {
    double product = 1;
    for (int j = first; j < std::min(first + together, factor_.size()); ++j) product *= factor_.at(j, j);
    sum += std::log(product);
  }
  return 2 * sum;
}

template <int count>
void BorderedCholesky::solve_lower(double* x) const {
  using Lanes = Eigen::Array<double, 1, count>;
  const int band = factor_.band(), border = factor_.border(), size = factor_.size();
  const auto row = [&](int i) { return Eigen::Map<Lanes>(x + static_cast<std::ptrdiff_t>(i) * count); };
  for (int j = 0; j < size; ++j) {
    const double* const l = factor_.column(j);
    const Lanes value = row(j) * per_diagonal_[static_cast<std::size_t>(j)];
    row(j) = value;
    if (j < band)
      for (int p = 1; p <= below(factor_, j); ++p) row(j + p) -= l[p] * value;
    for (int r = std::max(0, j - band + 1); r < border; ++r) row(band + r) -= l[corner + r] * value;
  }
}

template <int count>
void BorderedCholesky::solve_upper(double* x) const {
  using Lanes = Eigen::Array<double, 1, count>;
  const int band = factor_.band(), border = factor_.border(), size = factor_.size();
  const auto row = [&](int i) { return Eigen::Map<Lanes>(x + static_cast<std::ptrdiff_t>(i) * count); };
  for (int j = size - 1; j >= 0; --j) {
    const double* const l = factor_.column(j);
    Lanes value = row(j);
    for (int r = std::max(0, j - band + 1); r < border; ++r) value -= l[corner + r] * row(band + r);
    if (j < band)
      for (int p = below(factor_, j); p > 0; --p) value -= l[p] * row(j + p);
    row(j) = value * per_diagonal_[static_cast<std::size_t>(j)];
  }
}

template <int count>
void BorderedCholesky::solve_lanes(double* x) const {
  if constexpr (count == BorderedBand::lanes) {
    solve_eight({factor_.column(0), factor_.band(), factor_.border()}, per_diagonal_.data(), x);
  } else {
    solve_lower<count>(x);
    solve_upper<count>(x);
  }
}

template void BorderedCholesky::solve_lanes<2>(double*) const;
template void BorderedCholesky::solve_lanes<4>(double*) const;
template void BorderedCholesky::solve_lanes<BorderedBand::lanes>(double*) const;

Eigen::VectorXd BorderedCholesky::solve_lower(const Eigen::VectorXd& right) const {
  Eigen::VectorXd x = right;
  solve_lower<1>(x.data());
  return x;
}

Eigen::VectorXd BorderedCholesky::solve_upper(const Eigen::VectorXd& halfway) const {
  Eigen::VectorXd x = halfway;
  solve_upper<1>(x.data());
  return x;
}

BorderedBand BorderedCholesky::inverse() const {
  BorderedBand z(factor_.band(), factor_.border());
  invert({factor_.column(0), factor_.band(), factor_.border()}, per_diagonal_.data(), z.column(0));
  return z;
}

double trace_of_product(const BorderedBand& a, const BorderedBand& b) {
  double diagonal = 0, beside = 0;
  const int band = a.band(), border = a.border();
  for (int j = 0; j < a.size(); ++j) {
    diagonal += a.at(j, j) * b.at(j, j);
    for (int p = 1; j < band && p <= below(a, j); ++p) beside += a.at(j + p, j) * b.at(j + p, j);
    for (int r = std::max(0, j - band + 1); r < border; ++r) beside += a.at(band + r, j) * b.at(band + r, j);
  }
  return diagonal + 2 * beside;
}

}  // namespace petzval
