// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/measure/sfr/quantisation_noise.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <complex>
#include <cstdint>
#include <utility>
#include <vector>

namespace petzval {

namespace {

/// The first level above a value, or the last; from the second on. Most often levels are evenly spaced.
std::span<const double>::iterator next_level(std::span<const double> levels, double value) {
  const double steps = static_cast<double>(levels.size() - 1);
  const double guess = (value - levels.front()) / (levels.back() - levels.front()) * steps;
  const auto at = static_cast<std::size_t>(std::clamp(guess, 0.0, steps - 1)) + 1;
  if (levels[at - 1] <= value && value < levels[at]) return levels.begin() + static_cast<std::ptrdiff_t>(at);
  return std::upper_bound(levels.begin() + 1, levels.end() - 1, value);
}

/// What noise of this variance [steps²] leaves of the first harmonic.
double first_harmonic(double noise2) {
  return std::exp(-2 * pi * pi * noise2);
}

constexpr int cells_a_step = 16;

/// A sample and the cell that it lies in; by rising cells where numbers rise.
class SampleInCell {
 public:
  SampleInCell(double place, std::size_t sample)
      : number_(static_cast<std::uint64_t>(std::clamp(place * cells_a_step, -farthest, farthest) + farthest)
                    << sample_bits |
                sample) {}
  int cell() const { return static_cast<int>(number_ >> sample_bits) - static_cast<int>(farthest); }
  std::size_t sample() const { return number_ & ((std::uint64_t{1} << sample_bits) - 1); }
  auto operator<=>(const SampleInCell&) const = default;

 private:
  static constexpr double farthest = 0x1p30;
  static constexpr int sample_bits = 32;
  std::uint64_t number_;
};

/// What cells at the same place in their step have in common.
struct CellPart {
  double lower = 0, upper = 0;  ///< half cosines, whose squares sum to 1
  std::complex<double> once;    ///< exp(2πix)
};

std::array<CellPart, cells_a_step> cell_parts() {
  std::array<CellPart, cells_a_step> parts;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double x = (static_cast<double>(i) + 0.5) / cells_a_step;
    parts[i] = {std::cos(0.5 * pi * x), std::sin(0.5 * pi * x), std::polar(1.0, 2 * pi * x)};
  }
  return parts;
}

/// The most samples in a row of three steps, beyond which errors have nothing in common.
std::size_t most_together(std::span<const SampleInCell> sorted) {
  std::size_t most = 0, first = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    while (sorted[first].cell() + 3 * cells_a_step <= sorted[i].cell()) ++first;
    most = std::max(most, i + 1 - first);
  }
  return most;
}

/// Whether rounding can add half a per cent to a standard deviation that noise [steps²] has already, if every
/// error has something in common with so many: Σ_ij a_i a_j e_i e_j ≤ together · Σ a_i² e_i².
bool matters(const std::vector<double>& noise2, std::size_t together) {
  constexpr double negligible = 1e-2;  // of the variance
  const double least = std::ranges::min(noise2), left = first_harmonic(least);
  return static_cast<double>(together) * left * left / 12 > negligible * (least + 1.0 / 12);
}

}  // namespace

QuantisationNoise::QuantisationNoise(std::span<const double> levels, std::span<const double> values,
                                     std::span<const double> variance) {
  if (levels.size() < 2) return;
  // The harmonics that are left out carry a part of the 1/12 that all have together.
  double carried = 0;
  for (int k = 1; k <= harmonics; ++k) carried += 1.0 / (k * k);
  const double scale = pi * pi / 6 / carried;
  // What is left makes less than 1e-11 of the variance of some thousand pixels.
  constexpr double negligible = 1e-7;
  std::vector<SampleInCell> by_cell;
  std::vector<double> noise2;  // of each sample [steps²]
  by_cell.reserve(values.size()), step_.reserve(values.size()), noise2.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto above = next_level(levels, values[i]);
    const double low = *(above - 1), step = *above - low;
    // Beyond the ends the steps go on.
    const double place = static_cast<double>(above - 1 - levels.begin()) + (values[i] - low) / step;
    by_cell.emplace_back(place, i);
    step_.push_back(step);
    noise2.push_back(std::max(0.0, variance[i] / (step * step) - 1.0 / 12));
  }
  if (values.empty() || !matters(noise2, values.size())) return;
  std::ranges::sort(by_cell);
  if (!matters(noise2, most_together(by_cell))) return;
  static const std::array<CellPart, cells_a_step> parts = cell_parts();
  order_.reserve(by_cell.size());
  for (const SampleInCell& each : by_cell) order_.push_back(each.sample());
  for (std::size_t first = 0, last = 0; first < by_cell.size(); first = last) {
    const int index = by_cell[first].cell();
    double sum = 0;
    for (last = first; last < by_cell.size() && by_cell[last].cell() == index; ++last)
      sum += noise2[order_[last]];
    const double mean_noise2 = sum / static_cast<double>(last - first);
    const double left_of_first = first_harmonic(mean_noise2);
    if (left_of_first < negligible) continue;
    const double x = (static_cast<double>(index) + 0.5) / cells_a_step;
    Cell cell;
    cell.first = first, cell.count = last - first;
    cell.window = static_cast<int>(std::floor(x));
    const auto part = static_cast<std::size_t>(index - cells_a_step * cell.window);
    cell.lower = parts[part].lower, cell.upper = parts[part].upper;
    const std::complex<double> once = parts[part].once;
    std::complex<double> turn = std::sqrt(0.5 * scale) / pi;
    double left = 1, next = left_of_first;  // of harmonic k: that of the first to the power k²
    for (int k = 1; k <= harmonics; ++k) {
      turn *= once;
      left *= next, next *= left_of_first * left_of_first;
      cell.turn.segment<2>(2 * (k - 1)) << left / k * turn.real(), left / k * turn.imag();
    }
    cells_.push_back(cell);
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

bool QuantisationNoise::is_alone(std::size_t cell) const {
  const int window = cells_[cell].window;
  return (cell == 0 || cells_[cell - 1].window + 1 < window) &&
         (cell + 1 == cells_.size() || window + 1 < cells_[cell + 1].window);
}

void QuantisationNoise::add_rows(const Cell& cell, const AddRow& add_row, std::vector<double>& sum) const {
  std::ranges::fill(sum, 0.0);
  for (const std::size_t i : std::span(order_).subspan(cell.first, cell.count))
    add_row(i, step_[i], sum.data());
}

void QuantisationNoise::add_spread_of_one(const Cell& cell, const AddRow& add_row, std::vector<double>& sum,
                                          Eigen::MatrixXd& covariance) const {
  add_rows(cell, add_row, sum);
  const double variance = cell.turn.matrix().squaredNorm();
  for (std::size_t j = 0; j < sum.size(); ++j) {
    if (sum[j] == 0) continue;
    double* const column = covariance.col(static_cast<Eigen::Index>(j)).data();
    for (std::size_t i = j; i < sum.size(); ++i) column[i] += variance * sum[j] * sum[i];
  }
}

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
    if (is_alone(c)) {
      add_spread_of_one(cell, add_row, sum, covariance);
      continue;
    }
    // Between values that lie far apart there is nothing.
    while (window < cell.window) {
      if (here.empty() && next.empty()) window = cell.window - 1;
      close_one();
    }
    add_rows(cell, add_row, sum);
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
