// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/trace/passing_region.h>
#include <petzval/trace/stop_corners.h>

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

namespace {

Tracer turned_tracer(const Lens& lens, double wavelength_nm, double azimuth_deg) {
  Tracer tracer(lens, wavelength_nm);
  return azimuth_deg == 0 ? tracer : tracer.turned(-radians(azimuth_deg));
}

std::optional<Tracer> designed_tracer(const Lens& lens, const Tracer& built) {
  if (built.is_centred()) return {};
  return Tracer(as_designed(lens), built.wavelength_nm(), built.stop_radius_mm());
}

/// The chief ray of a lens with poses hits the stop's centre to this share of its radius.
constexpr double chief_aim_tolerance = 1e-11;

}  // namespace

FieldTracer::FieldTracer(const Lens& lens, double wavelength_nm, Tracer::Clip clip, double azimuth_deg)
    : lens_(lens),
      tracer_(turned_tracer(lens_, wavelength_nm, azimuth_deg)),
      designed_(designed_tracer(lens_, tracer_)),
      clip_(clip),
      march_(lens_, designed_ ? *designed_ : tracer_) {
  set_losses({});
}

std::optional<ChiefRay> FieldTracer::chief_ray(double object_field) {
  const std::optional<double> v = march_.v_at(object_field);
  if (!v) return {};
  ChiefRay chief;
  chief.object_field = object_field;
  chief.v = *v;
  if (designed_) return aimed_chief(tracer_, chief);
  chief.at_image = tracer_.trace(*Pencil::from_object(lens_, object_field).ray(0, *v), Tracer::Clip::none);
  if (chief.at_image.status != RayStatus::ok) return {};
  chief.image_height_mm = chief.at_image.point_mm[1];
  return chief;
}

std::optional<ChiefRay> FieldTracer::aimed_chief(const Tracer& tracer, ChiefRay chief) const {
  const Pencil pencil = Pencil::from_object(lens_, chief.object_field);
  const double scale = pupil_scale(*designed_, pencil, {0, chief.v});
  const auto aimed = aim_at_stop(tracer, pencil, {0, 0}, {0, chief.v}, scale, chief_aim_tolerance);
  if (!aimed) return {};
  chief.u = (*aimed)[0], chief.v = (*aimed)[1];
  chief.at_image = tracer.trace(*pencil.ray(chief.u, chief.v), Tracer::Clip::none);
  if (chief.at_image.status != RayStatus::ok) return {};
  chief.image_x_mm = chief.at_image.point_mm[0], chief.image_height_mm = chief.at_image.point_mm[1];
  return chief;
}

std::optional<std::array<double, 2>> FieldTracer::image_of(double across, double along, double forward) {
  const double away = std::hypot(across, along), turn = away > 0 ? std::atan2(across, along) : 0;
  ChiefRay chief;
  chief.object_field = lens_.object_distance_mm ? away : degrees(std::atan2(away, forward));
  const std::optional<double> v = march_.v_at(chief.object_field);
  if (!v) return {};
  chief.v = *v;
  const std::optional<ChiefRay> at = aimed_chief(tracer_.turned(turn), chief);
  if (!at) return {};
  return std::array{at->image_x_mm * std::cos(turn) + at->image_height_mm * std::sin(turn),
                    at->image_height_mm * std::cos(turn) - at->image_x_mm * std::sin(turn)};
}

std::optional<std::array<double, 2>> FieldTracer::landing_mm(double object_x, double object_y) {
  const double field = std::hypot(object_x, object_y);
  if (!designed_) {
    const std::optional<ChiefRay> chief = chief_ray(field);
    if (!chief) return {};
    const double per_field = field > 0 ? chief->image_height_mm / field : 0;
    return std::array{per_field * object_x, per_field * object_y};
  }
  if (lens_.object_distance_mm) return image_of(object_x, object_y, 1);
  const double per_degree = field > 0 ? std::sin(radians(field)) / field : 0;
  return image_of(per_degree * object_x, per_degree * object_y, std::cos(radians(field)));
}

