// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/bordered_band.h>
#include <petzval/measure/sfr/bordered_lanes.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/measure/sfr/bordered_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int eight = BorderedBand::lanes, corner = BorderedBand::width + 1;
using Lanes = hn::CappedTag<double, eight>;
using Vector = hn::Vec<Lanes>;

/// How many entries a column of the band has below the diagonal within it.
HWY_INLINE int below(const BorderedEntries& matrix, int column) {
  return std::min(BorderedBand::width, matrix.band - 1 - column);
}

/// Takes the root of a diagonal entry. \returns its reciprocal; 0, and no root, unless it is positive.
HWY_ATTR HWY_INLINE double take_root(double& diagonal) {
  if (!(diagonal > 0 && std::isfinite(diagonal))) return 0;
  diagonal = std::sqrt(diagonal);
  return 1 / diagonal;
}

/// One column of the band, with `reach` entries below its diagonal.
template <int reach, int border>
HWY_ATTR HWY_INLINE double eliminate_column(double* l, double* border_columns) {
  constexpr int stride = corner + border;
  const double scale = take_root(l[0]);
  if (scale == 0) return 0;
  double under[reach + 1], beside[border];
  for (int p = 1; p <= reach; ++p) under[p] = l[p] *= scale;
  for (int r = 0; r < border; ++r) beside[r] = l[corner + r] *= scale;
  for (int p = 1; p <= reach; ++p) {
    double* const other = l + p * stride;
    for (int q = p; q <= reach; ++q) other[q - p] -= under[p] * under[q];
    for (int r = 0; r < border; ++r) other[corner + r] -= under[p] * beside[r];
  }
  for (int s = 0; s < border; ++s, border_columns += stride)
    for (int r = 0; r < border; ++r) border_columns[corner + r] -= beside[s] * beside[r];
  return scale;
}

/// The last columns of the band have fewer entries below their diagonals.
template <int reach, int border>
HWY_ATTR HWY_INLINE double eliminate_within(int rest, double* l, double* border_columns) {
  if constexpr (reach > 0)
    if (rest < reach) return eliminate_within<reach - 1, border>(rest, l, border_columns);
  return eliminate_column<reach, border>(l, border_columns);
}

template <int border>
HWY_ATTR bool eliminate(double* entries, int band, double* per_diagonal) {
  constexpr int stride = corner + border;
  double* const border_columns = entries + std::ptrdiff_t{stride} * band;
  double* l = entries;
  for (int j = 0; j < band; ++j, l += stride) {
    per_diagonal[j] = eliminate_within<BorderedBand::width, border>(band - 1 - j, l, border_columns);
    if (per_diagonal[j] == 0) return false;
  }
  for (int k = 0; k < border; ++k, l += stride) {
    double* const own = l + corner;
    const double scale = per_diagonal[band + k] = take_root(own[k]);
    if (scale == 0) return false;
    for (int r = k + 1; r < border; ++r) own[r] *= scale;
    for (int s = k + 1; s < border; ++s) {
      double* const other = border_columns + s * stride + corner;
      for (int r = s; r < border; ++r) other[r] -= own[s] * own[r];
    }
  }
  return true;
}

/// For each number of unknowns in the border, so that the loops over it are unrolled.
template <int border>
HWY_ATTR bool eliminate_with_border(int wanted, double* entries, int band, double* per_diagonal) {
  if constexpr (border < BorderedBand::most_border)
    if (wanted > border) return eliminate_with_border<border + 1>(wanted, entries, band, per_diagonal);
  return eliminate<border>(entries, band, per_diagonal);
}

HWY_ATTR bool eliminate_all(double* entries, int band, int border, double* per_diagonal) {
  return eliminate_with_border<1>(border, entries, band, per_diagonal);
}

/// value −= factor · other
HWY_ATTR HWY_INLINE void take(Vector& value, double factor, Vector other) {
  value = hn::NegMulAdd(hn::Set(Lanes(), factor), other, value);
}

