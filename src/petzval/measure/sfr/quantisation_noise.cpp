// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/measure/sfr/quantisation_noise.h>

#include <algorithm>
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
    const double first_harmonic = std::exp(-2 * pi * pi * noise2);
    // What is left makes less than 1e-11 of the variance of some thousand pixels.
    if (constexpr double negligible = 1e-7; first_harmonic < negligible) continue;
    const double x = (static_cast<double>(index) + 0.5) / cells_a_step;
    Cell cell;
    cell.window = static_cast<int>(std::floor(x));
    // Half cosines, whose squares sum to 1.
    cell.lower = std::cos(0.5 * pi * (x - cell.window));
    cell.upper = std::sin(0.5 * pi * (x - cell.window));
    const std::complex<double> once = std::polar(1.0, 2 * pi * x);
    std::complex<double> turn = std::sqrt(0.5 * scale) / pi;
    for (int k = 1; k <= harmonics; ++k) {
      turn *= once;
      const double amplitude = std::exp(-2 * pi * pi * k * k * noise2) / k;
      cell.turn.segment<2>(2 * (k - 1)) << amplitude * turn.real(), amplitude * turn.imag();
    }
    cells_.push_back(cell);
    samples_.push_back(std::move(samples));
  }
}

/// For each harmonic, the sum of rows, most of whose entries are zero.
class QuantisationNoise::SparseSums {
 public:
  explicit SparseSums(std::size_t size) : sums_(size, Harmonics::Zero()), used_(size) {}
  bool empty() const { return touched_.empty(); }
  void add(std::size_t i, double value, const Harmonics& turn) {
    if (!used_[i]) {
      used_[i] = true;
      touched_.push_back(i);
    }
    sums_[i] += value * turn;
  }
  /// Adds the products of all pairs, and begins anew.
  void close(Eigen::MatrixXd& covariance) {
    for (const std::size_t i : touched_)
      for (const std::size_t j : touched_)
        if (j <= i)
          covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) +=
              (sums_[i] * sums_[j]).sum();
    for (const std::size_t i : touched_) {
      used_[i] = false;
      sums_[i].setZero();
    }
    touched_.clear();
  }

 private:
  std::vector<Harmonics> sums_;
  std::vector<bool> used_;
  std::vector<std::size_t> touched_;
};

void QuantisationNoise::add_spread(const AddRow& add_row, Eigen::MatrixXd& covariance) const {
  if (cells_.empty()) return;
  const auto size = static_cast<std::size_t>(covariance.rows());
  SparseSums here(size), next(size);
  int window = cells_.front().window;
  const auto close_one = [&] {
    here.close(covariance);
    std::swap(here, next);
    ++window;
  };
  std::vector<double> sum(size);
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const Cell& cell = cells_[c];
    // Between values that lie far apart there is nothing.
    while (window < cell.window) {
      if (here.empty() && next.empty()) window = cell.window - 1;
      close_one();
    }
    std::ranges::fill(sum, 0.0);
    for (const std::size_t i : samples_[c]) add_row(i, step_[i], sum.data());
    for (std::size_t j = 0; j < size; ++j) {
      if (sum[j] == 0) continue;
      here.add(j, cell.lower * sum[j], cell.turn);
      next.add(j, cell.upper * sum[j], cell.turn);
    }
  }
  close_one();
  close_one();
}

}  // namespace petzval
