// SPDX-License-Identifier: BSD-3-Clause
// Where a ray meets a surface: one text for single rays in double and for vectors of them. Coordinates are
// relative to the vertex, and z runs in the sense of travel: a backward ray is met by the mirror image
// z → −z. A ray that misses gets NaN. Included once per instruction set.
#if defined(PETZVAL_TRACE_SURFACE_MEET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_TRACE_SURFACE_MEET_INL_H_
#undef PETZVAL_TRACE_SURFACE_MEET_INL_H_
#else
#define PETZVAL_TRACE_SURFACE_MEET_INL_H_
#endif

#include <petzval/lens/shapes/added_kinds-inl.h>
#include <petzval/lens/shapes/powers-inl.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

/// A ray relative to the vertex of the surface that it is about to meet: point [mm] and unit direction.
template <class V>
struct RayAt {
  V x, y, z, l, m, n;
};

template <class V>
HWY_INLINE void advance_point(V distance, RayAt<V>& ray) {
  ray.x = mul_add(distance, ray.l, ray.x);
  ray.y = mul_add(distance, ray.m, ray.y);
  ray.z = mul_add(distance, ray.n, ray.z);
}

template <class V>
HWY_INLINE V distance_to_plane(const RayAt<V>& ray) {
  return negative(ray.z / ray.n);
}

/// The sphere or conic c(x² + y² + (1+k)z²) = 2z.
template <class V>
struct ConicSurface {
  V curvature, conic, one_plus_conic;
};

/// The signed distance to the sheet that the ray crosses towards +z, the direction times the gradient there,
/// and its square.
template <class V>
struct Crossing {
  V distance, slope, slope_sq;
};

template <bool is_conic, class V>
HWY_INLINE Crossing<V> cross(const ConicSurface<V>& surface, const RayAt<V>& ray) {
  const V c = surface.curvature;
  V qz = ray.z, qnz = ray.n * ray.z, a = c;
  if constexpr (is_conic) {
    qz = surface.one_plus_conic * ray.z;
    qnz = product(surface.one_plus_conic, ray.n, ray.z);
    a = c * square_mul_add(surface.conic, ray.n, constant<V>(1));
  }
  const V square = dot_add(ray.x, ray.x, ray.y, ray.y, qz * ray.z);
  const V along = dot_add(ray.l, ray.x, ray.m, ray.y, qnz);
  const V f = mul_sub(c, square, ray.z + ray.z);
  const V g = neg_mul_add(c, along, ray.n);
  Crossing<V> crossing;
  crossing.slope_sq = neg_mul_add(a, f, g * g);
  crossing.slope = square_root(crossing.slope_sq);
  // F/(G + √), or (G − √)/A where that would cancel.
  const auto cancels = is_below(g, constant<V>(0));
  crossing.distance = choose_ratio(cancels, g - crossing.slope, a, f, g + crossing.slope);
  return crossing;
}

/// The z of a conic's gradient (−cx, −cy, 1 − c(1+k)z): positive on the sheet through the vertex.
/// \param c_q  c(1+k)
template <class V>
HWY_INLINE V gradient_z(V c_q, V z) {
  return neg_mul_add(c_q, z, constant<V>(1));
}

/// Newton along a ray that is already near the surface.
template <class V>
struct Approach {
  V distance, gradient_x, gradient_y;  ///< the z of the gradient is 1
  V slope;                             ///< direction · gradient
  V error;                             ///< |z − sag| at the last step but one, or where it stopped
};

/// One step. \param flip  −1 where z runs against that of the lens. A ray within `tolerance` stays where it
/// is, whatever its neighbours still need; with `refines` it takes this last step too.
template <class Kind, bool refines, class V, class T>
HWY_INLINE void approach(const ShapeData<T>& shape, V flip, const RayAt<V>& start, V tolerance,
                         Approach<V>& at) {
  const V x = mul_add(at.distance, start.l, start.x), y = mul_add(at.distance, start.m, start.y);
  const V z = mul_add(at.distance, start.n, start.z);
  const SurfacePoint<V> point = Kind::at(shape, x, y);
  const V error = z - flip * point.sag;
  at.gradient_x = negative(flip * point.slope_x);
  at.gradient_y = negative(flip * point.slope_y);
  at.slope = dot_add(start.l, at.gradient_x, start.m, at.gradient_y, start.n);
  at.error = magnitude(error);
  const V next = at.distance - error / at.slope;
  at.distance = refines ? next : choose(is_below(at.error, tolerance), at.distance, next);
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_TRACE_SURFACE_MEET_INL_H_
