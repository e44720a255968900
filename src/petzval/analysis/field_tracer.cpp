// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/trace/passing_region.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Half-width of the central difference for dh'/dfield: its error is the square of this against the field at
/// which a lens changes, its rounding 1e-13 over it.
constexpr double difference_deg = 1e-3;
constexpr double difference_per_object_distance = 1e-5;
/// Fields so small that h'/field is its own derivative.
constexpr double on_axis_differences = 4;

double difference_step(const Lens& lens) {
  return lens.object_distance_mm ? *lens.object_distance_mm * difference_per_object_distance : difference_deg;
}

}  // namespace

FieldTracer::FieldTracer(const Lens& lens, double wavelength_nm, Tracer::Clip clip)
    : lens_(lens), tracer_(lens_, wavelength_nm), clip_(clip), march_(lens_, tracer_) {}

std::optional<ChiefRay> FieldTracer::chief_ray(double object_field) {
  const std::optional<double> v = march_.v_at(object_field);
  if (!v) return {};
  ChiefRay chief;
  chief.object_field = object_field;
  chief.v = *v;
  chief.at_image = tracer_.trace(*Pencil::from_object(lens_, object_field).ray(0, *v), Tracer::Clip::none);
  if (chief.at_image.status != RayStatus::ok) return {};
  chief.image_height_mm = chief.at_image.point_mm[1];
  return chief;
}

std::optional<PupilBoundary> FieldTracer::object_pupil(const ChiefRay& chief, int azimuths) const {
  return find_pupil(tracer_, Pencil::from_object(lens_, chief.object_field), chief.v, azimuths, clip_);
}

std::optional<PupilBoundary> FieldTracer::round_object_pupil(const ChiefRay& chief, int azimuths) const {
  return find_pupil(tracer_.with_blades({}), Pencil::from_object(lens_, chief.object_field), chief.v,
                    azimuths, clip_);
}

std::optional<PupilBoundary> FieldTracer::image_pupil(const ChiefRay& chief, int azimuths) const {
  return find_pupil(tracer_, Pencil::from_image(tracer_, chief.image_height_mm), chief.at_image.direction[1],
                    azimuths, clip_);
}

bool FieldTracer::image_pupil_in_one_piece(const ChiefRay& chief) const {
  const auto region = find_passing_region(tracer_, Pencil::from_image(tracer_, chief.image_height_mm), clip_);
  return !region || (region->parts() == 1 && !region->has_hole());
}

double FieldTracer::g_sensor_sr(const ChiefRay& chief) const {
  const std::optional<PupilBoundary> pupil = image_pupil(chief);
  const double n = tracer_.image_index();
  return pupil ? n * n * lit_area(Pencil::from_image(tracer_, chief.image_height_mm), *pupil) : 0.0;
}

double FieldTracer::object_flux(const ChiefRay& chief) const {
  const std::optional<PupilBoundary> pupil = object_pupil(chief);
  return pupil ? lit_area(Pencil::from_object(lens_, chief.object_field), *pupil) : 0.0;
}

double FieldTracer::g_source_sr(const ChiefRay& chief) {
  const double flux = object_flux(chief);
  return flux > 0 ? flux * object_area_per_image_area(chief) : 0.0;
}

void FieldTracer::set_losses(const Losses& losses) {
  transmittance_.reset();
  if (losses.any()) transmittance_.emplace(lens_, tracer_.wavelength_nm(), losses);
}

double FieldTracer::lit_area(const Pencil& pencil, const PupilBoundary& pupil) const {
  return transmittance_ ? transmitted_area(tracer_, pencil, pupil, *transmittance_) : pupil.area();
}

double FieldTracer::object_area_per_image_area(const ChiefRay& chief) {
  const double step = difference_step(lens_);
  const double field = std::abs(chief.object_field), sign = std::copysign(1.0, chief.object_field);
  const std::optional<ChiefRay> inner = chief_ray(sign * (field - step)),
                                outer = chief_ray(sign * (field + step));
  // At the last field that reaches the sensor there is no outer neighbour: one-sided.
  if (!inner) throw InputError(fmt::format("no chief ray beside the field {:g}", chief.object_field));
  const double span = outer ? 2 * step : step;
  const double rise =
      sign * ((outer ? outer->image_height_mm : chief.image_height_mm) - inner->image_height_mm) / span;
  const double per_unit =
      lens_.object_distance_mm ? std::abs(rise) : degrees(std::abs(rise));  // mm per mm or rad
  if (!(per_unit > 0))
    throw InputError(fmt::format("the image of field {:g} does not move with the field", chief.object_field));
  if (field < on_axis_differences * step) return 1 / (per_unit * per_unit);
  const double height = std::abs(chief.image_height_mm);
  const double object = lens_.object_distance_mm ? field : std::sin(radians(field));
  return object / (height * per_unit);
}

std::optional<double> FieldTracer::object_field_at_image_height(double image_height_mm) {
  if (image_height_mm == 0) return 0.0;
  const double paraxial = ideal_image_height_mm(lens_, difference_step(lens_), tracer_.wavelength_nm());
  const double direction = std::copysign(1.0, paraxial * image_height_mm);
  const double wanted = std::abs(image_height_mm);
  const double stride = lens_.object_distance_mm ? *lens_.object_distance_mm / 50 : 1.0;
  double low = 0, high = 0;
  for (int i = 1;; ++i) {
    high = stride * i;
    if (!lens_.object_distance_mm && high >= 180) return {};
    if (i > 100000) return {};
    const std::optional<ChiefRay> chief = chief_ray(direction * high);
    if (chief && std::abs(chief->image_height_mm) >= wanted) break;
    if (!chief) {
      // The last field that passes may lie inside this stride: halve towards it.
      double passes = low, fails = high;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (passes + fails);
        (chief_ray(direction * middle) ? passes : fails) = middle;
      }
      const std::optional<ChiefRay> last = chief_ray(direction * passes);
      if (!last || std::abs(last->image_height_mm) < wanted) return {};
      high = passes;
      break;
    }
    low = high;
  }
  for (int i = 0; i < 100 && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    const std::optional<ChiefRay> chief = chief_ray(direction * middle);
    (chief && std::abs(chief->image_height_mm) < wanted ? low : high) = middle;
  }
  return direction * 0.5 * (low + high);
}

}  // namespace petzval
