// SPDX-License-Identifier: BSD-3-Clause
// One surface, one vector of rays: surface_step.cpp without its branches. Included once per instruction set.
#if defined(PETZVAL_TRACE_SURFACE_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_TRACE_SURFACE_KERNEL_INL_H_
#undef PETZVAL_TRACE_SURFACE_KERNEL_INL_H_
#else
#define PETZVAL_TRACE_SURFACE_KERNEL_INL_H_
#endif

#include <hwy/highway.h>
#include <petzval/trace/batch_kernel.h>

#include <limits>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
template <class T>
using Lanes = hn::ScalableTag<T>;
template <class T>
using Vector = hn::Vec<Lanes<T>>;
template <class T>
using Mask = hn::Mask<Lanes<T>>;

template <class T>
constexpr bool has_path = std::is_same_v<T, double>;

/// Newton stops when |z − sag| is below base + share·(|x| + |y| + |z|) [mm]. Float cannot resolve more, and
/// takes one more step from there.
template <class T>
constexpr T asphere_base_mm = has_path<T> ? T(1e-12) : T(1e-7);
template <class T>
constexpr T asphere_share = has_path<T> ? T(0) : 8 * std::numeric_limits<T>::epsilon();
constexpr int asphere_iterations = 20;

/// Rays relative to the vertex of the surface they are at. A ray that misses or is totally reflected turns
/// into NaN, which fails every later comparison; `alive` holds the rest. A trace that measures clips nothing
/// and keeps the largest (r/r_clear)² instead.
template <class T, bool measures>
struct RayVector {
  Vector<T> x, y, z, l, m, n, opl, worst;
  Mask<T> alive;
};

template <class T, bool measures>
HWY_ATTR HWY_INLINE void advance(const KernelSurface<T>& surface, Vector<T> distance,
                                 RayVector<T, measures>& ray) {
  ray.x = hn::MulAdd(distance, ray.l, ray.x);
  ray.y = hn::MulAdd(distance, ray.m, ray.y);
  ray.z = hn::MulAdd(distance, ray.n, ray.z);
  if constexpr (has_path<T> && !measures)
    ray.opl = hn::MulAdd(hn::Set(Lanes<T>(), surface.index_before), distance, ray.opl);
}

/// The blades of a stop.
template <class T, bool measures>
HWY_ATTR HWY_INLINE void clip_by_edges(const KernelSurface<T>& surface, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  auto farthest = hn::Zero(d);
  for (const auto& [x, y] : surface.edges)
    farthest = hn::Max(farthest, hn::MulAdd(ray.x, hn::Set(d, x), hn::Mul(ray.y, hn::Set(d, y))));
  if constexpr (measures) {
    const auto share = hn::Mul(farthest, hn::Set(d, surface.per_edge_distance));
    ray.worst = hn::Max(ray.worst, hn::Mul(share, share));
  } else {
    ray.alive = hn::And(ray.alive, hn::Le(farthest, hn::Set(d, surface.edge_distance)));
  }
}

template <class T, bool measures>
HWY_ATTR HWY_INLINE void clip(const KernelSurface<T>& surface, RayVector<T, measures>& ray) {
  if (!surface.clips) return;
  const auto radius_sq = hn::MulAdd(ray.x, ray.x, hn::Mul(ray.y, ray.y));
  if constexpr (measures)
    ray.worst = hn::Max(ray.worst, hn::Mul(radius_sq, hn::Set(Lanes<T>(), surface.per_clear_radius_sq)));
  else
    ray.alive = hn::And(ray.alive, hn::Le(radius_sq, hn::Set(Lanes<T>(), surface.clear_radius_sq)));
  if (!surface.edges.empty()) clip_by_edges(surface, ray);
}

template <class T, bool measures>
HWY_ATTR HWY_INLINE void step_plane(const KernelSurface<T>& surface, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  ray.alive = hn::And(ray.alive, hn::Gt(ray.n, hn::Zero(d)));
  advance(surface, hn::Neg(hn::Div(ray.z, ray.n)), ray);
  ray.z = hn::Zero(d);
  clip(surface, ray);
  if (surface.index_ratio == 1) return;
  const auto e = hn::Set(d, surface.index_ratio);
  ray.l = hn::Mul(e, ray.l);
  ray.m = hn::Mul(e, ray.m);
  ray.n = hn::Sqrt(hn::MulAdd(hn::Set(d, surface.index_ratio_sq), hn::Mul(ray.n, ray.n),
                              hn::Set(d, surface.one_minus_index_ratio_sq)));
}

