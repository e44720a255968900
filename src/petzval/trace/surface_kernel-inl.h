// SPDX-License-Identifier: BSD-3-Clause
// One surface, one vector of rays: meeting it, clipping, refraction. Included once per instruction set.
#if defined(PETZVAL_TRACE_SURFACE_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_TRACE_SURFACE_KERNEL_INL_H_
#undef PETZVAL_TRACE_SURFACE_KERNEL_INL_H_
#else
#define PETZVAL_TRACE_SURFACE_KERNEL_INL_H_
#endif

#include <hwy/highway.h>
#include <petzval/lens/bend-inl.h>
#include <petzval/trace/batch_kernel.h>
#include <petzval/trace/surface_meet-inl.h>

#include <limits>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

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
constexpr T newton_base_mm = has_path<T> ? T(1e-12) : T(1e-7);
template <class T>
constexpr T newton_share = has_path<T> ? T(0) : 8 * std::numeric_limits<T>::epsilon();
constexpr int newton_iterations = 20;

/// Rays relative to the vertex of the surface they are at. A ray that misses or is totally reflected turns
/// into NaN, which fails every later comparison; `alive` holds the rest. A trace that measures clips nothing
/// and keeps the largest (r/r_clear)² instead.
template <class T, bool measures>
struct RayVector : RayAt<Vector<T>> {
  Vector<T> opl, worst;
  Mask<T> alive;
};

template <class T, bool measures>
HWY_ATTR HWY_INLINE void advance(const KernelSurface<T>& surface, Vector<T> distance,
                                 RayVector<T, measures>& ray) {
  advance_point<Vector<T>>(distance, ray);
  if constexpr (has_path<T> && !measures)
    ray.opl = hn::MulAdd(hn::Set(Lanes<T>(), surface.index_before), distance, ray.opl);
}

/// From lens space into a frame, and back.
template <class T, bool measures>
HWY_ATTR HWY_INLINE void into_frame(const KernelFrame<T>& frame, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  const auto along = [&](std::size_t axis, auto x, auto y, auto z) HWY_ATTR {
    return hn::MulAdd(
        hn::Set(d, frame.rows[0][axis]), x,
        hn::MulAdd(hn::Set(d, frame.rows[1][axis]), y, hn::Mul(hn::Set(d, frame.rows[2][axis]), z)));
  };
  const auto x = hn::Sub(ray.x, hn::Set(d, frame.offset_mm[0]));
  const auto y = hn::Sub(ray.y, hn::Set(d, frame.offset_mm[1]));
  const auto z = hn::Sub(ray.z, hn::Set(d, frame.offset_mm[2]));
  const auto l = ray.l, m = ray.m, n = ray.n;
  ray.x = along(0, x, y, z), ray.y = along(1, x, y, z), ray.z = along(2, x, y, z);
  ray.l = along(0, l, m, n), ray.m = along(1, l, m, n), ray.n = along(2, l, m, n);
}

