// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>

#include <cmath>

namespace petzval {

namespace {

/// Object fields of a request, resolved once (real image heights take a search each).
std::vector<double> object_fields(const Lens& lens, const FieldTableRequest& request) {
  std::vector<double> resolved;
  for (const double field : request.fields) resolved.push_back(object_field(lens, request.field_kind, field));
  return resolved;
}

ChiefRay chief_or_error(FieldTracer& tracer, double field, double object_field) {
  if (std::optional<ChiefRay> chief = tracer.chief_ray(object_field)) return *chief;
  throw InputError(
      fmt::format("{}: no chief ray passes at field {:g} and {:g} nm; a smaller field would be right",
                  tracer.lens().name, field, tracer.tracer().wavelength_nm()));
}

/// Fills rows [field][wavelength], wavelengths in parallel; `make(tracer, field, object_field)` gives one
/// row.
template <class Row, class Make>
std::vector<Row> tabulate(const Lens& lens, const FieldTableRequest& request, Make&& make) {
  const std::vector<double> fields = object_fields(lens, request);
  const std::size_t wavelengths = request.wavelengths_nm.size();
  std::vector<Row> rows(fields.size() * wavelengths);
  parallel_for(wavelengths, [&](std::size_t w) {
    FieldTracer tracer(lens, request.wavelengths_nm[w], request.clip);
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

}  // namespace

FieldTableRequest FieldTableRequest::of(const Lens& lens) {
  return {lens.fields.kind, lens.fields.values, lens.wavelengths_nm, Tracer::Clip::apertures, {}};
}

std::vector<DistortionRow> distortion_table(const Lens& lens, const FieldTableRequest& request) {
  return tabulate<DistortionRow>(lens, request, [&](FieldTracer& tracer, double field, double object_field) {
    const double wavelength = tracer.tracer().wavelength_nm();
    DistortionRow row;
    row.image_height_mm = chief_or_error(tracer, field, object_field).image_height_mm;
    row.paraxial_image_height_mm = ideal_image_height_mm(lens, object_field, wavelength);
    const auto percent = [&](double ideal) {
      return ideal == 0 ? 0.0 : 100 * (row.image_height_mm - ideal) / ideal;
    };
    row.distortion_percent = percent(row.paraxial_image_height_mm);
    if (!lens.object_distance_mm)
      row.distortion_ftheta_percent = percent(first_order(lens, wavelength).efl_mm * radians(object_field));
    return row;
  });
}

std::vector<IlluminationRow> illumination_table(const Lens& lens, const FieldTableRequest& request) {
  return tabulate<IlluminationRow>(
      lens, request, [&](FieldTracer& tracer, double field, double object_field) {
        const ChiefRay axis = chief_or_error(tracer, 0, 0),
                       chief = chief_or_error(tracer, field, object_field);
        IlluminationRow row;
        row.real_image_height_mm = chief.image_height_mm;
        row.g_sensor_sr = tracer.g_sensor_sr(chief);
        row.g_source_sr = tracer.g_source_sr(chief);
        const double on_axis = tracer.g_sensor_sr(axis);
        if (!(on_axis > 0))
          throw InputError(
              fmt::format("{}: no ray passes the stop on the axis; check the clear apertures", lens.name));
        row.relative_illumination = row.g_sensor_sr / on_axis;
        return row;
      });
}

}  // namespace petzval