/// Quadratic of a sphere or conic, c(x² + y² + (1+k)z²) = 2z: the signed distance to the sheet that the ray
/// crosses towards +z, the direction times the gradient there, and its square.
template <class T>
struct Crossing {
  Vector<T> distance, slope, slope_sq;
};

template <bool is_conic, class T, bool measures>
HWY_ATTR HWY_INLINE Crossing<T> cross(const KernelSurface<T>& surface, const RayVector<T, measures>& ray) {
  const Lanes<T> d;
  const auto c = hn::Set(d, surface.curvature);
  auto qz = ray.z, a = c;
  if constexpr (is_conic) {
    qz = hn::Mul(hn::Set(d, surface.one_plus_conic), ray.z);
    a = hn::Mul(c, hn::MulAdd(hn::Set(d, surface.conic), hn::Mul(ray.n, ray.n), hn::Set(d, T(1))));
  }
  const auto square = hn::MulAdd(ray.x, ray.x, hn::MulAdd(ray.y, ray.y, hn::Mul(qz, ray.z)));
  const auto along = hn::MulAdd(ray.l, ray.x, hn::MulAdd(ray.m, ray.y, hn::Mul(qz, ray.n)));
  const auto f = hn::MulSub(c, square, hn::Add(ray.z, ray.z));
  const auto g = hn::NegMulAdd(c, along, ray.n);
  Crossing<T> crossing;
  crossing.slope_sq = hn::NegMulAdd(a, f, hn::Mul(g, g));
  crossing.slope = hn::Sqrt(crossing.slope_sq);
  // F/(G + √), or (G − √)/A where that would cancel.
  const auto cancels = hn::Lt(g, hn::Zero(d));
  const auto above = hn::IfThenElse(cancels, hn::Sub(g, crossing.slope), f);
  const auto below = hn::IfThenElse(cancels, a, hn::Add(g, crossing.slope));
  crossing.distance = hn::Div(above, below);
  return crossing;
}

template <class T, bool measures>
HWY_ATTR HWY_INLINE void step_sphere(const KernelSurface<T>& surface, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  const Crossing<T> crossing = cross<false>(surface, ray);
  advance(surface, crossing.distance, ray);
  const auto c = hn::Set(d, surface.curvature);
  const auto normal_z = hn::NegMulAdd(c, ray.z, hn::Set(d, T(1)));
  ray.alive = hn::And(ray.alive, hn::Gt(normal_z, hn::Zero(d)));
  clip(surface, ray);
  const auto e = hn::Set(d, surface.index_ratio);
  const auto under = hn::MulAdd(hn::Set(d, surface.index_ratio_sq), crossing.slope_sq,
                                hn::Set(d, surface.one_minus_index_ratio_sq));
  const auto bend = hn::NegMulAdd(e, crossing.slope, hn::Sqrt(under));
  const auto bend_c = hn::Mul(bend, c);
  ray.l = hn::NegMulAdd(bend_c, ray.x, hn::Mul(e, ray.l));
  ray.m = hn::NegMulAdd(bend_c, ray.y, hn::Mul(e, ray.m));
  ray.n = hn::MulAdd(bend, normal_z, hn::Mul(e, ray.n));
}

/// Snell at a gradient that is not of unit length; `slope` is direction · gradient.
template <class T, bool measures>
HWY_ATTR HWY_INLINE void refract(const KernelSurface<T>& surface, Vector<T> gx, Vector<T> gy, Vector<T> gz,
                                 Vector<T> slope, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  const auto length_sq = hn::MulAdd(gx, gx, hn::MulAdd(gy, gy, hn::Mul(gz, gz)));
  const auto e = hn::Set(d, surface.index_ratio);
  const auto bent = hn::Mul(e, slope);
  const auto under = hn::MulAdd(bent, bent, hn::Mul(hn::Set(d, surface.one_minus_index_ratio_sq), length_sq));
  const auto bend = hn::Div(hn::Sub(hn::Sqrt(under), bent), length_sq);
  ray.l = hn::MulAdd(bend, gx, hn::Mul(e, ray.l));
  ray.m = hn::MulAdd(bend, gy, hn::Mul(e, ray.m));
  ray.n = hn::MulAdd(bend, gz, hn::Mul(e, ray.n));
}

