// SPDX-License-Identifier: BSD-3-Clause
// The functions whose sum is an edge-spread function, at many points, on whatever SIMD the machine has.
#pragma once

#include <petzval/base/unset_vector.h>
#include <petzval/measure/sfr/edge_spread_basis.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace petzval {

/// A sample by its distance from the edge.
struct EdgePoint {
  double distance = 0, value = 0;
  double along = 0;    ///< place along the edge, −1 to 1
  double light = 0;    ///< expected value over that of the bright side; both only for light that varies
  double missing = 0;  ///< SfrOptions::missing_target there [1/pixel]
};

/// A row for each point: the splines that are not zero there, and the functions that reach everywhere.
class EdgeRows {
 public:
  static constexpr int support = EdgeSpreadBasis::support;
  /// Splines that reach beyond the core have no unknown; rows count them all the same, so that all are alike.
  static constexpr int margin = support - 1;
  /// Room for the splines of a row, with zeros behind them.
  static constexpr int spline_lanes = 8;

  /// Rows of other points; memory is kept.
  void make(std::span<const EdgePoint> points, const EdgeSpreadBasis& basis);

  std::size_t size() const { return first_.size(); }
  /// Of the splines of a row, counted from `margin` before the first unknown; −1: none.
  int first(std::size_t point) const { return first_[point]; }
  /// The intervals between knots, and the points that lie in one of them; −1: in none.
  int cells() const { return static_cast<int>(begins_.size()) - 2; }
  std::span<const std::uint32_t> in_cell(int cell) const {
    const std::size_t begin = begins_[static_cast<std::size_t>(cell + 1)];
    return std::span(by_cell_).subspan(begin, begins_[static_cast<std::size_t>(cell + 2)] - begin);
  }
  const double* splines(std::size_t point) const { return row(point) + fixed_lanes_; }
  /// As EdgeSpreadBasis has them, then zeros, and the value of the point in the last place.
  const double* fixed(std::size_t point) const { return row(point); }
  int fixed_lanes() const { return fixed_lanes_; }
  /// How many splines rows count.
  int padded() const { return padded_; }
  /// Of the points, and some zeros behind them.
  const double* distances() const { return distance_.data(); }
  /// Where a point lies in its interval between knots, 0 to 1.
  double share(std::size_t point) const { return share_[point]; }

  /// Sums over the points of products of two functions.
  struct Products {
    /// For each spline that rows count: with itself and those after it, then with what reaches everywhere.
    std::vector<double> columns;
    std::vector<double> corner;  ///< of what reaches everywhere with itself: rows of `fixed_lanes()`
  };
  /// \param weights  of the points; empty: all are 1.
  Products products(std::span<const double> weights = {}) const;

  /// At each point the sum of all functions with these factors, and its slope per pixel but for light.
  struct Sums {
    UnsetVector<double> values, slopes;
  };
  /// \param splines  `padded()`, and `spline_lanes` zeros behind them. \param fixed  `fixed_lanes()`.
  Sums evaluate(std::span<const double> splines, std::span<const double> fixed) const;

  /// Sums over the points of the products with other functions of them. \param functions  `count` values for
  /// each point, one after the other: 2, 4 or 8. \returns for each function `projections()`: with the splines
  /// that rows count, `spline_lanes` more, and with what reaches everywhere.
  std::vector<double> project(std::span<const double> functions, int count) const;
  std::size_t projections() const { return static_cast<std::size_t>(padded_ + spline_lanes + fixed_lanes_); }

 private:
  const double* row(std::size_t point) const { return rows_.data() + point * stride(); }
  std::size_t stride() const { return static_cast<std::size_t>(fixed_lanes_ + spline_lanes); }
  void sort_by_cell(int cells);

  int padded_ = 0, fixed_ = 0, fixed_lanes_ = 8;
  double knot_px_ = 1;
  UnsetVector<double> rows_, distance_, share_;
  UnsetVector<int> first_;
  std::vector<std::uint32_t> by_cell_;
  std::vector<std::size_t> begins_;  ///< of the points of each cell in `by_cell_`, from −1 on
};

}  // namespace petzval
