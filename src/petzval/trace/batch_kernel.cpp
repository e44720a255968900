// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/trace/batch_kernel.h>

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/trace/batch_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::ScalableTag<double>;
using Vector = hn::Vec<Lanes>;
using Mask = hn::Mask<Lanes>;

/// Vectors in flight together, so that the latencies of roots and divisions overlap.
constexpr std::size_t interleaved = 3;

struct RayVector {
  Vector x, y, z, l, m, n, opl;
  Mask clean;
};

/// One surface: the arithmetic of surface_step.cpp without its branches.
HWY_ATTR HWY_INLINE void step(const KernelSurface& surface, double sense, RayVector& ray) {
  const Lanes d;
  const auto c = hn::Set(d, surface.curvature), q = hn::Set(d, 1 + surface.conic);
  const auto s = hn::Set(d, sense);
  ray.z = hn::Add(ray.z, hn::Set(d, surface.to_vertex_mm));
  // F = c(x² + y² + qz²) − 2z, G = n − c(lx + my + qnz), A = c(1 + k n²); the distance is F/(G + s√(G² −
  // AF)).
  const auto qz = hn::Mul(q, ray.z);
  const auto square = hn::MulAdd(ray.x, ray.x, hn::MulAdd(ray.y, ray.y, hn::Mul(qz, ray.z)));
  const auto f = hn::MulSub(c, square, hn::Add(ray.z, ray.z));
  const auto along = hn::MulAdd(ray.l, ray.x, hn::MulAdd(ray.m, ray.y, hn::Mul(qz, ray.n)));
  const auto g = hn::NegMulAdd(c, along, ray.n);
  const auto a = hn::Mul(c, hn::MulAdd(hn::Set(d, surface.conic), hn::Mul(ray.n, ray.n), hn::Set(d, 1.0)));
  const auto discriminant = hn::NegMulAdd(a, f, hn::Mul(g, g));
  const auto root = hn::Sqrt(discriminant);  // of d · gradient; NaN for a miss
  const auto distance = hn::Div(f, hn::MulAdd(s, root, g));
  ray.x = hn::MulAdd(distance, ray.l, ray.x);
  ray.y = hn::MulAdd(distance, ray.m, ray.y);
  ray.z = hn::MulAdd(distance, ray.n, ray.z);
  ray.opl = hn::MulAdd(hn::Set(d, surface.index_before), distance, ray.opl);

  const auto nz = hn::NegMulAdd(hn::Mul(c, q), ray.z, hn::Set(d, 1.0));
  const auto radius_sq = hn::MulAdd(ray.x, ray.x, hn::Mul(ray.y, ray.y));
  // 1/|gradient|²: 1 for spheres.
  const auto length_sq = hn::MulAdd(nz, nz, hn::Mul(hn::Mul(c, c), radius_sq));
  const auto e = hn::Set(d, surface.index_ratio);
  const auto cos_sq = surface.conic == 0 ? discriminant : hn::Div(discriminant, length_sq);
  const auto under = hn::MulAdd(hn::Mul(e, e), hn::Sub(cos_sq, hn::Set(d, 1.0)), hn::Set(d, 1.0));
  auto bend = hn::NegMulAdd(e, hn::Sqrt(cos_sq), hn::Sqrt(under));
  if (surface.conic != 0) bend = hn::Div(bend, hn::Sqrt(length_sq));
  bend = hn::Mul(s, bend);
  const auto bend_c = hn::Mul(bend, c);
  ray.l = hn::NegMulAdd(bend_c, ray.x, hn::Mul(e, ray.l));
  ray.m = hn::NegMulAdd(bend_c, ray.y, hn::Mul(e, ray.m));
  ray.n = hn::MulAdd(bend, nz, hn::Mul(e, ray.n));

  const auto zero = hn::Zero(d);
  auto clean = hn::And(hn::Gt(hn::Mul(s, g), zero), hn::Gt(discriminant, zero));
  clean = hn::And(clean, hn::And(hn::Gt(nz, zero), hn::Ge(under, zero)));
  clean = hn::And(clean, hn::Le(radius_sq, hn::Set(d, surface.clear_radius_sq)));
  ray.clean = hn::And(ray.clean, clean);
}

HWY_ATTR HWY_INLINE void finish(const KernelPath& path, RayVector& ray) {
  if (!path.to_image) return;
  const Lanes d;
  const auto gap = hn::Set(d, path.image_z_mm - path.last_vertex_z_mm);
  const auto distance = hn::Div(hn::Sub(gap, ray.z), ray.n);
  ray.x = hn::MulAdd(distance, ray.l, ray.x);
  ray.y = hn::MulAdd(distance, ray.m, ray.y);
  ray.z = gap;
  ray.opl = hn::MulAdd(hn::Set(d, path.image_index), distance, ray.opl);
  ray.clean = hn::And(ray.clean, hn::Gt(ray.n, hn::Zero(d)));
}

