// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/measure/sfr/quantisation_noise.h>

#include <algorithm>
#include <cmath>
#include <map>

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
  cell_of_.resize(values.size());
  for (const auto& [index, samples] : samples_by_cell) {
    double noise2 = 0;  // in steps
    for (const std::size_t i : samples) {
      cell_of_[i] = cells_.size();
      noise2 +=
          std::max(0.0, variance[i] / (step_[i] * step_[i]) - 1.0 / 12) / static_cast<double>(samples.size());
    }
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
  }
}

double QuantisationNoise::variance(std::span<const double> influence) const {
  if (cells_.empty()) return 0;
  std::vector<double> sum(cells_.size());
  for (std::size_t i = 0; i < influence.size(); ++i) sum[cell_of_[i]] += influence[i] * step_[i];
  double total = 0;
  std::complex<double> here[harmonics] = {}, next[harmonics] = {};
  int window = cells_.front().window;
  const auto close = [&](int to) {
    for (; window < to; ++window) {
      for (int k = 0; k < harmonics; ++k) {
        total += std::norm(here[k]);
        here[k] = next[k];
        next[k] = 0;
      }
      // Between values that lie far apart there is nothing.
      if (window + 3 < to) {
        for (int k = 0; k < harmonics; ++k) total += std::norm(here[k]), here[k] = 0;
        window = to - 1;
      }
    }
  };
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    close(cells_[c].window);
    for (int k = 0; k < harmonics; ++k) {
      here[k] += cells_[c].lower * sum[c] * cells_[c].turn[k];
      next[k] += cells_[c].upper * sum[c] * cells_[c].turn[k];
    }
  }
  close(window + 2);
  return total;
}

}  // namespace petzval