double FieldTracer::object_area_by_neighbours(const ChiefRay& chief) {
  const bool far = !lens_.object_distance_mm;
  const double step = far ? radians(difference_deg) : difference_step(lens_);
  const double field = far ? radians(chief.object_field) : chief.object_field;
  const double sine = far ? std::sin(field) : field, cosine = far ? std::cos(field) : 1;
  // Neighbours across the field and along it, of an object at infinity on the sphere of directions.
  const auto right = image_of(step, sine, cosine), left = image_of(-step, sine, cosine);
  const double rise = far ? step * cosine : step, fall = far ? -step * sine : 0;
  const auto above = image_of(0, sine + rise, cosine + fall), below = image_of(0, sine - rise, cosine - fall);
  if (!right || !left || !above || !below)
    throw InputError(fmt::format("no chief ray beside the field {:g}", chief.object_field));
  const double area = ((*right)[0] - (*left)[0]) * ((*above)[1] - (*below)[1]) -
                      ((*right)[1] - (*left)[1]) * ((*above)[0] - (*below)[0]);
  if (!(std::abs(area) > 0))
    throw InputError(fmt::format("the image of field {:g} does not move with the field", chief.object_field));
  return 4 * step * step / std::abs(area);
}

Pencil FieldTracer::image_pencil(const ChiefRay& chief) const {
  return Pencil::from_image(tracer_, chief.image_height_mm, chief.image_x_mm);
}

std::optional<PupilBoundary> FieldTracer::object_pupil(const ChiefRay& chief, int azimuths) const {
  return find_pupil(tracer_, Pencil::from_object(lens_, chief.object_field), chief.v, azimuths, clip_,
                    chief.u);
}

std::optional<PupilBoundary> FieldTracer::round_object_pupil(const ChiefRay& chief, int azimuths) const {
  return find_pupil(tracer_.with_blades({}), Pencil::from_object(lens_, chief.object_field), chief.v,
                    azimuths, clip_, chief.u);
}

std::optional<PupilBoundary> FieldTracer::image_pupil(const ChiefRay& chief, int azimuths) const {
  return find_pupil(tracer_, image_pencil(chief), chief.at_image.direction[1], azimuths, clip_,
                    designed_ ? chief.at_image.direction[0] : 0);
}

bool FieldTracer::image_pupil_in_one_piece(const ChiefRay& chief) const {
  const auto in_one_piece = [&](const Tracer& tracer, double image_x_mm) {
    const Pencil pencil = Pencil::from_image(tracer, chief.image_height_mm, image_x_mm);
    const auto region = find_passing_region(tracer, pencil, clip_);
    return !region || (region->parts() == 1 && !region->has_hole());
  };
  return in_one_piece(tracer_, chief.image_x_mm) &&
         (!designed_ || in_one_piece(tracer_.mirrored(), -chief.image_x_mm));
}

double FieldTracer::g_sensor_sr(const ChiefRay& chief) const {
  const std::optional<PupilBoundary> pupil = image_pupil(chief);
  const double n = tracer_.image_index() / tracer_.object_index();
  return pupil ? n * n * lit_area(image_pencil(chief), *pupil) : 0.0;
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
  const bool obscured = clip_ == Tracer::Clip::apertures && has_obscurations(lens_);
  if (!losses.of(lens_).any() && !obscured) return;
  transmittance_.emplace(lens_, tracer_.wavelength_nm(), losses);
  if (obscured) transmittance_->heed_obscurations(tracer_);
}

double FieldTracer::lit_area(const Pencil& pencil, const PupilBoundary& pupil) const {
  return transmittance_ ? transmitted_area(tracer_, pencil, pupil, *transmittance_) : pupil.area();
}

double FieldTracer::object_area_per_image_area(const ChiefRay& chief) {
  if (designed_) return object_area_by_neighbours(chief);
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
