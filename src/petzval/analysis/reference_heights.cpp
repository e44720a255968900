// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/reference_heights.h>

namespace petzval {

std::map<double, std::array<double, 2>> reference_points_mm(const Lens& lens,
                                                            const FieldTableRequest& request) {
  std::map<double, std::array<double, 2>> points;
  FieldTracer tracer(lens, lens.reference_wavelength_nm, request.clip, request.azimuth_deg);
  for (const double field : request.fields) {
    const double object = object_field(lens, request.field_kind, field);
    const std::optional<ChiefRay> chief = tracer.chief_ray(object);
    if (!chief) throw no_ray_passes(lens, field, lens.reference_wavelength_nm);
    points[object] = {chief->image_x_mm, chief->image_height_mm};
  }
  return points;
}

}  // namespace petzval
