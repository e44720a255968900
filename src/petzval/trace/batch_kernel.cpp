// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/trace/batch_kernel.h>

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/trace/batch_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>
#include <petzval/trace/surface_kernel-inl.h>
#include <petzval/trace/transfer_kernel-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

/// Vectors in flight together.
constexpr std::size_t interleaved = 3;
/// Room for a group of the widest vectors.
template <class T>
constexpr std::size_t widest_group = interleaved* HWY_MAX_BYTES / sizeof(T);

template <class T, bool measures>
HWY_ATTR HWY_INLINE void step_surface(const KernelSurface<T>& surface,
                                      RayVector<T, measures> (&rays)[interleaved]) {
  switch (surface.shape.form) {
    case ShapeForm::plane:
      for (RayVector<T, measures>& ray : rays) step_plane(surface, ray);
      return;
    case ShapeForm::sphere:
      for (RayVector<T, measures>& ray : rays) step_sphere(surface, ray);
      return;
    case ShapeForm::conic:
      for (RayVector<T, measures>& ray : rays) step_conic(surface, ray);
      return;
    case ShapeForm::powers:
      return step_each<Powers<false>>(surface, rays);
    case ShapeForm::even_powers:
      return step_each<Powers<true>>(surface, rays);
    case ShapeForm::added:
      return step_added(AddedKinds(), surface, rays);
  }
}

template <class T, bool measures>
HWY_ATTR HWY_INLINE void step(const KernelSurface<T>& surface, RayVector<T, measures> (&rays)[interleaved]) {
  const auto to_vertex = hn::Set(Lanes<T>(), surface.to_vertex_mm);
  for (RayVector<T, measures>& ray : rays) ray.z = hn::Add(ray.z, to_vertex);
  if (surface.posed)
    for (RayVector<T, measures>& ray : rays) into_frame(surface.frame, ray);
  if (surface.transfer)
    for (RayVector<T, measures>& ray : rays) step_transfer(surface, ray);
  else
    step_surface(surface, rays);
  if (surface.bend)
    for (RayVector<T, measures>& ray : rays) step_bend(surface, ray);
  if (surface.mirror)
    for (RayVector<T, measures>& ray : rays) turn_back(ray);
  if (surface.posed)
    for (RayVector<T, measures>& ray : rays) out_of_frame(surface.frame, ray);
  if (surface.mirror)
    for (RayVector<T, measures>& ray : rays) flip_z(ray);
}

/// To the image plane, and NaN is dead.
template <class T, bool measures>
HWY_ATTR HWY_INLINE void finish(const KernelPath<T>& path, RayVector<T, measures>& ray) {
  const Lanes<T> d;
  if (path.to_image) {
    const auto gap = hn::Set(d, path.image_z_mm - path.last_vertex_z_mm);
    if (path.sensor_posed) {
      ray.z = hn::Sub(ray.z, gap);
      into_frame(path.sensor, ray);
      ray.z = hn::Add(ray.z, gap);
    }
    const auto distance = hn::Div(hn::Sub(gap, ray.z), ray.n);
    ray.x = hn::MulAdd(distance, ray.l, ray.x);
    ray.y = hn::MulAdd(distance, ray.m, ray.y);
    ray.z = gap;
    if constexpr (has_path<T> && !measures)
      ray.opl = hn::MulAdd(hn::Set(d, path.image_index), distance, ray.opl);
    ray.alive = hn::And(ray.alive, hn::Gt(ray.n, hn::Zero(d)));
  }
  const auto sum = hn::Add(hn::Add(ray.x, ray.y), ray.n);
  ray.alive = hn::And(ray.alive, hn::Eq(sum, sum));
}