template <class T, bool measures>
HWY_ATTR HWY_INLINE void step_conic(const KernelSurface<T>& surface, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  const Crossing<T> crossing = cross<true>(surface, ray);
  advance(surface, crossing.distance, ray);
  const auto c = hn::Set(d, surface.curvature);
  const auto gx = hn::Neg(hn::Mul(c, ray.x)), gy = hn::Neg(hn::Mul(c, ray.y));
  const auto gz =
      hn::NegMulAdd(hn::Set(d, surface.curvature * surface.one_plus_conic), ray.z, hn::Set(d, T(1)));
  ray.alive = hn::And(ray.alive, hn::Gt(gz, hn::Zero(d)));
  clip(surface, ray);
  refract(surface, gx, gy, gz, crossing.slope, ray);
}

/// Sag and (dz/dr)/r of an asphere at r²; NaN beyond the conic's rim.
template <class T>
HWY_ATTR HWY_INLINE void asphere_sag(const KernelSurface<T>& surface, Vector<T> r_sq, Vector<T>& sag,
                                     Vector<T>& slope_over_r) {
  const Lanes<T> d;
  const auto one = hn::Set(d, T(1));
  const bool even = surface.kind == KernelSurfaceKind::even_asphere;
  const auto r = even ? r_sq : hn::Sqrt(r_sq);
  const auto t = hn::Mul(r, hn::Set(d, surface.per_polynomial_unit));
  auto value = hn::Zero(d), rise = hn::Zero(d);  // Horner for the polynomial and its derivative
  for (std::size_t p = surface.polynomial.size(); p-- > 0;) {
    rise = hn::MulAdd(rise, t, value);
    value = hn::MulAdd(value, t, hn::Set(d, surface.polynomial[p]));
  }
  rise = hn::Mul(rise, hn::Set(d, even ? 2 * surface.per_polynomial_unit : surface.per_polynomial_unit));
  // A cone's tip has no slope over r; its x and y are zero there, and so is what comes of them.
  if (!even) rise = hn::Div(rise, hn::Max(r, hn::Set(d, T(1e-30))));
  const auto c = hn::Set(d, surface.curvature);
  const T q_c_sq = surface.one_plus_conic * surface.curvature * surface.curvature;
  const auto root = hn::Sqrt(hn::NegMulAdd(hn::Set(d, q_c_sq), r_sq, one));
  sag = hn::MulAdd(c, hn::Div(r_sq, hn::Add(one, root)), value);
  slope_over_r = hn::Add(hn::Div(c, root), rise);
}

template <class T, bool measures>
HWY_ATTR HWY_INLINE void step_asphere(const KernelSurface<T>& surface, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  const auto from_conic = cross<true>(surface, ray).distance;
  const auto from_plane = hn::Neg(hn::Div(ray.z, ray.n));
  advance(surface, hn::IfThenElse(hn::Eq(from_conic, from_conic), from_conic, from_plane), ray);
  // From here on the distance is short, and so is its rounding.
  const auto size = hn::Add(hn::Abs(ray.x), hn::Add(hn::Abs(ray.y), hn::Abs(ray.z)));
  const auto tolerance = hn::MulAdd(size, hn::Set(d, asphere_share<T>), hn::Set(d, asphere_base_mm<T>));
  const RayVector<T, measures> start = ray;
  auto distance = hn::Zero(d), gx = distance, gy = distance, slope = distance;
  auto close = hn::Lt(distance, distance);
  for (int i = 0; i < asphere_iterations; ++i) {
    const auto x = hn::MulAdd(distance, start.l, start.x), y = hn::MulAdd(distance, start.m, start.y);
    const auto z = hn::MulAdd(distance, start.n, start.z);
    Vector<T> sag, slope_over_r;
    asphere_sag(surface, hn::MulAdd(x, x, hn::Mul(y, y)), sag, slope_over_r);
    const auto error = hn::Sub(z, sag);
    gx = hn::Neg(hn::Mul(slope_over_r, x));
    gy = hn::Neg(hn::Mul(slope_over_r, y));
    slope = hn::MulAdd(start.l, gx, hn::MulAdd(start.m, gy, start.n));
    close = hn::Lt(hn::Abs(error), tolerance);
    const auto next = hn::Sub(distance, hn::Div(error, slope));
    // A ray that is close stays where it is, whatever its neighbours still need.
    distance = has_path<T> ? hn::IfThenElse(close, distance, next) : next;
    const auto pending = hn::And(start.alive, hn::Ge(hn::Abs(error), tolerance));
    if (hn::AllFalse(d, pending)) break;
  }
  advance(surface, distance, ray);
  ray.alive = hn::And(ray.alive, hn::And(close, hn::Gt(slope, hn::Zero(d))));
  clip(surface, ray);
  refract(surface, gx, gy, hn::Set(d, T(1)), slope, ray);
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_TRACE_SURFACE_KERNEL_INL_H_
