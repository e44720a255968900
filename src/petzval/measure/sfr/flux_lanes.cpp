// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/flux_lanes.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/measure/sfr/flux_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;

/// By the vectors a and b
/// to its ends a side adds (a × b) (|a| + |b|) / (|a||b| (|a||b| + a·b)), as in the law of Biot & Savart.
/// Between its ends the same with (|a||b|)² − (a·b)² = (a × b)², so that nothing cancels.
HWY_ATTR double flux(std::size_t count, const double* from_x, const double* from_y, const double* way_x,
                     const double* way_y, double x, double y) {
  const Lanes d;
  const auto on_it = hn::Set(d, 1e-9), zero = hn::Zero(d);
  auto sum = zero;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto ax = hn::Sub(hn::LoadU(d, from_x + i), hn::Set(d, x)),
               ay = hn::Sub(hn::LoadU(d, from_y + i), hn::Set(d, y));
    const auto wx = hn::LoadU(d, way_x + i), wy = hn::LoadU(d, way_y + i);
    const auto bx = hn::Add(ax, wx), by = hn::Add(ay, wy);
    const auto a2 = hn::MulAdd(ax, ax, hn::Mul(ay, ay)), b2 = hn::MulAdd(bx, bx, hn::Mul(by, by));
    const auto ab = hn::Sqrt(hn::Mul(a2, b2));
    const auto cross = hn::Sub(hn::Mul(ax, wy), hn::Mul(ay, wx)), along = hn::MulAdd(ax, bx, hn::Mul(ay, by));
    const auto ends = hn::Sqrt(hn::Add(hn::Add(a2, b2), hn::Add(ab, ab)));  // |a| + |b|
    const auto beyond = hn::Gt(along, zero);
    const auto above = hn::IfThenElse(beyond, cross, hn::Sub(ab, along)),
               below = hn::IfThenElse(beyond, hn::Add(ab, along), cross);
    const auto part = hn::Div(hn::Mul(ends, above), hn::Mul(ab, below));
    sum = hn::Add(sum, hn::IfThenElse(hn::Lt(hn::Abs(cross), on_it), zero, part));
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(flux);

void FluxSides::add(double from_x, double from_y, double way_x, double way_y) {
  if (constexpr std::size_t eight = 8; used_ % eight == 0)
    for (std::vector<double>* each : {&from_x_, &from_y_, &way_x_, &way_y_}) each->resize(used_ + eight);
  from_x_[used_] = from_x, from_y_[used_] = from_y, way_x_[used_] = way_x, way_y_[used_] = way_y;
  ++used_;
}

double FluxSides::flux(double x, double y) const {
  return HWY_DYNAMIC_DISPATCH(flux)(from_x_.size(), from_x_.data(), from_y_.data(), way_x_.data(),
                                    way_y_.data(), x, y);
}

}  // namespace petzval
#endif
