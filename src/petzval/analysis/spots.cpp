// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/spots.h>
#include <petzval/base/units.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// First zero of J1(x)/x over π: the Airy disc's first dark ring in units of λN.
constexpr double airy_radius_lambda_n = 1.2196698912665045;

}  // namespace

std::optional<SpotRow> spot(const FieldTracer& tracer, const ChiefRay& chief, RayWeight weight,
                            const PupilSampling& sampling) {
  const std::vector<PupilRay> rays = pupil_rays(tracer, chief, sampling);
  if (rays.empty()) return {};
  const auto weight_of = [&](const PupilRay& ray) {
    return weight == RayWeight::light ? ray.entrance_measure : ray.stop_area_mm2;
  };
  double total = 0, centroid = 0, centroid_x = 0, x_sq = 0, y_sq = 0, largest = 0;
  for (const PupilRay& ray : rays) {
    total += weight_of(ray);
    centroid += weight_of(ray) * ray.y_mm;
    if (!ray.mirrored) centroid_x += weight_of(ray) * ray.x_mm;
  }
  centroid /= total;
  centroid_x /= total;
  for (const PupilRay& ray : rays) {
    const double x = ray.x_mm - centroid_x, y = ray.y_mm - centroid;
    x_sq += weight_of(ray) * x * x / total;
    y_sq += weight_of(ray) * y * y / total;
    largest = std::max(largest, std::hypot(x, y));
  }
  SpotRow row;
  row.real_image_height_mm = chief.image_height_mm;
  row.centroid_um = centroid * um_per_mm;
  row.centroid_x_um = centroid_x * um_per_mm;
  row.rms_x_um = std::sqrt(x_sq) * um_per_mm;
  row.rms_y_um = std::sqrt(y_sq) * um_per_mm;
  row.rms_radius_um = std::hypot(row.rms_x_um, row.rms_y_um);
  row.max_radius_um = largest * um_per_mm;
  const double f_number = std::sqrt(pi / (4 * exit_solid_angle_sr(tracer, rays)));
  row.airy_radius_um =
      airy_radius_lambda_n * tracer.tracer().wavelength_nm() * mm_per_nm * um_per_mm * f_number;
  return row;
}

std::vector<SpotRow> spot_table(const Lens& lens, const FieldTableRequest& request, RayWeight weight) {
  return field_rows<SpotRow>(lens, request, [&](const FieldTracer& tracer, const ChiefRay& chief) {
    return spot(tracer, chief, weight);
  });
}

}  // namespace petzval