template <class T, bool measures>
HWY_ATTR HWY_INLINE void out_of_frame(const KernelFrame<T>& frame, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  const auto along = [&](std::size_t axis, auto x, auto y, auto z, auto from) HWY_ATTR {
    return hn::MulAdd(
        hn::Set(d, frame.rows[axis][0]), x,
        hn::MulAdd(hn::Set(d, frame.rows[axis][1]), y, hn::MulAdd(hn::Set(d, frame.rows[axis][2]), z, from)));
  };
  const auto x = ray.x, y = ray.y, z = ray.z, l = ray.l, m = ray.m, n = ray.n, zero = hn::Zero(d);
  ray.x = along(0, x, y, z, hn::Set(d, frame.offset_mm[0]));
  ray.y = along(1, x, y, z, hn::Set(d, frame.offset_mm[1]));
  ray.z = along(2, x, y, z, hn::Set(d, frame.offset_mm[2]));
  ray.l = along(0, l, m, n, zero), ray.m = along(1, l, m, n, zero), ray.n = along(2, l, m, n, zero);
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

/// Figures beside the round aperture. A trace that measures looks for the outer edge of a pupil: it passes
/// over what is closed inside.
template <class T, bool measures>
HWY_ATTR HWY_INLINE void clip_by_figures(const KernelSurface<T>& surface, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  for (const KernelAperture<T>& figure : surface.apertures) {
    if (measures && figure.obscures) continue;
    const auto x = hn::MulAdd(hn::Set(d, figure.a), ray.x,
                              hn::MulAdd(hn::Set(d, figure.b), ray.y, hn::Set(d, figure.e)));
    const auto y = hn::MulAdd(hn::Set(d, figure.c), ray.x,
                              hn::MulAdd(hn::Set(d, figure.d), ray.y, hn::Set(d, figure.f)));
    const auto x_sq = hn::Mul(x, x), y_sq = hn::Mul(y, y);
    const auto reach_sq = figure.rectangle ? hn::Max(x_sq, y_sq) : hn::Add(x_sq, y_sq);
    if constexpr (measures) {
      ray.worst = hn::Max(ray.worst, reach_sq);
    } else {
      const auto edge = hn::Set(d, T(1) + (figure.obscures ? T(-1) : T(1)) * surface.figure_tolerance);
      ray.alive = hn::And(ray.alive, figure.obscures ? hn::Ge(reach_sq, edge) : hn::Le(reach_sq, edge));
    }
  }
}

/// What refraction with an index ratio of −1 has made is the ray thrown back, turned round.
template <class T, bool measures>
HWY_ATTR HWY_INLINE void turn_back(RayVector<T, measures>& ray) {
  ray.l = hn::Neg(ray.l), ray.m = hn::Neg(ray.m), ray.n = hn::Neg(ray.n);
}

/// Into the mirror image z → −z, in which the light goes on towards +z.
template <class T, bool measures>
HWY_ATTR HWY_INLINE void flip_z(RayVector<T, measures>& ray) {
  ray.z = hn::Neg(ray.z), ray.n = hn::Neg(ray.n);
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
  if (!surface.apertures.empty()) clip_by_figures(surface, ray);
}

template <class T, bool measures>
HWY_ATTR HWY_INLINE void step_plane(const KernelSurface<T>& surface, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  ray.alive = hn::And(ray.alive, hn::Gt(ray.n, hn::Zero(d)));
  advance(surface, distance_to_plane<Vector<T>>(ray), ray);
  ray.z = hn::Zero(d);
  clip(surface, ray);
  if (surface.index_ratio == 1) return;
  const auto e = hn::Set(d, surface.index_ratio);
  ray.l = hn::Mul(e, ray.l);
  ray.m = hn::Mul(e, ray.m);
  ray.n = hn::Sqrt(hn::MulAdd(hn::Set(d, surface.index_ratio_sq), hn::Mul(ray.n, ray.n),
                              hn::Set(d, surface.one_minus_index_ratio_sq)));
}

template <class T>
HWY_ATTR HWY_INLINE ConicSurface<Vector<T>> conic_of(const KernelSurface<T>& surface) {
  const Lanes<T> d;
  return {hn::Set(d, surface.curvature), hn::Set(d, surface.shape.conic),
          hn::Set(d, surface.shape.one_plus_conic)};
}

template <class T, bool measures>
HWY_ATTR HWY_INLINE void step_sphere(const KernelSurface<T>& surface, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  const Crossing<Vector<T>> crossing = cross<false, Vector<T>>(conic_of(surface), ray);
  advance(surface, crossing.distance, ray);
  const auto c = hn::Set(d, surface.curvature);
  const auto normal_z = gradient_z(c, ray.z);
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
  const Crossing<Vector<T>> crossing = cross<true, Vector<T>>(conic_of(surface), ray);
  advance(surface, crossing.distance, ray);
  const auto c = hn::Set(d, surface.curvature);
  const auto gx = hn::Neg(hn::Mul(c, ray.x)), gy = hn::Neg(hn::Mul(c, ray.y));
  const auto gz = gradient_z(hn::Set(d, surface.curvature * surface.shape.one_plus_conic), ray.z);
  ray.alive = hn::And(ray.alive, hn::Gt(gz, hn::Zero(d)));
  clip(surface, ray);
  refract(surface, gx, gy, gz, crossing.slope, ray);
}

/// A grating or an ideal lens on the plane, sphere or conic that the ray has been carried to.
template <class T, bool measures>
HWY_ATTR HWY_INLINE void step_bend(const KernelSurface<T>& surface, RayVector<T, measures>& ray) {
  using V = Vector<T>;
  const Lanes<T> d;
  const auto c = hn::Set(d, surface.curvature);
  BentRay<V> bent{ray.x,
                  ray.y,
                  hn::Neg(hn::Mul(c, ray.x)),
                  hn::Neg(hn::Mul(c, ray.y)),
                  gradient_z(hn::Set(d, surface.curvature * surface.shape.one_plus_conic), ray.z),
                  ray.l,
                  ray.m,
                  ray.n,
                  hn::Zero(d)};
  bend(*surface.bend, bent);
  ray.l = bent.l, ray.m = bent.m, ray.n = bent.n;
  if constexpr (has_path<T> && !measures) ray.opl = hn::Add(ray.opl, bent.path);
}

/// Of a kind that has no closed form.
template <class Kind, class T, bool measures>
HWY_ATTR HWY_INLINE void step_iterated(const KernelSurface<T>& surface, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  const auto from_conic = cross<true, Vector<T>>(conic_of(surface), ray).distance;
  advance(surface, choose(is_number(from_conic), from_conic, distance_to_plane<Vector<T>>(ray)), ray);
  // From here on the distance is short, and so is its rounding.
  const auto size = hn::Add(hn::Abs(ray.x), hn::Add(hn::Abs(ray.y), hn::Abs(ray.z)));
  const auto tolerance = hn::MulAdd(size, hn::Set(d, newton_share<T>), hn::Set(d, newton_base_mm<T>));
  const auto flip = hn::Set(d, surface.flip), zero = hn::Zero(d);
  const RayAt<Vector<T>> start = ray;
  Approach<Vector<T>> at{zero, zero, zero, zero, zero};
  for (int i = 0; i < newton_iterations; ++i) {
    approach<Kind, !has_path<T>>(surface.shape, flip, start, tolerance, at);
    if (hn::AllFalse(d, hn::And(ray.alive, hn::Ge(at.error, tolerance)))) break;
  }
  advance(surface, at.distance, ray);
  ray.alive = hn::And(ray.alive, hn::And(hn::Lt(at.error, tolerance), hn::Gt(at.slope, zero)));
  clip(surface, ray);
  refract(surface, at.gradient_x, at.gradient_y, hn::Set(d, T(1)), at.slope, ray);
}

template <class Kind, class Ray, class T, std::size_t count>
HWY_ATTR HWY_INLINE void step_each(const KernelSurface<T>& surface, Ray (&rays)[count]) {
  for (Ray& ray : rays) step_iterated<Kind>(surface, ray);
}

template <class Ray, class T, std::size_t count, class... Kind>
HWY_ATTR HWY_INLINE void step_added(KindList<Kind...>, [[maybe_unused]] const KernelSurface<T>& surface,
                                    [[maybe_unused]] Ray (&rays)[count]) {
  [[maybe_unused]] std::size_t i = 0;
  ((surface.shape.added == i++ ? step_each<Kind>(surface, rays) : void()), ...);
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_TRACE_SURFACE_KERNEL_INL_H_
