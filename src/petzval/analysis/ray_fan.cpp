// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/ray_fan.h>
#include <petzval/base/error.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Rays to the very rim are drawn a hair inside it.
constexpr double inside_rim = 1 - 1e-9;
constexpr int fan_rim_azimuths = 256;

MeridionalPath path_of(const Tracer& tracer, const Ray& start, double lead_mm, double object_z_mm) {
  std::vector<Intersection> hits;
  const Ray end = tracer.trace(start, Tracer::Clip::none, &hits);
  if (end.status != RayStatus::ok) return {};
  MeridionalPath path;
  // Back from the first surface along the incoming ray, to the lead plane or the object.
  const auto& first = hits.front().point_mm;
  const double z = std::max(-lead_mm, object_z_mm);
  if (start.direction[2] > 0 && z < first[2])
    path.push_back({z, first[1] + (z - first[2]) * start.direction[1] / start.direction[2]});
  else if (!(start.direction[2] > 0))  // from the side or from behind
    path.push_back(
        {first[2] - 2 * lead_mm * start.direction[2], first[1] - 2 * lead_mm * start.direction[1]});
  for (const Intersection& hit : hits) path.push_back({hit.point_mm[2], hit.point_mm[1]});
  return path;
}

/// How far the pupil reaches in the meridional plane, above (+1) or below its centre. Azimuths of a stop with
/// blades stand where its corners want them, so the rim there is sought.
double meridional_rim(const FieldTracer& tracer, const Pencil& pencil, const PupilBoundary& pupil, int side) {
  if (pupil.mirrored()) return side > 0 ? pupil.radius.front() : pupil.radius[pupil.radius.size() / 2];
  double inside = 0, outside = 1.01 * *std::max_element(pupil.radius.begin(), pupil.radius.end());
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (inside + outside);
    const double v = pupil.centre_v + side * middle;
    (pencil.clearance(tracer.tracer(), pupil.centre_u, v, tracer.clip()).worst < 0 ? inside : outside) =
        middle;
  }
  return inside;
}

}  // namespace

std::vector<MeridionalPath> meridional_fan(FieldTracer& tracer, double object_field, int count,
                                           double lead_mm) {
  std::vector<MeridionalPath> fan;
  const std::optional<ChiefRay> chief = tracer.chief_ray(object_field);
  if (!chief) return fan;
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(*chief, fan_rim_azimuths);
  if (!pupil) return fan;
  const Pencil pencil = Pencil::from_object(tracer.lens(), object_field);
  const double top = meridional_rim(tracer, pencil, *pupil, 1) * inside_rim,
               bottom = meridional_rim(tracer, pencil, *pupil, -1) * inside_rim;
  for (int i = 0; i < count; ++i) {
    const double share = count == 1 ? 0 : 2.0 * i / (count - 1) - 1;
    const double v = count == 1 ? chief->v : pupil->centre_v + share * (share > 0 ? top : bottom);
    if (const std::optional<Ray> ray = pencil.ray(chief->u, v)) {
      MeridionalPath path = path_of(tracer.tracer(), *ray, lead_mm, pencil.point_mm()[2]);
      if (!path.empty()) fan.push_back(std::move(path));
    }
  }
  return fan;
}

Lens with_apertures_from_fields(Lens lens) {
  std::vector<double> needed(lens.surfaces.size(), 0.0);
  for (const double wavelength : lens.wavelengths_nm) {
    FieldTracer tracer(lens, wavelength, Tracer::Clip::stop_only);
    for (const double value : lens.fields.values) {
      const double field = object_field(lens, lens.fields.kind, value);
      const std::optional<ChiefRay> chief = tracer.chief_ray(field);
      const std::optional<PupilBoundary> pupil = chief ? tracer.round_object_pupil(*chief, 64) : std::nullopt;
      if (!pupil)
        throw InputError(fmt::format("{}: no ray passes at field {:g}, so its apertures cannot be solved",
                                     lens.name, value));
      const Pencil pencil = Pencil::from_object(lens, field);
      for (std::size_t i = 0; i < pupil->radius.size() / 2; ++i) {
        const double azimuth = pupil->azimuth(i), r = pupil->radius[i] * inside_rim;
        const std::optional<Ray> ray =
            pencil.ray(r * std::sin(azimuth), pupil->centre_v + r * std::cos(azimuth));
        std::vector<Intersection> hits;
        if (!ray || tracer.tracer().trace(*ray, Tracer::Clip::none, &hits).status != RayStatus::ok) continue;
        for (std::size_t s = 0; s < needed.size(); ++s)
          needed[s] = std::max(needed[s], std::hypot(hits[s].point_mm[0], hits[s].point_mm[1]));
      }
    }
  }
  for (std::size_t s = 0; s < needed.size(); ++s)
    if (!lens.surfaces[s].semi_diameter_mm && needed[s] > 0) lens.surfaces[s].semi_diameter_mm = needed[s];
  return lens;
}

}  // namespace petzval
