// SPDX-License-Identifier: BSD-3-Clause
// Normal equations of unknowns most of which touch only their neighbours.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace petzval {

/// A symmetric matrix whose first `band` unknowns touch those within `width` places of them, and whose last
/// `border` unknowns touch all: splines, and functions that reach everywhere. What is done with it takes time
/// in proportion to its size, where a full matrix takes the third power.
class BorderedBand {
 public:
  static constexpr int width = 5;         ///< places beside the diagonal
  static constexpr int most_border = 11;  ///< unknowns that touch all

  /// Several vectors side by side, for what is done with many of them.
  static constexpr int lanes = 8;
  template <int count>
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, count, Eigen::RowMajor>;
  using Block = Columns<lanes>;

  BorderedBand() = default;
  BorderedBand(int band, int border);

  int band() const { return band_; }
  int border() const { return border_; }
  int size() const { return band_ + border_; }
  /// Of the lower half: row ≥ column, both inside the pattern.
  double& at(int row, int column) { return entries_[place(row, column)]; }
  double at(int row, int column) const { return entries_[place(row, column)]; }
  /// The entries of a column of the band: the diagonal and `width` below it, then one for each unknown of the
  /// border.
  double* column(int j) { return entries_.data() + static_cast<std::size_t>(j) * stride(); }
  const double* column(int j) const { return entries_.data() + static_cast<std::size_t>(j) * stride(); }
  /// Adds a multiple of a matrix of the same shape.
  void add(double factor, const BorderedBand& other);
  /// xᵀ M x of each vector.
  std::array<double, lanes> quadratic(const Block& vectors) const;

 private:
  std::size_t stride() const { return static_cast<std::size_t>(width + 1 + border_); }
  std::size_t place(int row, int column) const {
    return static_cast<std::size_t>(column) * stride() +
           static_cast<std::size_t>(row < band_ ? row - column : width + 1 + row - band_);
  }
  int band_ = 0, border_ = 0;
  std::vector<double> entries_;
};

/// The Cholesky factor of such a matrix, which has the same pattern.
class BorderedCholesky {
 public:
  BorderedCholesky() = default;
  explicit BorderedCholesky(BorderedBand matrix);

  /// Whether the matrix was positive definite; if not, nothing else may be asked.
  bool good() const { return good_; }
  double log_determinant() const;
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const { return solve_upper(solve_lower(right)); }
  /// The two halves of it: y of L y = right, and x of Lᵀ x = y.
  Eigen::VectorXd solve_lower(const Eigen::VectorXd& right) const;
  Eigen::VectorXd solve_upper(const Eigen::VectorXd& halfway) const;
  /// Of 2, 4 or `lanes` right sides.
  template <int count>
  void solve_in_place(BorderedBand::Columns<count>& right) const {
    solve_lanes<count>(right.data());
  }
  /// The inverse, where the matrix has entries (K. Takahashi, J. Fagan & M.-S. Chen, Proc. 8th PICA
  /// Conference, 1973).
  BorderedBand inverse() const;

 private:
  template <int count>
  void solve_lower(double* x) const;
  template <int count>
  void solve_upper(double* x) const;
  template <int count>
  void solve_lanes(double* x) const;

  BorderedBand factor_;
  std::vector<double> per_diagonal_;  ///< reciprocals of the factor's diagonal
  bool good_ = false;
};

/// tr(a b) of two matrices of the same shape.
double trace_of_product(const BorderedBand& a, const BorderedBand& b);

}  // namespace petzval
