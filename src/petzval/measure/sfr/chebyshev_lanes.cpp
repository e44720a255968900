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

/// By Clenshaw's recurrence along y, and by that of the polynomials along x.
HWY_ATTR HWY_INLINE Vector sum_at(const ChebyshevTerms& terms, Vector x, Vector y) {
  const Lanes d;
  const auto twice_x = hn::Add(x, x), twice_y = hn::Add(y, y);
  auto before = x, polynomial = hn::Set(d, 1.0), sum = hn::Zero(d);  // T₋₁ = T₁
  for (int i = 0; i < terms.along; ++i) {
    const double* const c = terms.coefficients + i * terms.stride;
    auto last = hn::Zero(d), here = hn::Set(d, c[terms.across - 1]);
    for (int j = terms.across - 2; j > 0; --j) {
      const auto next = hn::MulAdd(twice_y, here, hn::Sub(hn::Set(d, c[j]), last));
      last = here, here = next;
    }
    sum = hn::MulAdd(polynomial, hn::MulAdd(y, here, hn::Sub(hn::Set(d, c[0]), last)), sum);
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
