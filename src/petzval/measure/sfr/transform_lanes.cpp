// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/transform_lanes.h>

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/measure/sfr/transform_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int eight = SplinePhases::count;
using Lanes = hn::CappedTag<double, eight>;
using Vector = hn::Vec<Lanes>;

/// Phases that turn from spline to spline.
struct Phase {
  Vector cosine, sine, turn_cosine, turn_sine;
};

HWY_ATTR HWY_INLINE Phase phase_at(const SplinePhases& phases, int v) {
  const Lanes d;
  return {hn::LoadU(d, phases.cosine.data() + v), hn::LoadU(d, phases.sine.data() + v),
          hn::LoadU(d, phases.turn_cosine.data() + v), hn::LoadU(d, phases.turn_sine.data() + v)};
}

HWY_ATTR HWY_INLINE void turn(Phase& phase) {
  const auto next = hn::NegMulAdd(phase.sine, phase.turn_sine, hn::Mul(phase.cosine, phase.turn_cosine));
  phase.sine = hn::MulAdd(phase.cosine, phase.turn_sine, hn::Mul(phase.sine, phase.turn_cosine));
  phase.cosine = next;
}

HWY_ATTR void sums(const SplinePhases& phases, const double* coefficients, int splines, SplineSums& result) {
  const Lanes d;
  for (int v = 0; v < eight; v += static_cast<int>(hn::Lanes(d))) {
    Phase phase = phase_at(phases, v);
    auto even = hn::Zero(d), odd = even;
    for (int j = 0; j < (splines + 1) / 2; ++j) {
      const int other = splines - 1 - j;
      const double partner = other > j ? coefficients[other] : 0;
      even = hn::MulAdd(hn::Set(d, coefficients[j] + partner), phase.cosine, even);
      odd = hn::MulAdd(hn::Set(d, coefficients[j] - partner), phase.sine, odd);
      turn(phase);
    }
    hn::StoreU(even, d, result.even.data() + v);
    hn::StoreU(odd, d, result.odd.data() + v);
  }
}

HWY_ATTR void waves(const SplinePhases& phases, const SplineSums& factors, int splines, double* rows) {
  const Lanes d;
  for (int v = 0; v < eight; v += static_cast<int>(hn::Lanes(d))) {
    Phase phase = phase_at(phases, v);
    const auto even = hn::LoadU(d, factors.even.data() + v), odd = hn::LoadU(d, factors.odd.data() + v);
    for (int j = 0; j < (splines + 1) / 2; ++j) {
      const std::ptrdiff_t other = splines - 1 - j;
      const auto of_cosine = hn::Mul(even, phase.cosine), of_sine = hn::Mul(odd, phase.sine);
      hn::StoreU(hn::Sub(of_cosine, of_sine), d, rows + eight * other + v);
      hn::StoreU(hn::Add(of_cosine, of_sine), d, rows + std::ptrdiff_t{eight} * j + v);
      turn(phase);
    }
  }
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(sums);
HWY_EXPORT(waves);

SplineSums spline_sums(const SplinePhases& phases, const double* coefficients, int splines) {
  SplineSums result;
  HWY_DYNAMIC_DISPATCH(sums)(phases, coefficients, splines, result);
  return result;
}

void spline_waves(const SplinePhases& phases, const SplineSums& factors, int splines, double* rows) {
  HWY_DYNAMIC_DISPATCH(waves)(phases, factors, splines, rows);
}

}  // namespace petzval
#endif