template <class T, bool measures>
HWY_ATTR HWY_INLINE void load(const KernelPath<T>& path, const RayColumns<T>& rays, std::size_t at,
                              RayVector<T, measures>& ray) {
  const Lanes<T> d;
  const auto flip = hn::Set(d, path.flip);
  ray.x = hn::LoadU(d, rays.x + at);
  ray.y = hn::LoadU(d, rays.y + at);
  ray.z = hn::MulSub(flip, hn::LoadU(d, rays.z + at), hn::Set(d, path.first_vertex_z_mm));
  ray.l = hn::LoadU(d, rays.l + at);
  ray.m = hn::LoadU(d, rays.m + at);
  ray.n = hn::Mul(flip, hn::LoadU(d, rays.n + at));
  if (!path.to_image && path.sensor_posed) {
    const auto to_first = hn::Set(d, path.sensor_to_first_mm);
    ray.z = hn::Sub(ray.z, to_first);
    out_of_frame(path.sensor, ray);
    ray.z = hn::Add(ray.z, to_first);
  }
  if constexpr (has_path<T>) {
    if constexpr (!measures) ray.opl = hn::LoadU(d, rays.opl + at);
  } else {
    // What float loses of the unit length would count again at every surface.
    const auto length_sq = hn::MulAdd(ray.l, ray.l, hn::MulAdd(ray.m, ray.m, hn::Mul(ray.n, ray.n)));
    const auto scale = hn::Div(hn::Set(d, T(1)), hn::Sqrt(length_sq));
    ray.l = hn::Mul(ray.l, scale);
    ray.m = hn::Mul(ray.m, scale);
    ray.n = hn::Mul(ray.n, scale);
  }
  // To the point nearest to the first vertex: from far away the quadratic would lose its digits.
  const auto back = hn::MulAdd(ray.x, ray.l, hn::MulAdd(ray.y, ray.m, hn::Mul(ray.z, ray.n)));
  ray.x = hn::NegMulAdd(back, ray.l, ray.x);
  ray.y = hn::NegMulAdd(back, ray.m, ray.y);
  ray.z = hn::NegMulAdd(back, ray.n, ray.z);
  if constexpr (has_path<T> && !measures)
    ray.opl = hn::NegMulAdd(hn::Set(d, path.surfaces.front().index_before), back, ray.opl);
  ray.worst = hn::Zero(d);
  ray.alive = hn::Eq(ray.z, ray.z);
}

HWY_ATTR HWY_INLINE void store_mask(Mask<double> mask, std::uint8_t* to) {
  const Lanes<double> d;
  const hn::Rebind<std::int32_t, Lanes<double>> narrow;
  const hn::Rebind<std::uint8_t, Lanes<double>> bytes;
  const auto ones = hn::IfThenElseZero(mask, hn::Set(d, 1.0));
  hn::StoreU(hn::DemoteTo(bytes, hn::DemoteTo(narrow, ones)), bytes, to);
}

HWY_ATTR HWY_INLINE void store_mask(Mask<float> mask, std::uint8_t* to) {
  const Lanes<float> d;
  const hn::Rebind<std::int32_t, Lanes<float>> whole;
  const hn::Rebind<std::uint8_t, Lanes<float>> bytes;
  const auto ones = hn::IfThenElseZero(mask, hn::Set(d, 1.0f));
  hn::StoreU(hn::DemoteTo(bytes, hn::ConvertTo(whole, ones)), bytes, to);
}

template <class T>
HWY_ATTR HWY_INLINE void store(const KernelPath<T>& path, const RayVector<T, false>& ray, std::size_t at,
                               const RayColumns<T>& rays) {
  const Lanes<T> d;
  const auto flip = hn::Set(d, path.flip);
  hn::BlendedStore(ray.x, ray.alive, d, rays.x + at);
  hn::BlendedStore(ray.y, ray.alive, d, rays.y + at);
  hn::BlendedStore(hn::Mul(flip, hn::Add(ray.z, hn::Set(d, path.last_vertex_z_mm))), ray.alive, d,
                   rays.z + at);
  hn::BlendedStore(ray.l, ray.alive, d, rays.l + at);
  hn::BlendedStore(ray.m, ray.alive, d, rays.m + at);
  hn::BlendedStore(hn::Mul(flip, ray.n), ray.alive, d, rays.n + at);
  if constexpr (has_path<T>) hn::BlendedStore(ray.opl, ray.alive, d, rays.opl + at);
  store_mask(ray.alive, rays.passes + at);
}

/// One group from launch to end.
template <class T, bool measures>
HWY_ATTR HWY_INLINE void run_group(const KernelPath<T>& path, const RayColumns<T>& rays, std::size_t at,
                                   RayVector<T, measures> (&group)[interleaved]) {
  const Lanes<T> d;
  for (std::size_t i = 0; i < interleaved; ++i) load(path, rays, at + i * hn::Lanes(d), group[i]);
  for (const KernelSurface<T>& surface : path.surfaces) {
    step(surface, group);
    if (!measures && surface.clips &&
        hn::AllFalse(d, hn::Or(group[0].alive, hn::Or(group[1].alive, group[2].alive))))
      break;
  }
  for (RayVector<T, measures>& ray : group) finish(path, ray);
}

