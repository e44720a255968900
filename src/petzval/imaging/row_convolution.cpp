// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/row_convolution.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/imaging/row_convolution.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 16>;

/// Four vectors of sums at a time stay in registers: every weight that is loaded serves all of them.
HWY_ATTR void sum_four(std::span<const RowTerm> terms, std::ptrdiff_t taps, std::ptrdiff_t at, float* sums) {
  const Lanes d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  auto a = hn::Zero(d), b = a, c = a, e = a;
  for (const RowTerm& term : terms) {
    const float* light = term.light + at;
    for (std::ptrdiff_t k = 0; k < taps; ++k) {
      const auto weight = hn::Set(d, term.weights[k]);
      a = hn::MulAdd(weight, hn::LoadU(d, light - k), a);
      b = hn::MulAdd(weight, hn::LoadU(d, light - k + lanes), b);
      c = hn::MulAdd(weight, hn::LoadU(d, light - k + 2 * lanes), c);
      e = hn::MulAdd(weight, hn::LoadU(d, light - k + 3 * lanes), e);
    }
  }
  hn::StoreU(a, d, sums + at);
  hn::StoreU(b, d, sums + at + lanes);
  hn::StoreU(c, d, sums + at + 2 * lanes);
  hn::StoreU(e, d, sums + at + 3 * lanes);
}

HWY_ATTR void sum_one(std::span<const RowTerm> terms, std::ptrdiff_t taps, std::ptrdiff_t at, float* sums) {
  const Lanes d;
  auto even = hn::Zero(d), odd = even;  // so that one need not wait for the other
  for (const RowTerm& term : terms) {
    const float* light = term.light + at;
    std::ptrdiff_t k = 0;
    for (; k + 1 < taps; k += 2) {
      even = hn::MulAdd(hn::Set(d, term.weights[k]), hn::LoadU(d, light - k), even);
      odd = hn::MulAdd(hn::Set(d, term.weights[k + 1]), hn::LoadU(d, light - k - 1), odd);
    }
    if (k < taps) even = hn::MulAdd(hn::Set(d, term.weights[k]), hn::LoadU(d, light - k), even);
  }
  hn::StoreU(hn::Add(even, odd), d, sums + at);
}

HWY_ATTR void convolve(std::span<const RowTerm> terms, int radius, std::size_t count, float* sums) {
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(Lanes())), taps = std::ptrdiff_t{2} * radius + 1,
             end = static_cast<std::ptrdiff_t>(count);
  std::ptrdiff_t at = 0;
  for (; at + 3 * lanes < end; at += 4 * lanes) sum_four(terms, taps, at, sums);
  for (; at < end; at += lanes) sum_one(terms, taps, at, sums);
}

HWY_ATTR std::size_t padding() {
  return hn::Lanes(Lanes());
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(convolve);
HWY_EXPORT(padding);

void convolve_rows(std::span<const RowTerm> terms, int radius, std::size_t count, float* sums) {
  HWY_DYNAMIC_DISPATCH(convolve)(terms, radius, count, sums);
}

std::size_t row_padding() {
  return HWY_DYNAMIC_DISPATCH(padding)();
}

}  // namespace petzval
#endif