HWY_ATTR HWY_INLINE void load(const KernelPath& path, const RayBatch& rays, std::size_t at, RayVector& ray) {
  const Lanes d;
  ray.x = hn::LoadU(d, &rays.x_mm[at]);
  ray.y = hn::LoadU(d, &rays.y_mm[at]);
  ray.z = hn::Sub(hn::LoadU(d, &rays.z_mm[at]), hn::Set(d, path.first_vertex_z_mm));
  ray.l = hn::LoadU(d, &rays.l[at]);
  ray.m = hn::LoadU(d, &rays.m[at]);
  ray.n = hn::LoadU(d, &rays.n[at]);
  ray.opl = hn::LoadU(d, &rays.opl_mm[at]);
  ray.clean = hn::Gt(hn::Set(d, 1.0), hn::Zero(d));
}

HWY_ATTR HWY_INLINE void store(const KernelPath& path, const RayVector& ray, std::size_t at, RayBatch& rays,
                               std::uint8_t* clean) {
  const Lanes d;
  const auto put = [&](const Vector& value, double* to)
                       HWY_ATTR { hn::BlendedStore(value, ray.clean, d, to); };
  put(ray.x, &rays.x_mm[at]);
  put(ray.y, &rays.y_mm[at]);
  put(hn::Add(ray.z, hn::Set(d, path.last_vertex_z_mm)), &rays.z_mm[at]);
  put(ray.l, &rays.l[at]);
  put(ray.m, &rays.m[at]);
  put(ray.n, &rays.n[at]);
  put(ray.opl, &rays.opl_mm[at]);
  HWY_ALIGN double flags[HWY_MAX_BYTES / sizeof(double)];
  hn::Store(hn::IfThenElseZero(ray.clean, hn::Set(d, 1.0)), d, flags);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) clean[at + i] = flags[i] != 0;
}

/// Traces whole groups of vectors; returns how many rays that were.
HWY_ATTR std::size_t trace_groups(const KernelPath& path, RayBatch& rays, std::uint8_t* clean) {
  const std::size_t lanes = hn::Lanes(Lanes()), group = interleaved * lanes;
  std::size_t at = 0;
  for (; at + group <= rays.size(); at += group) {
    RayVector a, b, c;
    load(path, rays, at, a);
    load(path, rays, at + lanes, b);
    load(path, rays, at + 2 * lanes, c);
    for (const KernelSurface& surface : path.surfaces) {
      step(surface, path.sense, a);
      step(surface, path.sense, b);
      step(surface, path.sense, c);
    }
    finish(path, a);
    finish(path, b);
    finish(path, c);
    store(path, a, at, rays, clean);
    store(path, b, at + lanes, rays, clean);
    store(path, c, at + 2 * lanes, rays, clean);
  }
  return at;
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(trace_groups);

void trace_batch_simd(const KernelPath& path, RayBatch& rays, std::vector<std::uint8_t>& clean) {
  clean.assign(rays.size(), 0);
  const std::size_t done = HWY_DYNAMIC_DISPATCH(trace_groups)(path, rays, clean.data());
  if (done == rays.size()) return;
  // The rest, padded to a whole group with its own last ray: every ray goes through the same arithmetic.
  // Room for three vectors of 2048 bits, the widest that there are.
  constexpr std::size_t widest_group = 3 * 32;
  const std::size_t rest = rays.size() - done;
  RayBatch tail(widest_group);
  std::vector<std::uint8_t> tail_clean(widest_group);
  const auto copy = [](const std::vector<double>& from, std::size_t from_at, std::vector<double>& to,
                       std::size_t to_at, std::size_t count) {
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(from_at), count,
                to.begin() + static_cast<std::ptrdiff_t>(to_at));
  };
  using Column = std::vector<double> RayBatch::*;
  constexpr Column columns[] = {&RayBatch::x_mm, &RayBatch::y_mm, &RayBatch::z_mm,  &RayBatch::l,
                                &RayBatch::m,    &RayBatch::n,    &RayBatch::opl_mm};
  for (const Column column : columns) {
    copy(rays.*column, done, tail.*column, 0, rest);
    std::fill((tail.*column).begin() + static_cast<std::ptrdiff_t>(rest), (tail.*column).end(),
              (rays.*column).back());
  }
  HWY_DYNAMIC_DISPATCH(trace_groups)(path, tail, tail_clean.data());
  for (const Column column : columns) copy(tail.*column, 0, rays.*column, done, rest);
  std::copy_n(tail_clean.begin(), rest, clean.begin() + static_cast<std::ptrdiff_t>(done));
}

}  // namespace petzval
#endif