/// The unknowns of the band are taken to the right side's rows that they touch when these are reached, the
/// nearest last, for it is the one that has to be waited for.
template <int border>
HWY_ATTR void solve(const BorderedEntries& factor, const double* per_diagonal, double* x) {
  static_assert(BorderedBand::width == 5);
  const Lanes d;
  const int band = factor.band;
  constexpr std::ptrdiff_t stride = corner + border;
  double* const border_rows = x + std::ptrdiff_t{eight} * band;
  const double* const border_columns = factor.entries + stride * band;
  Vector beside[border];
  for (int r = 0; r < border; ++r) beside[r] = hn::LoadU(d, border_rows + eight * r);
  auto x1 = hn::Zero(d), x2 = x1, x3 = x1, x4 = x1, x5 = x1;  // so many places before
  const double* l = factor.entries;
  double* row = x;
  for (int j = 0; j < band; ++j, l += stride, row += eight) {
    auto value = hn::LoadU(d, row);
    if (j > 4) take(value, l[5 - 5 * stride], x5);
    if (j > 3) take(value, l[4 - 4 * stride], x4);
    if (j > 2) take(value, l[3 - 3 * stride], x3);
    if (j > 1) take(value, l[2 - 2 * stride], x2);
    if (j > 0) take(value, l[1 - stride], x1);
    value = hn::Mul(value, hn::Set(d, per_diagonal[j]));
    hn::StoreU(value, d, row);
    for (int r = 0; r < border; ++r) take(beside[r], l[corner + r], value);
    x5 = x4, x4 = x3, x3 = x2, x2 = x1, x1 = value;
  }
  for (int k = 0; k < border; ++k) {
    beside[k] = hn::Mul(beside[k], hn::Set(d, per_diagonal[band + k]));
    for (int r = k + 1; r < border; ++r) take(beside[r], border_columns[k * stride + corner + r], beside[k]);
  }
  for (int k = border - 1; k >= 0; --k) {
    for (int r = k + 1; r < border; ++r) take(beside[k], border_columns[k * stride + corner + r], beside[r]);
    beside[k] = hn::Mul(beside[k], hn::Set(d, per_diagonal[band + k]));
    hn::StoreU(beside[k], d, border_rows + eight * k);
  }
  // Behind the last column there is nothing, whose entries are zero.
  x1 = x2 = x3 = x4 = x5 = hn::Zero(d);
  for (int j = band - 1; j >= 0; --j) {
    l -= stride, row -= eight;
    auto value = hn::LoadU(d, row);
    for (int r = 0; r < border; ++r) take(value, l[corner + r], beside[r]);
    take(value, l[5], x5), take(value, l[4], x4), take(value, l[3], x3), take(value, l[2], x2);
    take(value, l[1], x1);
    value = hn::Mul(value, hn::Set(d, per_diagonal[j]));
    hn::StoreU(value, d, row);
    x5 = x4, x4 = x3, x3 = x2, x2 = x1, x1 = value;
  }
}

template <int border>
HWY_ATTR void solve_with_border(const BorderedEntries& factor, const double* per_diagonal, double* x) {
  if constexpr (border < BorderedBand::most_border)
    if (factor.border > border) return solve_with_border<border + 1>(factor, per_diagonal, x);
  solve<border>(factor, per_diagonal, x);
}

HWY_ATTR void quadratic(const BorderedEntries& matrix, const double* x, double* results) {
  const Lanes d;
  const int band = matrix.band, border = matrix.border;
  const std::ptrdiff_t stride = corner + border;
  const double* const border_rows = x + std::ptrdiff_t{eight} * band;
  auto sum = hn::Zero(d);
  for (int j = 0; j < band + border; ++j) {
    const double* const a = matrix.entries + j * stride;
    const double* const row = x + std::ptrdiff_t{eight} * j;
    auto beside = hn::Zero(d);
    if (j < band)
      for (int p = 1; p <= below(matrix, j); ++p)
        beside = hn::MulAdd(hn::Set(d, a[p]), hn::LoadU(d, row + eight * p), beside);
    for (int r = std::max(0, j - band + 1); r < border; ++r)
      beside = hn::MulAdd(hn::Set(d, a[corner + r]), hn::LoadU(d, border_rows + eight * r), beside);
    const auto value = hn::LoadU(d, row);
    const double diagonal = j < band ? a[0] : a[corner + j - band];
    sum = hn::MulAdd(value, hn::MulAdd(hn::Set(d, diagonal), value, hn::Add(beside, beside)), sum);
  }
  hn::StoreU(sum, d, results);
}

/// The rows of an inverse that a column touches: those of the `width` columns behind it, row j in the place j
/// modulo `width`, then those of the border. A row that is done takes the place of the one it no longer
/// touches, in the columns of the others as they are read.
template <int border>
class InverseWindow {
 public:
  static constexpr int width = BorderedBand::width, rows = width + border,
                       room = (rows + eight - 1) / eight * eight;

