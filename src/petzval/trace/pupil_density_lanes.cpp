// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/trace/pupil_density_lanes.h>

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/trace/pupil_density_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
//
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Whole = hn::RebindToSigned<Floats>;
using Float = hn::Vec<Floats>;
using Index = hn::Vec<Whole>;

constexpr int row_floats = static_cast<int>(sizeof(PupilDensityTable::Row) / sizeof(float));
static_assert(sizeof(PupilDensityTable::Row) % sizeof(float) == 0);

/// One member of the rows `at` (their first floats).
HWY_ATTR HWY_INLINE Float member(const PupilDensityTable& table, std::size_t offset, Index at) {
  const auto* base = reinterpret_cast<const float*>(table.rows.data());
  return hn::GatherIndex(Floats(), base + offset / sizeof(float), at);
}

/// Azimuth from +y towards +x in sectors, 0 … sectors.
HWY_ATTR HWY_INLINE Float azimuth_sectors(Float x, Float y) {
  const Floats d;
  const Float across = hn::Abs(x), along = hn::Abs(y);
  const Float larger = hn::Max(hn::Max(across, along), hn::Set(d, std::numeric_limits<float>::min()));
  const Float eighth = hn::Atan(d, hn::Div(hn::Min(across, along), larger));
  const Float quarter = hn::Set(d, static_cast<float>(pi / 2)), half = hn::Set(d, static_cast<float>(pi));
  const Float whole = hn::Set(d, static_cast<float>(2 * pi));
  Float angle = hn::IfThenElse(hn::Gt(across, along), hn::Sub(quarter, eighth), eighth);
  angle = hn::IfThenElse(hn::Lt(y, hn::Zero(d)), hn::Sub(half, angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(whole, angle), angle);
  return hn::Mul(angle, hn::Set(d, static_cast<float>(PupilDensityTable::sectors / (2 * pi))));
}

/// A whole number from 0 to `last`, whatever the lanes hold.
HWY_ATTR HWY_INLINE Index clamped(Float value, std::size_t last) {
  const Floats d;
  const Float held = hn::Min(hn::Max(value, hn::Zero(d)), hn::Set(d, static_cast<float>(last)));
  return hn::ConvertTo(Whole(), hn::IfThenElseZero(hn::Eq(value, value), held));
}

HWY_ATTR HWY_INLINE Float density(const PupilDensityTable& table, Float x, Float y, Float alpha, Float beta) {
  using Row = PupilDensityTable::Row;
  const Floats d;
  const Float radius = hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y)));
  const auto off_axis = hn::Gt(radius, hn::Zero(d));
  const Float per_radius = hn::Div(hn::Set(d, 1.0f), hn::IfThenElse(off_axis, radius, hn::Set(d, 1.0f)));
  const Float along_x = hn::Mul(x, per_radius);
  const Float along_y = hn::IfThenElse(off_axis, hn::Mul(y, per_radius), hn::Set(d, 1.0f));

  const Index zone = clamped(hn::Div(radius, hn::Set(d, table.zone_mm)), table.rows.size() - 1);
  const Index row = hn::Mul(zone, hn::Set(Whole(), row_floats));
  // Film radii beyond the last zone have its end.
  const Float half_zone = hn::Set(d, 0.5f * table.zone_mm);
  const Float middle = hn::MulAdd(hn::ConvertTo(d, zone), hn::Set(d, table.zone_mm), half_zone);
  const Float from_middle = hn::Min(hn::Sub(radius, middle), half_zone);
  const Float centre = hn::MulAdd(member(table, offsetof(Row, centre_v_per_mm), row), from_middle,
                                  member(table, offsetof(Row, centre_v), row));
  const Float u = hn::MulSub(alpha, along_y, hn::Mul(beta, along_x));
  const Float v = hn::MulAdd(alpha, along_x, hn::Mul(beta, along_y));
  const Float across = hn::Mul(u, member(table, offsetof(Row, per_scale_u), row));
  const Float along = hn::Mul(hn::Sub(v, centre), member(table, offsetof(Row, per_scale_v), row));
  const Index sector = clamped(azimuth_sectors(across, along), PupilDensityTable::sectors - 1);
  const Float rim_sq = member(table, offsetof(Row, radius_sq), hn::Add(row, sector));
  const auto inside = hn::Le(hn::MulAdd(across, across, hn::Mul(along, along)), rim_sq);
  return hn::IfThenElseZero(inside, member(table, offsetof(Row, density_per_sr), row));
}

HWY_ATTR HWY_INLINE void density_at(const PupilDensityTable& table, const PupilDirections& rays,
                                    std::size_t at, float* per_sr) {
  const Floats d;
  hn::StoreU(density(table, hn::LoadU(d, rays.x_mm + at), hn::LoadU(d, rays.y_mm + at),
                     hn::LoadU(d, rays.alpha + at), hn::LoadU(d, rays.beta + at)),
             d, per_sr + at);
}

HWY_ATTR void densities(const PupilDensityTable& table, const PupilDirections& rays, float* per_sr) {
  const std::size_t lanes = hn::Lanes(Floats());
  std::size_t at = 0;
  for (; at + lanes <= rays.count; at += lanes) density_at(table, rays, at, per_sr);
  if (at == rays.count) return;
  // The last few do not fill a vector: they are copied into one.
  HWY_ALIGN float room[5][HWY_MAX_BYTES / sizeof(float)] = {};
  const float* const from[4] = {rays.x_mm, rays.y_mm, rays.alpha, rays.beta};
  for (std::size_t c = 0; c < 4; ++c) std::copy_n(from[c] + at, rays.count - at, room[c]);
  density_at(table, {room[0], room[1], room[2], room[3], lanes}, 0, room[4]);
  std::copy_n(room[4], rays.count - at, per_sr + at);
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(densities);

void pupil_densities(const PupilDensityTable& table, const PupilDirections& directions, float* per_sr) {
  HWY_DYNAMIC_DISPATCH(densities)(table, directions, per_sr);
}

}  // namespace petzval
#endif