template <class T>
HWY_ATTR HWY_INLINE void trace_group(const KernelPath<T>& path, const RayColumns<T>& rays, std::size_t at) {
  RayVector<T, false> group[interleaved];
  run_group(path, rays, at, group);
  for (std::size_t i = 0; i < interleaved; ++i) store(path, group[i], at + i * hn::Lanes(Lanes<T>()), rays);
}

HWY_ATTR HWY_INLINE void measure_group(const KernelPath<double>& path, const RayColumns<double>& rays,
                                       std::size_t at, double* worst) {
  const Lanes<double> d;
  RayVector<double, true> group[interleaved];
  run_group(path, rays, at, group);
  const auto lost = hn::Set(d, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < interleaved; ++i) {
    const auto excess = hn::Sub(group[i].worst, hn::Set(d, 1.0));
    hn::StoreU(hn::IfThenElse(group[i].alive, excess, lost), d, worst + at + i * hn::Lanes(d));
  }
}

/// The rays that fill no group, by way of a group of their own: every ray goes through the same arithmetic.
template <class T>
HWY_ATTR void trace_rest(const KernelPath<T>& path, const RayColumns<T>& rays, std::size_t at) {
  constexpr std::size_t columns = has_path<T> ? 7 : 6;
  HWY_ALIGN T room[7][widest_group<T>] = {};
  HWY_ALIGN std::uint8_t passes[widest_group<T>];
  T* const from[7] = {rays.x, rays.y, rays.z, rays.l, rays.m, rays.n, rays.opl};
  const std::size_t rest = rays.count - at;
  for (std::size_t c = 0; c < columns; ++c) std::copy_n(from[c] + at, rest, room[c]);
  trace_group(path, {room[0], room[1], room[2], room[3], room[4], room[5], room[6], passes, rest}, 0);
  for (std::size_t c = 0; c < columns; ++c) std::copy_n(room[c], rest, from[c] + at);
  std::copy_n(passes, rest, rays.passes + at);
}

template <class T>
HWY_ATTR void trace_all(const KernelPath<T>& path, const RayColumns<T>& rays) {
  const std::size_t group = interleaved * hn::Lanes(Lanes<T>());
  std::size_t at = 0;
  for (; at + group <= rays.count; at += group) trace_group(path, rays, at);
  if (at < rays.count) trace_rest(path, rays, at);
}

HWY_ATTR void measure_double(const KernelPath<double>& path, const RayColumns<double>& rays, double* worst) {
  const std::size_t group = interleaved * hn::Lanes(Lanes<double>());
  std::size_t at = 0;
  for (; at + group <= rays.count; at += group) measure_group(path, rays, at, worst);
  if (at == rays.count) return;
  HWY_ALIGN double room[7][widest_group<double>] = {};
  HWY_ALIGN double rest_worst[widest_group<double>];
  const double* const from[6] = {rays.x, rays.y, rays.z, rays.l, rays.m, rays.n};
  for (std::size_t c = 0; c < 6; ++c) std::copy_n(from[c] + at, rays.count - at, room[c]);
  measure_group(path,
                {room[0], room[1], room[2], room[3], room[4], room[5], room[6], nullptr, rays.count - at}, 0,
                rest_worst);
  std::copy_n(rest_worst, rays.count - at, worst + at);
}

HWY_ATTR void trace_double(const KernelPath<double>& path, const RayColumns<double>& rays) {
  trace_all(path, rays);
}
HWY_ATTR void trace_float(const KernelPath<float>& path, const RayColumns<float>& rays) {
  trace_all(path, rays);
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(trace_double);
HWY_EXPORT(trace_float);
HWY_EXPORT(measure_double);

void trace_columns(const KernelPath<double>& path, const RayColumns<double>& rays) {
  HWY_DYNAMIC_DISPATCH(trace_double)(path, rays);
}
void trace_columns(const KernelPath<float>& path, const RayColumns<float>& rays) {
  HWY_DYNAMIC_DISPATCH(trace_float)(path, rays);
}

void measure_columns(const KernelPath<double>& path, const RayColumns<double>& rays, double* worst) {
  HWY_DYNAMIC_DISPATCH(measure_double)(path, rays, worst);
}

}  // namespace petzval
#endif