  /// \param l  column of the factor below its diagonal, by places. \returns the diagonal entry of the
  /// inverse; column() has the others.
  HWY_ATTR double take(int place, const double* l, double per_diagonal) {
    const Lanes d;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(Lanes())), parts = room / lanes;
    const auto taken_place = hn::Set(d, static_cast<double>(taken_));
    Vector sums[parts];
    for (Vector& sum : sums) sum = hn::Zero(d);
    for (int k = 0; k < rows; ++k) {
      const bool taken = k == taken_;
      const auto factor = hn::Set(d, l[k]), changed = hn::Set(d, taken ? diagonal_ : column_[k]);
      const double* const entries = taken ? column_ : entries_[k];
      for (int v = 0; v < parts; ++v) {
        const auto place_of = hn::Iota(d, static_cast<double>(v * lanes));
        const auto row =
            hn::IfThenElse(hn::Eq(place_of, taken_place), changed, hn::LoadU(d, entries + v * lanes));
        hn::StoreU(row, d, entries_[k] + v * lanes);
        sums[v] = hn::MulAdd(factor, row, sums[v]);
      }
    }
    // From N = L Lᵀ: Lᵀ Z = L⁻¹, whose upper half is the diagonal 1/l.
    auto product = hn::Zero(d);
    for (int v = 0; v < parts; ++v) {
      const auto values = hn::Mul(sums[v], hn::Set(d, -per_diagonal));
      product = hn::MulAdd(hn::LoadU(d, l + v * lanes), values, product);
      hn::StoreU(values, d, column_ + v * lanes);
    }
    taken_ = place;
    return diagonal_ = (per_diagonal - hn::GetLane(hn::SumOfLanes(d, product))) * per_diagonal;
  }
  /// The one taken last, by places.
  const double* column() const { return column_; }

 private:
  double entries_[rows][room] = {}, column_[room] = {}, diagonal_ = 0;
  int taken_ = -1;  ///< place
};

/// K. Takahashi, J. Fagan & M.-S. Chen, Proc. 8th PICA Conference, 1973: column by column from the last.
template <int border>
HWY_ATTR void invert_with(const BorderedEntries& factor, const double* per_diagonal, double* inverse) {
  using Window = InverseWindow<border>;
  constexpr int width = Window::width;
  constexpr std::ptrdiff_t stride = corner + border;
  const int band = factor.band;
  Window window;
  for (int k = border - 1; k >= 0; --k) {
    const std::ptrdiff_t column = stride * (band + k) + corner;
    double l[Window::room] = {};
    for (int r = k + 1; r < border; ++r) l[width + r] = factor.entries[column + r];
    inverse[column + k] = window.take(width + k, l, per_diagonal[band + k]);
    for (int r = k + 1; r < border; ++r) inverse[column + r] = window.column()[width + r];
  }
  for (int j = band - 1; j >= 0; --j) {
    const std::ptrdiff_t column = stride * j;
    const int reach = below(factor, j);
    double l[Window::room] = {};
    for (int p = 1; p <= reach; ++p) l[(j + p) % width] = factor.entries[column + p];
    for (int r = 0; r < border; ++r) l[width + r] = factor.entries[column + corner + r];
    inverse[column] = window.take(j % width, l, per_diagonal[j]);
    for (int p = 1; p <= reach; ++p) inverse[column + p] = window.column()[(j + p) % width];
    for (int r = 0; r < border; ++r) inverse[column + corner + r] = window.column()[width + r];
  }
}

template <int border>
HWY_ATTR void invert_with_border(const BorderedEntries& factor, const double* per_diagonal, double* inverse) {
  if constexpr (border < BorderedBand::most_border)
    if (factor.border > border) return invert_with_border<border + 1>(factor, per_diagonal, inverse);
  invert_with<border>(factor, per_diagonal, inverse);
}

HWY_ATTR void invert_all(const BorderedEntries& factor, const double* per_diagonal, double* inverse) {
  invert_with_border<1>(factor, per_diagonal, inverse);
}

/// With fewer lanes than eight, one part of the vectors after the other.
HWY_ATTR void solve_all(const BorderedEntries& factor, const double* per_diagonal, double* x) {
  for (int v = 0; v < eight; v += static_cast<int>(hn::Lanes(Lanes())))
    solve_with_border<1>(factor, per_diagonal, x + v);
}

HWY_ATTR void quadratic_of_all(const BorderedEntries& matrix, const double* x, double* results) {
  for (int v = 0; v < eight; v += static_cast<int>(hn::Lanes(Lanes()))) quadratic(matrix, x + v, results + v);
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(eliminate_all);
HWY_EXPORT(solve_all);
HWY_EXPORT(invert_all);
HWY_EXPORT(quadratic_of_all);

bool factor_in_place(double* entries, int band, int border, double* per_diagonal) {
  return HWY_DYNAMIC_DISPATCH(eliminate_all)(entries, band, border, per_diagonal);
}

void solve_eight(const BorderedEntries& factor, const double* per_diagonal, double* x) {
  HWY_DYNAMIC_DISPATCH(solve_all)(factor, per_diagonal, x);
}

void invert(const BorderedEntries& factor, const double* per_diagonal, double* inverse) {
  HWY_DYNAMIC_DISPATCH(invert_all)(factor, per_diagonal, inverse);
}

void quadratic_of_eight(const BorderedEntries& matrix, const double* x, double* results) {
  HWY_DYNAMIC_DISPATCH(quadratic_of_all)(matrix, x, results);
}

}  // namespace petzval
#endif
