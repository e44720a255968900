// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/measure/sfr/quantisation_noise.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <utility>
#include <vector>

namespace petzval {

QuantisationNoise::QuantisationNoise(std::span<const double> levels, std::span<const double> values,
                                     std::span<const double> variance) {
  if (levels.size() < 2) return;
  constexpr double cells_a_step = 16;
  // The harmonics that are left out carry a part of the 1/12 that all have together.
  double carried = 0;
  for (int k = 1; k <= harmonics; ++k) carried += 1.0 / (k * k);
  const double scale = pi * pi / 6 / carried;
  std::vector<double> place;
  std::map<long, std::vector<std::size_t>> samples_by_cell;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto above = std::upper_bound(levels.begin() + 1, levels.end() - 1, values[i]);
    const double low = *(above - 1), step = *above - low;
    // Beyond the ends the steps go on.
    place.push_back(static_cast<double>(above - 1 - levels.begin()) + (values[i] - low) / step);
    step_.push_back(step);
    samples_by_cell[std::lround(std::floor(place.back() * cells_a_step))].push_back(i);
  }
  for (auto& [index, samples] : samples_by_cell) {
    double noise2 = 0;  // in steps
    for (const std::size_t i : samples)
      noise2 +=
          std::max(0.0, variance[i] / (step_[i] * step_[i]) - 1.0 / 12) / static_cast<double>(samples.size());
    const double x = (static_cast<double>(index) + 0.5) / cells_a_step;
    Cell cell;
    cell.window = static_cast<int>(std::floor(x));
    // Half cosines, whose squares sum to 1.
    cell.lower = std::cos(0.5 * pi * (x - cell.window));
    cell.upper = std::sin(0.5 * pi * (x - cell.window));
    for (int k = 1; k <= harmonics; ++k)
      cell.turn[k - 1] = std::polar(
          std::sqrt(0.5 * scale) / (pi * k) * std::exp(-2 * pi * pi * k * k * noise2), 2 * pi * k * x);
    cells_.push_back(cell);
    samples_.push_back(std::move(samples));
  }
}

namespace {

/// For each harmonic, the sum of rows, most of whose entries are zero.
template <int harmonics>
class SparseSums {
 public:
  explicit SparseSums(Eigen::Index size) : used_(static_cast<std::size_t>(size)) {
    for (auto& sum : sums_) sum.resize(static_cast<std::size_t>(size));
  }
  bool empty() const { return touched_.empty(); }
  void add(std::size_t i, double value, double share, const std::complex<double>* turn) {
    if (!used_[i]) {
      used_[i] = true;
      touched_.push_back(i);
    }
    for (int k = 0; k < harmonics; ++k) sums_[k][i] += share * value * turn[k];
  }
  /// Adds the products of all pairs, and begins anew.
  void close(Eigen::MatrixXd& covariance) {
    for (const std::size_t i : touched_)
      for (const std::size_t j : touched_) {
        if (j > i) continue;
        double sum = 0;
        for (int k = 0; k < harmonics; ++k)
          sum += sums_[k][i].real() * sums_[k][j].real() + sums_[k][i].imag() * sums_[k][j].imag();
        covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) += sum;
      }
    for (const std::size_t i : touched_) {
      used_[i] = false;
      for (int k = 0; k < harmonics; ++k) sums_[k][i] = 0;
    }
    touched_.clear();
  }

 private:
  std::array<std::vector<std::complex<double>>, static_cast<std::size_t>(harmonics)> sums_;
  std::vector<bool> used_;
  std::vector<std::size_t> touched_;
};

}  // namespace

void QuantisationNoise::add_spread(const RowOf& row_of, Eigen::MatrixXd& covariance) const {
  if (cells_.empty()) return;
  SparseSums<harmonics> here(covariance.rows()), next(covariance.rows());
  int window = cells_.front().window;
  const auto close_one = [&] {
    here.close(covariance);
    std::swap(here, next);
    ++window;
  };
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    // Between values that lie far apart there is nothing.
    while (window < cells_[c].window) {
      if (here.empty() && next.empty()) window = cells_[c].window - 1;
      close_one();
    }
    for (const std::size_t i : samples_[c])
      row_of(i, [&](int unknown, double value) {
        const auto at = static_cast<std::size_t>(unknown);
        here.add(at, step_[i] * value, cells_[c].lower, cells_[c].turn);
        next.add(at, step_[i] * value, cells_[c].upper, cells_[c].turn);
      });
  }
  close_one();
  close_one();
}

}  // namespace petzval
