// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/pupil_rays.h>
#include <petzval/analysis/vignetting.h>
#include <petzval/base/units.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr int passing_rim_azimuths = 512;

std::optional<VignettingRow> vignetting(const FieldTracer& tracer, const ChiefRay& chief) {
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, passing_rim_azimuths);
  const std::vector<PupilRay> rays = pupil_rays(tracer, chief);
  if (!pupil || rays.empty()) return {};
  const double radius = tracer.tracer().stop_radius_mm();
  VignettingRow row;
  row.real_image_height_mm = chief.image_height_mm;
  for (const PupilRay& ray : rays) row.open_share += ray.stop_area_mm2 / (pi * radius * radius);
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief.object_field);
  bool first = true;
  for (std::size_t i = 0; i < pupil->own(); ++i) {
    const auto [u, v] = pupil->rim(i);
    const Tracer::Clearance rim = pencil.clearance(tracer.tracer(), u, v, tracer.clip());
    if (!rim.reached_stop) continue;
    const double x = std::abs(rim.stop_x_mm) / radius, y = rim.stop_y_mm / radius;
    if (first || y < row.pupil_low) {
      row.pupil_low = y;
      row.low_surface = rim.surface;
    }
    if (first || y > row.pupil_high) {
      row.pupil_high = y;
      row.high_surface = rim.surface;
    }
    row.pupil_half_width = std::max(row.pupil_half_width, x);
    first = false;
  }
  return row;
}

/// The angle against the z axis of a meridional direction whose y component is `beta`.
double outward_angle_deg(double beta, double image_height_mm) {
  return degrees(std::asin(std::clamp(image_height_mm < 0 ? -beta : beta, -1.0, 1.0)));
}

std::optional<ChiefRayAngleRow> chief_ray_angle(const FieldTracer& tracer, const ChiefRay& chief) {
  const std::vector<PupilRay> rays = pupil_rays(tracer, chief);
  if (rays.empty()) return {};
  double beta = 0, solid_angle = 0;
  for (const PupilRay& ray : rays) {
    beta += ray.exit_solid_angle_sr * ray.beta;
    solid_angle += ray.exit_solid_angle_sr;
  }
  ChiefRayAngleRow row;
  row.object_field = chief.object_field;
  row.real_image_height_mm = chief.image_height_mm;
  row.chief_ray_angle_deg = outward_angle_deg(chief.at_image.direction[1], chief.image_height_mm);
  row.mean_ray_angle_deg = outward_angle_deg(beta / solid_angle, chief.image_height_mm);
  return row;
}

}  // namespace

std::vector<VignettingRow> vignetting_table(const Lens& lens, const FieldTableRequest& request) {
  return field_rows<VignettingRow>(lens, request, [](const FieldTracer& tracer, const ChiefRay& chief) {
    return vignetting(tracer, chief);
  });
}

std::vector<ChiefRayAngleRow> chief_ray_angle_table(const Lens& lens, const FieldTableRequest& request) {
  return field_rows<ChiefRayAngleRow>(lens, request, [](const FieldTracer& tracer, const ChiefRay& chief) {
    return chief_ray_angle(tracer, chief);
  });
}

}  // namespace petzval
