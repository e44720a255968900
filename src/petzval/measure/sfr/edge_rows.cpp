// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_rows.h>

#include <algorithm>
#include <array>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/measure/sfr/edge_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// Read once for every instruction set, too, and so after the first.
#include <hwy/contrib/math/math-inl.h>

#ifndef PETZVAL_EDGE_ROWS_PASSED
#define PETZVAL_EDGE_ROWS_PASSED
namespace petzval {
namespace {

constexpr int support = EdgeRows::support, spline_lanes = EdgeRows::spline_lanes;

/// Where rows are written to.
struct RowsTarget {
  double *rows, *distance, *share;
  int* first;
  int fixed_lanes;
};

/// Of t^m in the splines that cover an interval between knots, in rows of `spline_lanes`; then of t^m in
/// their derivatives.
struct SplinePowers {
  double values[support][spline_lanes] = {}, slopes[support][spline_lanes] = {};
  constexpr SplinePowers() {
    for (std::size_t m = 0; m < support; ++m)
      for (int p = 0; p < support; ++p) {
        values[m][p] = EdgeSpreadBasis::quintic(p)[m];
        if (m > 0) slopes[m - 1][p] = static_cast<double>(m) * values[m][p];
      }
  }
};
constexpr SplinePowers powers;

}  // namespace
}  // namespace petzval
#endif

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, spline_lanes>;
using Vector = hn::Vec<Lanes>;

/// At a time: arithmetic that points have in common is done for so many, into places beside one another.
constexpr int block = 8;
struct Block {
  double distance[block], missing[block], cell[block], share[block], step[block], tail1[block], tail3[block];
};

/// Values of the closed forms, and where among the splines the points lie.
HWY_ATTR void evaluate_forms(Block& at, double core_px, double per_knot) {
  const Lanes d;
  const auto one = hn::Set(d, 1.0), half = hn::Set(d, 0.5);
  for (int i = 0; i < block; i += static_cast<int>(hn::Lanes(d))) {
    const auto x = hn::LoadU(d, at.distance + i), missing = hn::Mul(half, hn::LoadU(d, at.missing + i));
    const auto q = hn::Div(one, hn::MulAdd(x, x, one)), xq = hn::Mul(x, q), per_pi = hn::Set(d, 1 / pi);
    hn::StoreU(hn::Add(half, hn::Mul(per_pi, hn::Add(hn::Atan(d, x), missing))), d, at.step + i);
    hn::StoreU(hn::Sub(missing, xq), d, at.tail1 + i);
    hn::StoreU(hn::Neg(hn::Mul(xq, q)), d, at.tail3 + i);
    const auto place = hn::Mul(hn::Add(x, hn::Set(d, core_px)), hn::Set(d, per_knot)),
               cell = hn::Floor(place);
    hn::StoreU(cell, d, at.cell + i);
    hn::StoreU(hn::Sub(place, cell), d, at.share + i);
  }
}

HWY_ATTR void make_splines(double share, double* splines) {
  const Lanes d;
  const auto t = hn::Set(d, share);
  for (int v = 0; v < spline_lanes; v += static_cast<int>(hn::Lanes(d))) {
    auto sum = hn::LoadU(d, powers.values[support - 1] + v);
    for (int m = support - 2; m >= 0; --m) sum = hn::MulAdd(sum, t, hn::LoadU(d, powers.values[m] + v));
    hn::StoreU(sum, d, splines + v);
  }
}

HWY_ATTR HWY_INLINE void clear(double* values, int count) {
  const Lanes d;
  for (int v = 0; v < count; v += static_cast<int>(hn::Lanes(d))) hn::StoreU(hn::Zero(d), d, values + v);
}

HWY_ATTR void make_fixed(const EdgePoint& point, double core_px, int light_order, double* fixed) {
  if (light_order > 0) {
    fixed[4] = point.light * point.along;
    fixed[5] = point.light * point.distance / core_px;
  }
  if (light_order > 1) {
    fixed[6] = fixed[4] * point.along;
    fixed[7] = fixed[5] * point.along;
    fixed[8] = fixed[5] * point.distance / core_px;
  }
}

