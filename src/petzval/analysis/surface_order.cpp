// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/surface_order.h>
#include <petzval/base/error.h>
#include <petzval/lens/pose.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/trace/stop_corners.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace petzval {

namespace {

constexpr double share_of_stop = 0.9;
/// What rounding leaves between surfaces that touch [mm].
constexpr double touching_mm = 1e-9;

/// The way from one surface that bends light to the next, along a ray.
struct Gap {
  std::size_t from, to;
  double length_mm = 0;
};

bool bends(const Tracer::PreparedSurface& surface) {
  return surface.mirror || surface.bend || surface.index_before != surface.index_after;
}

/// The first gap that a ray runs back through, where the lens as designed has one that is not negative.
Gap first_negative_gap(const Tracer& tracer, const std::vector<Intersection>& path) {
  Gap now{0, 0, 0};
  const auto& surfaces = tracer.surfaces();
  bool from_surface = false;
  for (std::size_t i = 0; i < surfaces.size() && i < path.size(); ++i) {
    if (i > 0)
      for (std::size_t axis = 0; axis < 3; ++axis)
        now.length_mm +=
            (path[i].point_mm[axis] - path[i - 1].point_mm[axis]) * path[i - 1].direction_after[axis];
    if (!bends(surfaces[i])) continue;
    const double designed_mm = (surfaces[i].vertex_z_mm - surfaces[now.from].vertex_z_mm) * surfaces[i].sense;
    now.to = i;
    if (from_surface && designed_mm >= 0 && now.length_mm < -touching_mm) return now;
    now = {i, i, 0};
    from_surface = true;
  }
  return {0, 0, 0};
}

}  // namespace

void require_surfaces_in_order(const Lens& lens) {
  if (!has_poses(lens) || is_ray_transfer(lens)) return;
  FieldTracer tracer(lens, lens.reference_wavelength_nm);
  const auto chief = tracer.chief_ray(0);
  if (!chief) return;
  const Pencil pencil = Pencil::from_object(lens, 0);
  const double radius = share_of_stop * pupil_scale(tracer.tracer(), pencil, {chief->u, chief->v});
  Gap worst{0, 0, 0};
  constexpr int around = 8;
  for (int i = 0; i <= around; ++i) {
    const double turn = 2 * std::numbers::pi * i / around, away = i < around ? radius : 0;
    const auto ray = pencil.ray(chief->u + away * std::sin(turn), chief->v + away * std::cos(turn));
    if (!ray) continue;
    std::vector<Intersection> path;
    tracer.tracer().trace(*ray, Tracer::Clip::none, &path);
    const Gap gap = first_negative_gap(tracer.tracer(), path);
    if (gap.to == gap.from) continue;
    if (worst.to == worst.from || gap.to < worst.to ||
        (gap.to == worst.to && gap.length_mm < worst.length_mm))
      worst = gap;
  }
  if (worst.to != worst.from)
    throw InputError(fmt::format(
        "{}: surfaces[{}] and surfaces[{}] cross by their poses: light would run {:.4g} mm backwards from "
        "one to the other; smaller poses, or a wider gap, would be right",
        lens.name, worst.from, worst.to, -worst.length_mm));
}

}  // namespace petzval
