// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/bordered_band.h>
#include <petzval/measure/sfr/bordered_lanes.h>

#include <algorithm>
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

/// How many entries a column of the band has below the diagonal within it.
HWY_INLINE int below(const BorderedEntries& matrix, int column) {
  return std::min(BorderedBand::width, matrix.band - 1 - column);
}

/// row −= factor · value
HWY_ATTR HWY_INLINE void take_multiple(double factor, hn::Vec<Lanes> value, double* row) {
  const Lanes d;
  hn::StoreU(hn::NegMulAdd(hn::Set(d, factor), value, hn::LoadU(d, row)), d, row);
}

HWY_ATTR void solve(const BorderedEntries& factor, const double* per_diagonal, double* x) {
  const Lanes d;
  const int band = factor.band, border = factor.border, size = band + border;
  const std::ptrdiff_t stride = corner + border;
  double* const border_rows = x + std::ptrdiff_t{eight} * band;
  for (int j = 0; j < size; ++j) {
    const double* const l = factor.entries + j * stride;
    double* const row = x + std::ptrdiff_t{eight} * j;
    const auto value = hn::Mul(hn::LoadU(d, row), hn::Set(d, per_diagonal[j]));
    hn::StoreU(value, d, row);
    if (j < band)
      for (int p = 1; p <= below(factor, j); ++p) take_multiple(l[p], value, row + eight * p);
    for (int r = std::max(0, j - band + 1); r < border; ++r)
      take_multiple(l[corner + r], value, border_rows + eight * r);
  }
  for (int j = size - 1; j >= 0; --j) {
    const double* const l = factor.entries + j * stride;
    double* const row = x + std::ptrdiff_t{eight} * j;
    auto value = hn::LoadU(d, row);
    for (int r = std::max(0, j - band + 1); r < border; ++r)
      value = hn::NegMulAdd(hn::Set(d, l[corner + r]), hn::LoadU(d, border_rows + eight * r), value);
    if (j < band)
      for (int p = below(factor, j); p > 0; --p)
        value = hn::NegMulAdd(hn::Set(d, l[p]), hn::LoadU(d, row + eight * p), value);
    hn::StoreU(hn::Mul(value, hn::Set(d, per_diagonal[j])), d, row);
  }
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

/// With fewer lanes than eight, one part of the vectors after the other.
HWY_ATTR void solve_all(const BorderedEntries& factor, const double* per_diagonal, double* x) {
  for (int v = 0; v < eight; v += static_cast<int>(hn::Lanes(Lanes()))) solve(factor, per_diagonal, x + v);
}

HWY_ATTR void quadratic_of_all(const BorderedEntries& matrix, const double* x, double* results) {
  for (int v = 0; v < eight; v += static_cast<int>(hn::Lanes(Lanes()))) quadratic(matrix, x + v, results + v);
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(solve_all);
HWY_EXPORT(quadratic_of_all);

void solve_eight(const BorderedEntries& factor, const double* per_diagonal, double* x) {
  HWY_DYNAMIC_DISPATCH(solve_all)(factor, per_diagonal, x);
}

void quadratic_of_eight(const BorderedEntries& matrix, const double* x, double* results) {
  HWY_DYNAMIC_DISPATCH(quadratic_of_all)(matrix, x, results);
}

}  // namespace petzval
#endif
