// SPDX-License-Identifier: BSD-3-Clause
// A ray transfer, one vector of rays. Included once per instruction set.
#if defined(PETZVAL_TRACE_TRANSFER_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_TRACE_TRANSFER_KERNEL_INL_H_
#undef PETZVAL_TRACE_TRANSFER_KERNEL_INL_H_
#else
#define PETZVAL_TRACE_TRANSFER_KERNEL_INL_H_
#endif

#include <petzval/lens/transfer-inl.h>
#include <petzval/trace/surface_kernel-inl.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

/// The clip at the stop, in its coordinates, and at the other apertures.
template <class T, bool measures>
HWY_ATTR HWY_INLINE void clip_transfer(const KernelSurface<T>& surface, const CarriedRay<Vector<T>>& carried,
                                       RayVector<T, measures>& ray) {
  const Lanes<T> d;
  RayVector<T, measures> at_stop = ray;
  at_stop.x = carried.stop_x, at_stop.y = carried.stop_y;
  clip(surface, at_stop);
  ray.alive = at_stop.alive, ray.worst = at_stop.worst;
  const auto share =
      hn::Mul(hn::MulAdd(carried.stop_x, carried.stop_x, hn::Mul(carried.stop_y, carried.stop_y)),
              hn::Set(d, 1 / (surface.transfer->stop_radius * surface.transfer->stop_radius)));
  ray.alive = hn::And(ray.alive, hn::Le(share, hn::Set(d, T(transfer_reach_sq))));
  if (!surface.clips_others) return;
  if constexpr (measures)
    ray.worst = hn::Max(ray.worst, carried.others_sq);
  else
    ray.alive = hn::And(ray.alive, hn::Le(carried.others_sq, hn::Set(d, T(transfer_rim))));
}

template <class T, bool measures>
HWY_ATTR HWY_INLINE void step_transfer(const KernelSurface<T>& surface, RayVector<T, measures>& ray) {
  using V = Vector<T>;
  const Lanes<T> d;
  const TransferData<T>& transfer = *surface.transfer;
  const bool backward = surface.flip < 0;
  ray.alive = hn::And(ray.alive, hn::Gt(ray.n, hn::Zero(d)));
  // z runs in the sense of travel: the rear plane is before the front plane of a backward ray.
  const auto length = hn::Set(d, transfer.length_mm);
  if (backward) ray.z = hn::Add(ray.z, length);
  advance(surface, distance_to_plane<V>(ray), ray);
  ray.z = hn::Zero(d);
  PlaneRay<V> rear{ray.x, ray.y, ray.l, ray.m};
  const PlaneRay<V> in_front{ray.x, ray.y, hn::Neg(ray.l), hn::Neg(ray.m)};
  CarriedRay<V> carried;
  if (backward) {
    carried = carry_back(transfer, rear);
  } else {
    ray.alive = hn::And(ray.alive, hn::Le(carry_forth(transfer, in_front, rear, carried),
                                          hn::Set(d, T(transfer_found_within))));
  }
  clip_transfer(surface, carried, ray);
  if constexpr (has_path<T> && !measures)
    if (surface.counts_path)
      ray.opl = hn::Add(ray.opl, transfer_path(transfer, backward ? carried.front : in_front, rear));
  const PlaneRay<V>& end = backward ? carried.front : rear;
  ray.x = end.x, ray.y = end.y;
  ray.l = backward ? end.l : hn::Neg(end.l), ray.m = backward ? end.m : hn::Neg(end.m);
  ray.n = hn::Sqrt(hn::NegMulAdd(end.l, end.l, hn::NegMulAdd(end.m, end.m, hn::Set(d, T(1)))));
  if (!backward) ray.z = length;
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_TRACE_TRANSFER_KERNEL_INL_H_
