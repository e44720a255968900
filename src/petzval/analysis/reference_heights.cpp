// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/reference_heights.h>

namespace petzval {

std::map<double, double> reference_heights_mm(const Lens& lens, const FieldTableRequest& request) {
  std::map<double, double> heights;
  FieldTracer tracer(lens, lens.reference_wavelength_nm, request.clip, request.azimuth_deg);
  for (const double field : request.fields) {
    const double object = object_field(lens, request.field_kind, field);
    const std::optional<ChiefRay> chief = tracer.chief_ray(object);
    if (!chief) throw no_ray_passes(lens, field, lens.reference_wavelength_nm);
    heights[object] = chief->image_height_mm;
  }
  return heights;
}

}  // namespace petzval
