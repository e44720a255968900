// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/footprints.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/trace/pencil.h>

#include <array>
#include <cmath>

namespace petzval {

namespace {

/// Where a ray of a field met a surface, in the surface's own axes. \param turn  of the axes of the field
/// [rad].
std::array<double, 3> on_surface(const Tracer::PreparedSurface& surface, const std::array<double, 3>& at,
                                 double turn) {
  const double c = std::cos(turn), s = std::sin(turn);
  return surface.frame.point_from_lens({c * at[0] - s * at[1], s * at[0] + c * at[1], at[2]},
                                       surface.vertex_z_mm);
}

/// All surfaces by one field. \param lens_tracer  of the lens as it stands, not turned to the field.
std::vector<Footprint> footprints_of(const Lens& lens, FieldTracer& tracer, const Tracer& lens_tracer,
                                     double turn, Fields::Kind kind, double field, int azimuths) {
  const auto chief = tracer.chief_ray(object_field(lens, kind, field));
  const auto pupil = chief ? tracer.object_pupil(*chief, azimuths) : std::nullopt;
  if (!pupil)
    throw InputError(fmt::format("{}: no ray passes at field {:g} ({}); a smaller field would be right",
                                 lens.name, field, to_string(kind)));
  std::vector<Footprint> all(lens.surfaces.size());
  for (std::size_t s = 0; s < all.size(); ++s) all[s].surface = static_cast<int>(s), all[s].field = field;
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief->object_field);
  for (std::size_t i = 0; i < pupil->own(); ++i) {
    const auto [u, v] = pupil->rim(i);
    const auto ray = pencil.ray(u, v);
    std::vector<Intersection> path;
    if (!ray) continue;
    tracer.tracer().trace(*ray, Tracer::Clip::none, &path);
    for (std::size_t s = 0; s < all.size() && s < path.size(); ++s) {
      const auto at = on_surface(lens_tracer.surfaces()[s], path[s].point_mm, turn);
      all[s].x_mm.push_back(at[0]);
      all[s].y_mm.push_back(at[1]);
    }
  }
  for (Footprint& each : all) {
    if (pupil->mirrored())
      for (std::size_t i = each.x_mm.size(); i-- > 0;) {
        each.x_mm.push_back(-each.x_mm[i]);
        each.y_mm.push_back(each.y_mm[i]);
      }
    if (each.x_mm.empty()) continue;
    each.x_mm.push_back(each.x_mm.front());
    each.y_mm.push_back(each.y_mm.front());
  }
  return all;
}

}  // namespace

double Footprint::area_mm2() const {
  double twice = 0;
  for (std::size_t i = 1; i < x_mm.size(); ++i) twice += x_mm[i - 1] * y_mm[i] - x_mm[i] * y_mm[i - 1];
  return 0.5 * std::abs(twice);
}

std::vector<Footprint> footprints(const Lens& lens, const FieldTableRequest& request, int azimuths) {
  const FieldTableRequest at = with_own_lists(request, lens);
  FieldTracer tracer(lens, at.wavelengths_nm.front(), at.clip, at.azimuth_deg);
  const Tracer lens_tracer(lens, at.wavelengths_nm.front());
  std::vector<std::vector<Footprint>> by_field;
  for (const double field : at.fields)
    by_field.push_back(
        footprints_of(lens, tracer, lens_tracer, radians(at.azimuth_deg), at.field_kind, field, azimuths));
  std::vector<Footprint> all;
  for (std::size_t s = 0; s < lens.surfaces.size(); ++s)
    for (std::vector<Footprint>& field : by_field) all.push_back(std::move(field[s]));
  return all;
}

}  // namespace petzval
