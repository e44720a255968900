// SPDX-License-Identifier: BSD-3-Clause
// Rays at a grating or an ideal lens: one text for single rays, for vectors of them and for numbers with
// derivatives. Included once per instruction set.
#if defined(PETZVAL_LENS_BEND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_LENS_BEND_INL_H_
#undef PETZVAL_LENS_BEND_INL_H_
#else
#define PETZVAL_LENS_BEND_INL_H_
#endif

#include <petzval/lens/bend_data.h>
#include <petzval/lens/shapes/numbers-inl.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

/// A ray where it meets the surface, z in the sense of travel; a gradient of the surface there, its z > 0;
/// the unit direction, which is altered; and what the phase adds to the optical path [mm].
template <class V>
struct BentRay {
  V x, y;
  V gradient_x, gradient_y, gradient_z;
  V l, m, n;
  V path;
};

/// Along the surface n' d' = n d + λ m grad(lines), by which also the phase grows (Welford, Aberrations of
/// Optical Systems, 1986, ch. 5): the same whichever way light goes. NaN where the order is evanescent. Light
/// thrown back leaves turned round.
template <class V, class T>
HWY_INLINE void bend_by_grating(const BendData<T>& data, BentRay<V>& ray) {
  const V before = constant<V>(data.index_before), after = constant<V>(data.index_after);
  const V ax = constant<V>(data.along_x), ay = constant<V>(data.along_y);
  const V square = mul_add(ray.gradient_x, ray.gradient_x,
                           mul_add(ray.gradient_y, ray.gradient_y, ray.gradient_z * ray.gradient_z));
  const V scale = constant<V>(1) / square_root(square);
  const V nx = ray.gradient_x * scale, ny = ray.gradient_y * scale, nz = ray.gradient_z * scale;
  const V px = mul_add(before, ray.l, ax), py = mul_add(before, ray.m, ay), pz = before * ray.n;
  const V normal = mul_add(px, nx, mul_add(py, ny, pz * nz));
  const V tx = neg_mul_add(normal, nx, px), ty = neg_mul_add(normal, ny, py),
          tz = neg_mul_add(normal, nz, pz);
  const V along_sq = mul_add(tx, tx, mul_add(ty, ty, tz * tz));
  const V rest = square_root(neg_mul_add(along_sq, constant<V>(1), after * after));
  const V per_index = constant<V>(data.mirror ? -1 : 1) / after;
  const V through = data.mirror ? constant<V>(0) - rest : rest;
  ray.l = mul_add(through, nx, tx) * per_index;
  ray.m = mul_add(through, ny, ty) * per_index;
  ray.n = mul_add(through, nz, tz) * per_index;
  ray.path = mul_add(ax, ray.x, ay * ray.y);
}

/// From the plane's middle to the object less the way from where the ray is, index times. κ = 1/distance may
/// be 0. \param p, q  slopes of the ray along x and y, turned round where it is an image.
template <class V>
HWY_INLINE V shorter_by(V index, V kappa, V x, V y, V p, V q) {
  const V one = constant<V>(1);
  const V across_x = kappa * x - p, across_y = kappa * y - q;
  const V from_middle = square_root(mul_add(across_x, across_x, mul_add(across_y, across_y, one)));
  const V from_ray = square_root(mul_add(p, p, mul_add(q, q, one)));
  const V w = mul_add(p, x, q * y);
  return index * (kappa * mul_add(x, x, y * y) - w - w) / (from_middle + from_ray);
}

template <class V, class T>
HWY_INLINE void bend_by_ideal_lens(const BendData<T>& data, BentRay<V>& ray) {
  const V one = constant<V>(1), before = constant<V>(data.index_before),
          after = constant<V>(data.index_after);
  const V power = constant<V>(data.power);
  const V p = ray.l / ray.n, q = ray.m / ray.n;
  const V p_after = (before * p - power * ray.x) / after, q_after = (before * q - power * ray.y) / after;
  const V minus_one = constant<V>(-1);
  ray.path = shorter_by(before, constant<V>(data.vergence_before) / before, ray.x, ray.y, p, q) +
             shorter_by(after, constant<V>(data.vergence_after) / after, ray.x, ray.y, minus_one * p_after,
                        minus_one * q_after);
  ray.n = one / square_root(mul_add(p_after, p_after, mul_add(q_after, q_after, one)));
  ray.l = p_after * ray.n;
  ray.m = q_after * ray.n;
}

template <class V, class T>
HWY_INLINE void bend(const BendData<T>& data, BentRay<V>& ray) {
  if (data.kind == BendData<T>::Kind::grating)
    bend_by_grating(data, ray);
  else
    bend_by_ideal_lens(data, ray);
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_LENS_BEND_INL_H_