HWY_ATTR void make_rows(std::span<const EdgePoint> points, const EdgeSpreadBasis& basis,
                        const RowsTarget& made) {
  const double core_px = basis.core_px(), per_knot = 1 / basis.knot_px;
  const double cells = basis.splines + support - 1;
  double* row = made.rows;
  for (std::size_t begin = 0; begin < points.size(); begin += block) {
    const std::size_t count = std::min<std::size_t>(block, points.size() - begin);
    Block at{};
    for (std::size_t i = 0; i < count; ++i)
      at.distance[i] = points[begin + i].distance, at.missing[i] = points[begin + i].missing;
    evaluate_forms(at, core_px, per_knot);
    for (std::size_t i = 0; i < count; ++i, row += made.fixed_lanes + spline_lanes) {
      const EdgePoint& point = points[begin + i];
      clear(row, made.fixed_lanes + spline_lanes);
      row[0] = 1, row[1] = at.step[i], row[2] = at.tail1[i], row[3] = at.tail3[i];
      make_fixed(point, core_px, basis.light_order, row);
      row[made.fixed_lanes - 1] = point.value;
      const bool covered = at.cell[i] >= 0 && at.cell[i] < cells;
      if (covered) make_splines(at.share[i], row + made.fixed_lanes);
      made.first[begin + i] = covered ? static_cast<int>(at.cell[i]) : -1;
      made.distance[begin + i] = point.distance, made.share[begin + i] = at.share[i];
    }
  }
}

/// From interval to interval, so that sums over its points stay in registers.
template <int fixed, int fixed_lanes>
HWY_ATTR void add_products(const EdgeRows& rows, const double* weights, double* columns, double* corner) {
  const Lanes d;
  constexpr int lanes = static_cast<int>(hn::MaxLanes(Lanes())), of_splines = spline_lanes / lanes,
                of_fixed = fixed_lanes / lanes;
  Vector corners[fixed][of_fixed];
  for (auto& sums : corners)
    for (Vector& sum : sums) sum = hn::Zero(d);
  for (int cell = -1; cell < rows.cells(); ++cell) {
    const std::span<const std::uint32_t> points = rows.in_cell(cell);
    if (points.empty()) continue;
    Vector within[support][of_splines], beside[support][of_fixed];
    for (int p = 0; p < support; ++p) {
      for (int v = 0; v < of_splines; ++v) within[p][v] = hn::Zero(d);
      for (int v = 0; v < of_fixed; ++v) beside[p][v] = hn::Zero(d);
    }
    for (const std::uint32_t i : points) {
      const double* const row = rows.fixed(i);
      const double* const splines = row + fixed_lanes;
      const auto weight = hn::Set(d, weights == nullptr ? 1 : weights[i]);
      Vector others[of_fixed], own[of_splines];
      for (int v = 0; v < of_fixed; ++v) others[v] = hn::Mul(weight, hn::LoadU(d, row + v * lanes));
      for (int r = 0; r < fixed; ++r)
        for (int v = 0; v < of_fixed; ++v)
          corners[r][v] = hn::MulAdd(hn::Set(d, row[r]), others[v], corners[r][v]);
      if (cell < 0) continue;
      for (int v = 0; v < of_splines; ++v) own[v] = hn::Mul(weight, hn::LoadU(d, splines + v * lanes));
      for (int p = 0; p < support; ++p) {
        const auto factor = hn::Set(d, splines[p]);
        for (int v = 0; v < of_splines; ++v) within[p][v] = hn::MulAdd(factor, own[v], within[p][v]);
        for (int v = 0; v < of_fixed; ++v) beside[p][v] = hn::MulAdd(factor, others[v], beside[p][v]);
      }
    }
    if (cell < 0) continue;
    double* column = columns + cell * (spline_lanes + fixed_lanes);
    for (int p = 0; p < support; ++p, column += spline_lanes + fixed_lanes) {
      double sums[spline_lanes];
      for (int v = 0; v < of_splines; ++v) hn::StoreU(within[p][v], d, sums + v * lanes);
      for (int q = p; q < support; ++q) column[q - p] += sums[q];
      for (int v = 0; v < of_fixed; ++v) {
        double* const sum = column + spline_lanes + v * lanes;
        hn::StoreU(hn::Add(hn::LoadU(d, sum), beside[p][v]), d, sum);
      }
    }
  }
  for (int r = 0; r < fixed; ++r)
    for (int v = 0; v < of_fixed; ++v) hn::StoreU(corners[r][v], d, corner + r * fixed_lanes + v * lanes);
}

HWY_ATTR void add_all_products(const EdgeRows& rows, const double* weights, int fixed, double* columns,
                               double* corner) {
  static_assert(EdgeSpreadBasis::closed_forms == 4 && EdgeSpreadBasis::light_terms == std::array{0, 2, 5});
  if (fixed == 4)
    add_products<4, 8>(rows, weights, columns, corner);
  else if (fixed == 6)
    add_products<6, 8>(rows, weights, columns, corner);
  else
    add_products<9, 16>(rows, weights, columns, corner);
}

