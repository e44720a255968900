// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/pupil_rays.h>
#include <petzval/analysis/spot_diagram.h>
#include <petzval/base/units.h>

namespace petzval {

std::vector<SpotDiagram> spot_diagrams(const Lens& lens, const FieldTableRequest& request, int rings) {
  return field_rows<SpotDiagram>(
      lens, request, [rings](const FieldTracer& tracer, const ChiefRay& chief) -> std::optional<SpotDiagram> {
        SpotDiagram diagram;
        diagram.height_um = chief.image_height_mm * um_per_mm;
        for (const PupilRay& ray : ring_rays(tracer, chief, rings)) {
          diagram.x_um.push_back(ray.x_mm * um_per_mm);
          diagram.y_um.push_back(ray.y_mm * um_per_mm);
        }
        return diagram;
      });
}

}  // namespace petzval
