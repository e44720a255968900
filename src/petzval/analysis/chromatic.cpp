// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/chromatic.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/reference_heights.h>
#include <petzval/analysis/stop_aim.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>

#include <cmath>
#include <limits>

namespace petzval {

namespace {

double paraxial_focus_mm(const Lens& lens, double wavelength_nm) {
  return paraxial_image_distance_mm(lens, lens.object_distance_mm, wavelength_nm) - lens.image_distance_mm();
}

/// Where a ray at height y on the image surface crosses the axis.
double crossing_mm(const PupilRay& ray) {
  const double cosine = std::sqrt(1 - ray.alpha * ray.alpha - ray.beta * ray.beta);
  return -ray.y_mm * cosine / ray.beta;
}

/// How high a ray stands over the image surface's centre, and its slope along y.
std::array<double, 2> line_of(const PupilRay& ray) {
  return {ray.y_mm, ray.beta / std::sqrt(1 - ray.alpha * ray.alpha - ray.beta * ray.beta)};
}

/// Where the rays at the two ends of a zone cross.
double crossing_of_sides_mm(StopAim& aim, double zone) {
  constexpr double paraxial_zone = 1e-3;
  const double reach = zone == 0 ? paraxial_zone : zone;
  const std::optional<PupilRay> above = aim.ray(0, reach), below = aim.ray(0, -reach);
  if (!above || !below) return std::numeric_limits<double>::quiet_NaN();
  const auto [y1, slope1] = line_of(*above);
  const auto [y2, slope2] = line_of(*below);
  return -(y1 - y2) / (slope1 - slope2);
}

}  // namespace

std::vector<AxialFocusRow> axial_focus_table(const Lens& lens, const std::vector<double>& wavelengths_nm,
                                             const std::vector<double>& zones, Tracer::Clip clip) {
  for (const double zone : zones)
    if (!(zone >= 0 && zone <= 1))
      throw InputError(fmt::format("a zone of {:g} stop radii; 0 to 1 would be right", zone));
  std::vector<AxialFocusRow> rows(zones.size() * wavelengths_nm.size());
  parallel_for(wavelengths_nm.size(), [&](std::size_t w) {
    FieldTracer tracer(lens, wavelengths_nm[w], clip);
    const std::optional<ChiefRay> chief = tracer.chief_ray(0);
    std::optional<StopAim> aim = chief ? StopAim::of(tracer, *chief) : std::nullopt;
    if (!aim) throw no_ray_passes(lens, 0, wavelengths_nm[w]);
    for (std::size_t z = 0; z < zones.size(); ++z) {
      AxialFocusRow& row = rows[z * wavelengths_nm.size() + w];
      if (!tracer.tracer().is_centred()) {
        row = {wavelengths_nm[w], zones[z], crossing_of_sides_mm(*aim, zones[z])};
        continue;
      }
      row = {wavelengths_nm[w], zones[z], paraxial_focus_mm(lens, wavelengths_nm[w])};
      if (zones[z] == 0) continue;
      const std::optional<PupilRay> ray = aim->ray(0, zones[z]);
      row.focus_mm = ray ? crossing_mm(*ray) : std::numeric_limits<double>::quiet_NaN();
    }
  });
  return rows;
}

std::vector<LateralColourRow> lateral_colour_table(const Lens& lens, const FieldTableRequest& request) {
  const auto reference = reference_points_mm(lens, request);
  return field_rows<LateralColourRow>(
      lens, request, [&](const FieldTracer&, const ChiefRay& chief) -> std::optional<LateralColourRow> {
        LateralColourRow row;
        row.real_image_height_mm = chief.image_height_mm;
        const auto& [x_mm, y_mm] = reference.at(chief.object_field);
        row.lateral_colour_um = (chief.image_height_mm - y_mm) * um_per_mm;
        row.across_um = (chief.image_x_mm - x_mm) * um_per_mm;
        return row;
      });
}

}  // namespace petzval
