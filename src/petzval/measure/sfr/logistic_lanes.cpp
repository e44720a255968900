// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/logistic_lanes.h>

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/measure/sfr/logistic_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// Read once for every instruction set, too, and so after the first.
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Lanes>;

constexpr int unknowns = 5, products = unknowns * (unknowns + 1) / 2;

/// Sums of lanes stand side by side in memory, for there are more of them than registers.
struct LaneSums {
  double square[8], normal[products][8], right[unknowns][8];
};

HWY_ATTR HWY_INLINE void add_to(double* sum, Vector a, Vector b) {
  const Lanes d;
  hn::StoreU(hn::MulAdd(a, b, hn::LoadU(d, sum)), d, sum);
}

HWY_ATTR void sums(const LogisticSamples& samples, const LogisticEdge& edge, LogisticSums& result) {
  const Lanes d;
  const auto lanes = hn::Lanes(d);
  const double step = edge[4] - edge[3], per_scale = std::exp(-edge[2]);
  const auto c = hn::Set(d, std::cos(edge[1])), s = hn::Set(d, std::sin(edge[1])), one = hn::Set(d, 1.0),
             scale = hn::Set(d, per_scale), most = hn::Set(d, 700.0);
  LaneSums sum{};
  for (std::size_t i = 0; i < samples.x.size(); i += lanes) {
    const auto x = hn::LoadU(d, samples.x.data() + i), y = hn::LoadU(d, samples.y.data() + i),
               weight = hn::LoadU(d, samples.weight.data() + i);
    const auto z = hn::Mul(hn::Sub(hn::MulAdd(x, c, hn::Mul(y, s)), hn::Set(d, edge[0])), scale);
    const auto profile = hn::Div(one, hn::Add(one, hn::Exp(d, hn::Min(hn::Neg(z), most))));
    const auto expected = hn::MulAdd(hn::Set(d, step), profile, hn::Set(d, edge[3]));
    const auto residual = hn::Mul(weight, hn::Sub(hn::LoadU(d, samples.value.data() + i), expected));
    const auto slope = hn::Mul(weight, hn::Mul(hn::Set(d, step), hn::Mul(profile, hn::Sub(one, profile))));
    const auto of_offset = hn::Neg(hn::Mul(slope, scale));
    const auto of_direction = hn::Mul(of_offset, hn::Sub(hn::Mul(x, s), hn::Mul(y, c)));
    const Vector derivatives[unknowns] = {of_offset, of_direction, hn::Neg(hn::Mul(slope, z)),
                                          hn::Mul(weight, hn::Sub(one, profile)), hn::Mul(weight, profile)};
    add_to(sum.square, residual, residual);
    double* product = sum.normal[0];
    for (int r = 0; r < unknowns; ++r) {
      for (int k = 0; k <= r; ++k, product += 8) add_to(product, derivatives[r], derivatives[k]);
      add_to(sum.right[r], residual, derivatives[r]);
    }
  }
  const auto total = [&](const double* of)
                         HWY_ATTR { return hn::GetLane(hn::SumOfLanes(d, hn::LoadU(d, of))); };
  result.square = total(sum.square);
  for (std::size_t i = 0; i < products; ++i) result.normal[i] = total(sum.normal[i]);
  for (std::size_t r = 0; r < unknowns; ++r) result.right[r] = total(sum.right[r]);
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(sums);

LogisticSums logistic_sums(const LogisticSamples& samples, const LogisticEdge& edge) {
  LogisticSums result;
  HWY_DYNAMIC_DISPATCH(sums)(samples, edge, result);
  return result;
}

}  // namespace petzval
#endif
