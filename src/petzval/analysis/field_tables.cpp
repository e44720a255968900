// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

/// Object fields of a request, resolved once (real image heights take a search each).
std::vector<double> object_fields(const Lens& lens, const FieldTableRequest& request) {
  std::vector<double> resolved;
  for (const double field : request.fields) resolved.push_back(object_field(lens, request.field_kind, field));
  return resolved;
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
/// Enough to see whether any light passes at all.
constexpr int lit_azimuths = 8;

/// \throws InputError unless one of the rows has light.
template <class Row>
void require_light(const Lens& lens, const std::vector<Row>& rows) {
  if (rows.empty() || std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.lit; })) return;
  throw InputError(fmt::format("{}: no ray passes at field {:g}{}; smaller fields would be right", lens.name,
                               rows.front().field, rows.size() > 1 ? " nor at the others" : ""));
}

/// Fills rows [field][wavelength], wavelengths in parallel; `make(tracer, field, object_field)` gives one
/// row.
template <class Row, class Make>
std::vector<Row> tabulate(const Lens& lens, FieldTableRequest request, Make&& make) {
  request = with_own_lists(std::move(request), lens);
  const std::vector<double> fields = object_fields(lens, request);
  const std::size_t wavelengths = request.wavelengths_nm.size();
  std::vector<Row> rows(fields.size() * wavelengths);
  parallel_for(wavelengths, [&](std::size_t w) {
    FieldTracer tracer(lens, request.wavelengths_nm[w], request.clip, request.azimuth_deg);
    tracer.set_losses(request.losses);
    for (std::size_t f = 0; f < fields.size(); ++f) {
      Row row = make(tracer, request.fields[f], fields[f]);
      row.field = request.fields[f];
      row.object_field = fields[f];
      row.wavelength_nm = request.wavelengths_nm[w];
      rows[f * wavelengths + w] = row;
    }
  });
  return rows;
}

/// h'/ideal − 1 [%] of the paraxial chief ray on the image surface: the limit of distortion at small fields.
/// It is not zero where the sensor stands beside the paraxial image.
double distortion_on_axis_percent(const Lens& lens, double wavelength_nm) {
  constexpr double tangent = 1;  // any: the paraxial chief ray is linear
  const double pupil = first_order(lens, wavelength_nm).entrance_pupil.position_mm;
  double field = degrees(std::atan(tangent)), slope = tangent, height = -tangent * pupil;
  if (lens.object_distance_mm) {
    field = *lens.object_distance_mm;
    const double to_pupil = field + pupil;
    slope = std::isfinite(to_pupil) ? -field / to_pupil : 0;
    height = field + slope * *lens.object_distance_mm;
  }
  const double ideal = ideal_image_height_mm(lens, field, wavelength_nm);
  return 100 * (trace_paraxial(lens, height, slope, wavelength_nm).height_mm.back() / ideal - 1);
}

/// Where a field lands about where field 0 lands: along the field, and across it.
struct FromCentre {
  double along_mm, across_mm;
};

std::optional<FromCentre> from_centre(FieldTracer& tracer, double object_field) {
  const std::optional<ChiefRay> centre = tracer.chief_ray(0), chief = tracer.chief_ray(object_field);
  if (!centre || !chief) return {};
  return FromCentre{chief->image_height_mm - centre->image_height_mm, chief->image_x_mm - centre->image_x_mm};
}

/// h'/ideal − 1 [%] of a lens with poses near field 0, by a small step along the field on both sides.
double distortion_at_centre_percent(FieldTracer& tracer) {
  constexpr double step_deg = 1e-2, step_per_distance = 1e-4;
  const Lens& lens = tracer.lens();
  const double step = lens.object_distance_mm ? *lens.object_distance_mm * step_per_distance : step_deg;
  const auto above = from_centre(tracer, step), below = from_centre(tracer, -step);
  if (!above || !below) return not_a_number;
  const double ideal = ideal_image_height_mm(lens, step, tracer.tracer().wavelength_nm());
  return 100 * ((above->along_mm - below->along_mm) / (2 * ideal) - 1);
}

}  // namespace

FieldTableRequest FieldTableRequest::of(const Lens& lens) {
  return {lens.fields.kind, lens.fields.values, lens.wavelengths_nm, Tracer::Clip::apertures, {}};
}

std::vector<DistortionRow> distortion_table(const Lens& lens, const FieldTableRequest& request) {
  auto rows = tabulate<DistortionRow>(lens, request, [&](FieldTracer& tracer, double, double object_field) {
    const double wavelength = tracer.tracer().wavelength_nm();
    const std::optional<ChiefRay> chief = tracer.chief_ray(object_field);
    DistortionRow row;
    row.lit = chief && tracer.object_pupil(*chief, lit_azimuths);
    row.image_height_mm = row.lit ? chief->image_height_mm : not_a_number;
    row.image_x_mm = row.lit ? chief->image_x_mm : not_a_number;
    const bool centred = tracer.tracer().is_centred();
    const std::optional<FromCentre> from = centred ? std::nullopt : from_centre(tracer, object_field);
    const double height_mm = !row.lit || centred ? row.image_height_mm : from ? from->along_mm : not_a_number;
    const double at_centre =
        centred ? distortion_on_axis_percent(lens, wavelength) : distortion_at_centre_percent(tracer);
    // A tangent ends at 90°.
    const bool has_ideal = lens.object_distance_mm || std::abs(object_field) < 90;
    row.paraxial_image_height_mm =
        has_ideal ? ideal_image_height_mm(lens, object_field, wavelength) : not_a_number;
    const auto percent = [&](double ideal) {
      return object_field == 0 ? at_centre : 100 * (height_mm - ideal) / ideal;
    };
    row.paraxial_distortion_percent = percent(row.paraxial_image_height_mm);
    const double on_axis = 1 + at_centre / 100;
    row.distortion_percent =
        object_field == 0 ? 0 : 100 * (height_mm / (row.paraxial_image_height_mm * on_axis) - 1);
    if (from && object_field != 0)
      row.across_percent = 100 * from->across_mm / (row.paraxial_image_height_mm * on_axis);
    if (!lens.object_distance_mm)
      row.distortion_ftheta_percent = percent(first_order(lens, wavelength).efl_mm * radians(object_field));
    return row;
  });
  require_light(lens, rows);
  return rows;
}

std::vector<IlluminationRow> illumination_table(const Lens& lens, const FieldTableRequest& request) {
  auto rows = tabulate<IlluminationRow>(lens, request, [&](FieldTracer& tracer, double, double object_field) {
    const std::optional<ChiefRay> axis = tracer.chief_ray(0);
    const double on_axis = axis ? tracer.g_sensor_sr(*axis) : 0;
    if (!(on_axis > 0))
      throw InputError(
          fmt::format("{}: no ray passes the stop on the axis; check the clear apertures", lens.name));
    const std::optional<ChiefRay> chief = tracer.chief_ray(object_field);
    IlluminationRow row;
    row.real_image_height_mm = chief ? chief->image_height_mm : not_a_number;
    row.real_image_x_mm = chief ? chief->image_x_mm : 0;
    row.g_sensor_sr = chief ? tracer.g_sensor_sr(*chief) : 0;
    row.g_source_sr = chief ? tracer.g_source_sr(*chief) : 0;
    row.lit = row.g_sensor_sr > 0 || row.g_source_sr > 0;
    row.pupil_in_one_piece = !row.lit || tracer.image_pupil_in_one_piece(*chief);
    row.relative_illumination = row.g_sensor_sr / on_axis;
    return row;
  });
  require_light(lens, rows);
  return rows;
}

}  // namespace petzval