HWY_ATTR HWY_INLINE double product_of(const double* a, const double* b, int count) {
  const Lanes d;
  auto sum = hn::Zero(d);
  for (int v = 0; v < count; v += static_cast<int>(hn::Lanes(d)))
    sum = hn::MulAdd(hn::LoadU(d, a + v), hn::LoadU(d, b + v), sum);
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

/// Slopes of the closed forms.
HWY_ATTR void evaluate_form_slopes(const EdgeRows& rows, const double* fixed, double* slopes) {
  const Lanes d;
  const auto lanes = hn::Lanes(d);
  const auto one = hn::Set(d, 1.0), step = hn::Set(d, fixed[1] / pi), tail1 = hn::Set(d, fixed[2]),
             tail3 = hn::Set(d, fixed[3]);
  for (std::size_t i = 0; i < rows.size(); i += lanes) {
    const auto x = hn::LoadU(d, rows.distances() + i);
    const auto q = hn::Div(one, hn::MulAdd(x, x, one)), xq = hn::Mul(x, q), xq2 = hn::Mul(xq, xq);
    const auto of_tail1 = hn::NegMulAdd(hn::Set(d, 2.0), xq2, q),
               of_tail3 = hn::Mul(q, hn::NegMulAdd(hn::Set(d, 4.0), xq2, q));
    const auto slope = hn::NegMulAdd(tail3, of_tail3, hn::NegMulAdd(tail1, of_tail1, hn::Mul(step, q)));
    hn::StoreU(slope, d, slopes + i);
  }
}

/// What the splines add up to in an interval between knots, as powers of the share of it.
struct CellPowers {
  double values[support];

  HWY_ATTR explicit CellPowers(const double* coefficients) {
    for (int m = 0; m < support; ++m) values[m] = product_of(powers.values[m], coefficients, spline_lanes);
  }
};

template <int fixed_lanes>
HWY_ATTR void evaluate(const EdgeRows& rows, double per_knot, const double* splines, const double* fixed,
                       double* values, double* slopes) {
  for (std::size_t i = 0; i < rows.size(); ++i) values[i] = product_of(rows.fixed(i), fixed, fixed_lanes);
  for (int cell = 0; cell < rows.cells(); ++cell) {
    const CellPowers of(splines + cell);
    for (const std::uint32_t i : rows.in_cell(cell)) {
      const double t = rows.share(i);
      double value = of.values[support - 1], slope = 0;
      for (int m = support - 2; m >= 0; --m) {
        slope = slope * t + value;
        value = value * t + of.values[m];
      }
      values[i] += value;
      slopes[i] += per_knot * slope;
    }
  }
}

HWY_ATTR void evaluate_all(const EdgeRows& rows, double per_knot, const double* splines, const double* fixed,
                           double* values, double* slopes) {
  evaluate_form_slopes(rows, fixed, slopes);
  if (rows.fixed_lanes() == 8)
    evaluate<8>(rows, per_knot, splines, fixed, values, slopes);
  else
    evaluate<16>(rows, per_knot, splines, fixed, values, slopes);
}

/// From interval to interval, as add_products().
template <int count, int fixed_lanes>
HWY_ATTR void project(const EdgeRows& rows, const double* functions, double* sums) {
  const Lanes d;
  constexpr int lanes = static_cast<int>(hn::MaxLanes(Lanes())), of_splines = spline_lanes / lanes,
                of_fixed = fixed_lanes / lanes;
  const std::size_t stride = rows.projections();
  Vector beside[count][of_fixed];
  for (auto& each : beside)
    for (Vector& sum : each) sum = hn::Zero(d);
  for (int cell = -1; cell < rows.cells(); ++cell) {
    Vector within[count][of_splines];
    for (auto& each : within)
      for (Vector& sum : each) sum = hn::Zero(d);
    for (const std::uint32_t i : rows.in_cell(cell)) {
      const double *const fixed = rows.fixed(i), *const splines = fixed + fixed_lanes;
      for (int k = 0; k < count; ++k) {
        const auto factor = hn::Set(d, functions[i * count + static_cast<std::size_t>(k)]);
        for (int v = 0; v < of_fixed; ++v)
          beside[k][v] = hn::MulAdd(factor, hn::LoadU(d, fixed + v * lanes), beside[k][v]);
        for (int v = 0; v < of_splines; ++v)
          within[k][v] = hn::MulAdd(factor, hn::LoadU(d, splines + v * lanes), within[k][v]);
      }
    }
    for (std::size_t k = 0; k < count && cell >= 0; ++k)
      for (int v = 0; v < of_splines; ++v) {
        double* const sum = sums + k * stride + cell + v * lanes;
        hn::StoreU(hn::Add(hn::LoadU(d, sum), within[k][v]), d, sum);
      }
  }
  for (std::size_t k = 0; k < count; ++k)
    for (int v = 0; v < of_fixed; ++v)
      hn::StoreU(beside[k][v], d, sums + (k + 1) * stride - fixed_lanes + v * lanes);
}

template <int count>
HWY_ATTR void project_so_many(const EdgeRows& rows, const double* functions, double* sums) {
  if (rows.fixed_lanes() == 8)
    project<count, 8>(rows, functions, sums);
  else
    project<count, 16>(rows, functions, sums);
}

HWY_ATTR void project_all(const EdgeRows& rows, const double* functions, int count, double* sums) {
  if (count == 2)
    project_so_many<2>(rows, functions, sums);
  else if (count == 4)
    project_so_many<4>(rows, functions, sums);
  else
    project_so_many<8>(rows, functions, sums);
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(make_rows);
HWY_EXPORT(add_all_products);
HWY_EXPORT(evaluate_all);
HWY_EXPORT(project_all);

namespace {

std::size_t in_blocks(std::size_t points) {
  return (points + spline_lanes - 1) / spline_lanes * spline_lanes;
}

}  // namespace

void EdgeRows::make(std::span<const EdgePoint> points, const EdgeSpreadBasis& basis) {
  padded_ = basis.splines + 2 * margin;
  fixed_ = basis.fixed();
  fixed_lanes_ = fixed_ < 8 ? 8 : 16;
  knot_px_ = basis.knot_px;
  rows_.resize(points.size() * stride());
  distance_.resize(in_blocks(points.size()));
  share_.resize(points.size());
  first_.resize(points.size());
  std::fill(distance_.begin() + static_cast<std::ptrdiff_t>(points.size()), distance_.end(), 0.0);
  HWY_DYNAMIC_DISPATCH(make_rows)
  (points, basis, {rows_.data(), distance_.data(), share_.data(), first_.data(), fixed_lanes_});
  sort_by_cell(basis.splines + margin);
}

void EdgeRows::sort_by_cell(int cells) {
  begins_.assign(static_cast<std::size_t>(cells) + 2, 0);
  for (const int cell : first_) ++begins_[static_cast<std::size_t>(cell + 1)];
  std::size_t begin = 0;
  for (std::size_t& each : begins_) begin += std::exchange(each, begin);
  by_cell_.resize(size());
  for (std::size_t i = 0; i < size(); ++i)
    by_cell_[begins_[static_cast<std::size_t>(first_[i] + 1)]++] = static_cast<std::uint32_t>(i);
  // Each beginning has moved on to the next one.
  begins_.insert(begins_.begin(), 0);
  begins_.pop_back();
}

EdgeRows::Products EdgeRows::products(std::span<const double> weights) const {
  const auto lanes = static_cast<std::size_t>(fixed_lanes_);
  Products sums;
  sums.columns.resize(static_cast<std::size_t>(padded_) * (spline_lanes + lanes));
  sums.corner.resize(static_cast<std::size_t>(fixed_) * lanes);
  HWY_DYNAMIC_DISPATCH(add_all_products)
  (*this, weights.empty() ? nullptr : weights.data(), fixed_, sums.columns.data(), sums.corner.data());
  return sums;
}

EdgeRows::Sums EdgeRows::evaluate(std::span<const double> splines, std::span<const double> fixed) const {
  Sums sums;
  sums.values.resize(size());
  sums.slopes.resize(in_blocks(size()));
  HWY_DYNAMIC_DISPATCH(evaluate_all)
  (*this, 1 / knot_px_, splines.data(), fixed.data(), sums.values.data(), sums.slopes.data());
  return sums;
}

std::vector<double> EdgeRows::project(std::span<const double> functions, int count) const {
  std::vector<double> sums(static_cast<std::size_t>(count) * projections());
  HWY_DYNAMIC_DISPATCH(project_all)(*this, functions.data(), count, sums.data());
  return sums;
}

}  // namespace petzval
#endif
