// SPDX-License-Identifier: BSD-3-Clause
// What rounding to whole code values does to quantities that are measured from many pixels.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace petzval {

/// Rounding is no noise that averages out: pixels of the same light are all wrong by the same amount. Its
/// error is a sawtooth of the value, Σ_k (−1)^k sin(2πkx)/(πk) steps at x steps. Where in a step a value
/// truly lies is not known, so its phase counts as random; nearby values share it, values more than a step or
/// two apart do not. Noise of σ steps blurs the sawtooth: harmonic k loses the factor exp(−2π²k²σ²), and what
/// it loses is scatter, which is seen in the residuals. (B. Widrow & I. Kollár, Quantization Noise, Cambridge
/// 2008, chapters 4 and 5.)
class QuantisationNoise {
 public:
  /// None.
  QuantisationNoise() = default;
  /// \param levels  the light of each code value, rising, at least two \param values  expected light of each
  /// sample \param variance  of the residuals of each sample about it.
  QuantisationNoise(std::span<const double> levels, std::span<const double> values,
                    std::span<const double> variance);

  bool none() const { return cells_.empty(); }

  /// Adds `weight` times the row that sample i has in a linear fit to a sum of rows.
  using AddRow = std::function<void(std::size_t i, double weight, double* sum)>;
  /// Adds the covariance of Σ row_i · value_i to the lower half of a matrix.
  void add_spread(const AddRow& add_row, Eigen::MatrixXd& covariance) const;

 private:
  static constexpr int harmonics = 6;
  /// Real and imaginary part of each harmonic.
  using Harmonics = Eigen::Array<double, 2 * harmonics, 1>;
  /// Of each unknown.
  class SparseSums;
  /// Samples that lie in the same sixteenth of a step.
  struct Cell {
    std::size_t first = 0, count = 0;  ///< of its samples, in `order_`
    int window = 0;                    ///< the step that they lie above
    double lower = 0, upper = 0;       ///< share in this window and in the next
    Harmonics turn;                    ///< amplitude · exp(2πikx)
  };
  /// Whether no other cell shares a window with this one.
  bool is_alone(std::size_t cell) const;
  /// Adds what its rounding spreads to the lower half of a matrix; `sum` as long as that.
  void add_spread_of_one(const Cell& cell, const AddRow& add_row, std::vector<double>& sum,
                         Eigen::MatrixXd& covariance) const;
  void add_rows(const Cell& cell, const AddRow& add_row, std::vector<double>& sum) const;

  std::vector<std::size_t> order_;  ///< samples by rising cell
  std::vector<double> step_;        ///< size of a step at each sample
  std::vector<Cell> cells_;         ///< by rising value
};

}  // namespace petzval
