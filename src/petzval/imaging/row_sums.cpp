// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/row_sums.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/imaging/row_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Cells = hn::ScalableTag<float>;

/// sums = Σ_k weights[k] · of(k)[c], the sums before added if `adds`.
template <bool adds, typename Of>
HWY_ATTR HWY_INLINE void weigh(std::span<const float> weights, const Of& of, std::span<float> sums) {
  const Cells d;
  const std::size_t lanes = hn::Lanes(d), count = sums.size();
  float* const out = sums.data();
  std::size_t at = 0;
  // Four sums at a time hide how long one takes.
  for (; at + 4 * lanes <= count; at += 4 * lanes) {
    auto a = hn::Zero(d), b = a, c = a, e = a;
    if (adds) {
      a = hn::LoadU(d, out + at);
      b = hn::LoadU(d, out + at + lanes);
      c = hn::LoadU(d, out + at + 2 * lanes);
      e = hn::LoadU(d, out + at + 3 * lanes);
    }
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const auto weight = hn::Set(d, weights[k]);
      const float* const cells = of(k) + at;
      a = hn::MulAdd(weight, hn::LoadU(d, cells), a);
      b = hn::MulAdd(weight, hn::LoadU(d, cells + lanes), b);
      c = hn::MulAdd(weight, hn::LoadU(d, cells + 2 * lanes), c);
      e = hn::MulAdd(weight, hn::LoadU(d, cells + 3 * lanes), e);
    }
    hn::StoreU(a, d, out + at);
    hn::StoreU(b, d, out + at + lanes);
    hn::StoreU(c, d, out + at + 2 * lanes);
    hn::StoreU(e, d, out + at + 3 * lanes);
  }
  for (; at < count; ++at) {
    float sum = adds ? out[at] : 0.0F;
    for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * of(k)[at];
    out[at] = sum;
  }
}

HWY_ATTR void down(const float* cells, std::size_t stride, std::span<const float> weights,
                   std::span<float> sums) {
  weigh<false>(
      weights, [=](std::size_t k) HWY_ATTR { return cells + k * stride; }, sums);
}

HWY_ATTR void along(std::span<const float> phases, std::size_t step, std::span<const float> weights,
                    std::span<float> sums) {
  const float* const cells = phases.data();
  const std::size_t length = phases.size() / step;
  weigh<true>(
      weights, [=](std::size_t k) HWY_ATTR { return cells + k % step * length + k / step; }, sums);
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(down);
HWY_EXPORT(along);

void sum_down(const float* cells, std::size_t stride, std::span<const float> weights, std::span<float> sums) {
  HWY_DYNAMIC_DISPATCH(down)(cells, stride, weights, sums);
}

void add_along(std::span<const float> phases, std::size_t step, std::span<const float> weights,
               std::span<float> sums) {
  HWY_DYNAMIC_DISPATCH(along)(phases, step, weights, sums);
}

}  // namespace petzval
#endif
