// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>

#include <cmath>

namespace petzval {

const char* to_string(Fields::Kind kind) {
  switch (kind) {
    case Fields::Kind::angle_deg:
      return "angle_deg";
    case Fields::Kind::object_height_mm:
      return "object_height_mm";
    case Fields::Kind::paraxial_image_height_mm:
      return "paraxial_image_height_mm";
    case Fields::Kind::real_image_height_mm:
      return "real_image_height_mm";
  }
  return "angle_deg";
}

const char* field_unit(Fields::Kind kind) {
  return kind == Fields::Kind::angle_deg ? "deg" : "mm";
}

std::vector<double> even_fields(const std::vector<double>& fields, int count) {
  double last = 0;
  for (const double field : fields)
    if (std::abs(field) > std::abs(last)) last = field;
  std::vector<double> even;
  for (int i = 0; i < count; ++i) even.push_back(last * i / (count - 1));
  return even;
}

double object_field(const Lens& lens, Fields::Kind kind, double value) {
  const bool finite = lens.object_distance_mm.has_value();
  switch (kind) {
    case Fields::Kind::angle_deg: {
      if (!finite) return value;
      // A ray that rises at this angle through the entrance pupil's centre starts below the axis.
      const double pupil = first_order(lens, lens.reference_wavelength_nm).entrance_pupil.position_mm;
      return -std::tan(radians(value)) * (*lens.object_distance_mm + pupil);
    }
    case Fields::Kind::object_height_mm:
      if (!finite)
        throw InputError(lens.name + ": the object is at infinity, so a field is an angle, not a height");
      return value;
    case Fields::Kind::paraxial_image_height_mm: {
      const FirstOrder paraxial = first_order(lens, lens.reference_wavelength_nm);
      return finite ? value / paraxial.magnification : degrees(std::atan(value / paraxial.efl_mm));
    }
    case Fields::Kind::real_image_height_mm: {
      FieldTracer tracer(lens, lens.reference_wavelength_nm);
      if (const std::optional<double> field = tracer.object_field_at_image_height(value)) return *field;
      throw InputError(
          fmt::format("{}: no chief ray reaches the real image height {:g} mm", lens.name, value));
    }
  }
  return value;
}

double ideal_image_height_mm(const Lens& lens, double object_field, double wavelength_nm) {
  const FirstOrder paraxial = first_order(lens, wavelength_nm);
  return lens.object_distance_mm ? paraxial.magnification * object_field
                                 : paraxial.efl_mm * std::tan(radians(object_field));
}

}  // namespace petzval
