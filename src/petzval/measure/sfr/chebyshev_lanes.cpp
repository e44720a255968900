// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/chebyshev_lanes.h>

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/measure/sfr/chebyshev_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t eight = 8;
using Lanes = hn::CappedTag<double, eight>;
using Vector = hn::Vec<Lanes>;

HWY_ATTR HWY_INLINE Vector within(Vector value) {
  const Lanes d;
  return hn::Max(hn::Set(d, -1.0), hn::Min(hn::Set(d, 1.0), value));
}

/// Two sums at a time, so that none has to wait for another.
HWY_ATTR HWY_INLINE Vector sum_at(const ChebyshevTerms& terms, Vector x, Vector y) {
  const Lanes d;
  const auto twice_x = hn::Add(x, x), twice_y = hn::Add(y, y), one = hn::Set(d, 1.0);
  Vector across[ChebyshevTerms::most_across + 1];
  across[0] = one, across[1] = y;
  for (int j = 2; j < terms.across; ++j) across[j] = hn::MulSub(twice_y, across[j - 1], across[j - 2]);
  auto before = x, polynomial = one, sum = hn::Zero(d);  // T₋₁ = T₁
  for (int i = 0; i < terms.along; ++i) {
    const double* const c = terms.coefficients + i * terms.stride;
    auto even = hn::Zero(d), odd = even;
    for (int j = 0; j < terms.across; j += 2) {
      even = hn::MulAdd(hn::Set(d, c[j]), across[j], even);
      if (j + 1 < terms.across) odd = hn::MulAdd(hn::Set(d, c[j + 1]), across[j + 1], odd);
    }
    sum = hn::MulAdd(polynomial, hn::Add(even, odd), sum);
    const auto next = hn::MulSub(twice_x, polynomial, before);
    before = polynomial, polynomial = next;
  }
  return sum;
}

HWY_ATTR void sums_at(const ChebyshevTerms& terms, std::span<const double> x, std::span<const double> y,
                      std::span<double> sums) {
  const Lanes d;
  for (std::size_t begin = 0; begin < x.size(); begin += eight) {
    const std::size_t count = std::min(eight, x.size() - begin);
    double places[2][eight] = {}, values[eight];
    std::copy_n(x.data() + begin, count, places[0]);
    std::copy_n(y.data() + begin, count, places[1]);
    for (std::size_t v = 0; v < count; v += hn::Lanes(d))
      hn::StoreU(sum_at(terms, within(hn::LoadU(d, places[0] + v)), within(hn::LoadU(d, places[1] + v))), d,
                 values + v);
    std::copy_n(values, count, sums.data() + begin);
  }
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(sums_at);

void chebyshev_sums(const ChebyshevTerms& terms, std::span<const double> x, std::span<const double> y,
                    std::span<double> sums) {
  HWY_DYNAMIC_DISPATCH(sums_at)(terms, x, y, sums);
}

}  // namespace petzval
#endif
