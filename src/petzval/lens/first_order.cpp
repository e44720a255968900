// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/paraxial_system.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/surface_shape.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace petzval {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Farther than this is at infinity: ten thousand kilometres; a double resolves powers of ordinary lenses to
/// 10^-16.
constexpr double infinitely_far_mm = 1e10;

/// numerator/denominator as a distance that may be infinite.
double distance_mm(double numerator, double denominator) {
  if (denominator == 0) return numerator < 0 ? -infinity : infinity;
  const double distance = numerator / denominator;
  return std::abs(distance) > infinitely_far_mm ? std::copysign(infinity, distance) : distance;
}

/// The paraxial ray from the axial object point, of unit height (object at infinity) or unit slope.
struct UnitMarginalRay {
  double stop_height = 0, image_height_at_last_vertex = 0, image_reduced_slope = 0;

  UnitMarginalRay(const ParaxialSystem& system, std::optional<double> object_distance_mm) {
    const double y = object_distance_mm.value_or(1), w = object_distance_mm ? system.object_index : 0;
    stop_height = system.to_stop.height(y, w);
    image_height_at_last_vertex = system.whole.height(y, w);
    image_reduced_slope = system.whole.reduced_slope(y, w);
  }
};

double efl_mm(const ParaxialSystem& system) {
  return distance_mm(-1, system.whole.c);
}

double paraxial_image_mm(const ParaxialSystem& system, const UnitMarginalRay& ray) {
  return distance_mm(-system.image_index * ray.image_height_at_last_vertex, ray.image_reduced_slope);
}

/// Semi-diameter of the stop that gives the lens its aperture, at the reference wavelength.
double stop_semi_diameter_mm(const Lens& lens) {
  using Kind = Aperture::Kind;
  const ParaxialSystem system = paraxial_system(lens, lens.reference_wavelength_nm);
  const UnitMarginalRay unit(system, lens.object_distance_mm);
  const double value = lens.aperture.value;
  const auto from_entrance_pupil = [&](double diameter_mm) {
    if (std::isinf(distance_mm(system.to_stop.b, system.to_stop.a)))
      throw InputError(
          "aperture: the lens is telecentric in object space, its entrance pupil has no diameter; give "
          "stop_semi_diameter_mm, image_na or object_na");
    return 0.5 * diameter_mm * std::abs(system.to_stop.a);
  };
  const auto from_image_na = [&](double na) {
    if (std::isinf(paraxial_image_mm(system, unit)))
      throw InputError(
          "aperture: light from the object leaves this lens collimated, there is no cone to an image; "
          "give entrance_pupil_diameter_mm or stop_semi_diameter_mm");
    return na / std::abs(unit.image_reduced_slope) * std::abs(unit.stop_height);
  };
  switch (lens.aperture.kind) {
    case Kind::stop_semi_diameter_mm:
      return value;
    case Kind::entrance_pupil_diameter_mm:
      return from_entrance_pupil(value);
    case Kind::image_na:
      return from_image_na(value);
    case Kind::working_f_number:
      return from_image_na(0.5 / value);
    case Kind::object_na:
      return std::tan(std::asin(value / system.object_index)) * std::abs(unit.stop_height);
    case Kind::f_number:
      break;
  }
  if (std::isinf(efl_mm(system)))
    throw InputError(
        "aperture: the lens is afocal and has no f-number; give entrance_pupil_diameter_mm or "
        "stop_semi_diameter_mm");
  return from_entrance_pupil(std::abs(efl_mm(system)) / value);
}

/// Where an object point of the lens's kind of field is: tangent of its angle at the entrance pupil, and
/// height below the axis (0 at infinity). See paraxial_image_height_mm() for the sign.
struct ObjectPoint {
  double tangent = 0, depth_mm = 0;
};

ObjectPoint object_point(const Lens& lens, const ParaxialSystem& system, double field) {
  using Kind = Fields::Kind;
  const double pupil_mm = distance_mm(system.object_index * system.to_stop.b, system.to_stop.a);
  const auto at_depth = [&](double depth_mm) {
    return ObjectPoint{depth_mm / (*lens.object_distance_mm + pupil_mm), depth_mm};
  };
  if (lens.fields.kind == Kind::angle_deg) {
    // A fisheye may look sideways and back, where a tangent says nothing.
    const double tangent = std::abs(field) < 90 ? std::tan(radians(field)) : std::copysign(infinity, field);
    return {tangent, lens.object_distance_mm ? tangent * (*lens.object_distance_mm + pupil_mm) : 0};
  }
  if (lens.fields.kind == Kind::object_height_mm) return at_depth(-field);
  if (!lens.object_distance_mm) return {-field * system.whole.c / system.object_index, 0};
  return at_depth(-field * UnitMarginalRay(system, lens.object_distance_mm).image_reduced_slope /
                  system.object_index);
}

void fill_field(FirstOrder& result, const Lens& lens, const ParaxialSystem& system, double marginal_scale) {
  double largest = 0;
  for (const double field : lens.fields.values) largest = std::max(largest, std::abs(field));
  const ObjectPoint point = object_point(lens, system, largest);
  const bool is_angle = lens.fields.kind == Fields::Kind::angle_deg;
  result.field_of_view_deg = 2 * (is_angle ? largest : degrees(std::atan(std::abs(point.tangent))));
  result.lagrange_invariant_mm = system.object_index * marginal_scale *
                                 std::abs(lens.object_distance_mm ? point.depth_mm : point.tangent);
}

void fill_pupils(FirstOrder& result, const Lens& lens, const ParaxialSystem& system) {
  const double stop_diameter = 2 * result.stop_semi_diameter_mm;
  const ParaxialMatrix &front = system.to_stop, &rear = system.from_stop;
  result.entrance_pupil.position_mm = distance_mm(system.object_index * front.b, front.a);
  result.entrance_pupil.diameter_mm = distance_mm(stop_diameter, std::abs(front.a));
  const double from_last_vertex = distance_mm(-system.image_index * rear.b, rear.d);
  result.exit_pupil.position_mm = from_last_vertex - lens.image_distance_mm();
  result.exit_pupil.diameter_mm = distance_mm(stop_diameter, std::abs(rear.d));
}

}  // namespace

FirstOrder first_order(const Lens& lens, std::optional<double> wavelength_nm) {
  FirstOrder result;
  result.wavelength_nm = wavelength_nm.value_or(lens.reference_wavelength_nm);
  const ParaxialSystem system = paraxial_system(lens, result.wavelength_nm);
  const UnitMarginalRay unit(system, lens.object_distance_mm);
  result.efl_mm = efl_mm(system);
  result.bfl_mm = distance_mm(-system.image_index * system.whole.a, system.whole.c);
  result.ffl_mm = distance_mm(system.object_index * system.whole.d, system.whole.c);
  result.petzval_radius_mm = distance_mm(-1, system.image_index * system.petzval_sum_per_mm);
  result.total_track_mm = lens.total_track_mm();
  result.paraxial_image_mm = paraxial_image_mm(system, unit);
  result.magnification = lens.object_distance_mm ? system.object_index / unit.image_reduced_slope : 0;

  result.stop_semi_diameter_mm = stop_semi_diameter_mm(lens);
  const double scale = result.stop_semi_diameter_mm / std::abs(unit.stop_height);
  if (!std::isfinite(scale) || scale == 0)
    throw InputError(
        "aperture: the stop stands at an image of the object, where it cannot limit the light; move the "
        "stop or the object");
  fill_pupils(result, lens, system);
  result.f_number = std::abs(result.efl_mm) / result.entrance_pupil.diameter_mm;
  result.image_space_na = scale * std::abs(unit.image_reduced_slope);
  result.working_f_number = std::isinf(result.paraxial_image_mm) ? infinity : 0.5 / result.image_space_na;
  fill_field(result, lens, system, scale);
  return result;
}

ParaxialRay trace_paraxial(const Lens& lens, double height_mm, double slope, double wavelength_nm) {
  ParaxialRay ray;
  double height = height_mm, u = slope, index = lens.object_material.index(wavelength_nm), sense = 1;
  std::optional<double> leaving;
  for (const Surface& surface : lens.surfaces) {
    const double index_after = surface.mirror ? index : surface.material.index(wavelength_nm);
    ray.height_mm.push_back(height);
    if (surface.transfer) {
      // Straight across the box, out of it with the slope that the transfer gives: two steps of one table.
      const RayTransfer::Paraxial transfer = surface.transfer->paraxial(wavelength_nm);
      const double behind = transfer.a * height + transfer.b * u;
      leaving = transfer.c * height + transfer.d * u;
      ray.slope.push_back((behind - height) / surface.thickness_mm);
      height = behind;
      continue;
    }
    if (leaving) u = *std::exchange(leaving, std::nullopt);
    const double step = surface.mirror ? -2 * index : index_after - index;
    const double power = surface.ideal_lens ? 1 / surface.ideal_lens->focal_length_mm
                                            : step * sense * vertex_curvature_per_mm(surface);
    u = (index * u - height * power) / index_after;
    if (surface.mirror) sense = -sense;
    ray.slope.push_back(u);
    height += sense * surface.thickness_mm * u;
    index = index_after;
  }
  ray.height_mm.push_back(height);
  return ray;
}

double paraxial_image_distance_mm(const Lens& lens, std::optional<double> object_distance_mm,
                                  double wavelength_nm) {
  const ParaxialSystem system = paraxial_system(lens, wavelength_nm);
  return paraxial_image_mm(system, UnitMarginalRay(system, object_distance_mm));
}

double entrance_pupil_diameter_mm(const Lens& lens, double wavelength_nm) {
  const ParaxialSystem system = paraxial_system(lens, wavelength_nm);
  return distance_mm(2 * stop_semi_diameter_mm(lens), std::abs(system.to_stop.a));
}

double paraxial_image_height_mm(const Lens& lens, double object_field, double wavelength_nm) {
  using Kind = Fields::Kind;
  if (lens.fields.kind == Kind::paraxial_image_height_mm || lens.fields.kind == Kind::real_image_height_mm)
    return object_field;
  const ParaxialSystem system = paraxial_system(lens, wavelength_nm);
  const ObjectPoint point = object_point(lens, system, object_field);
  if (!lens.object_distance_mm) return system.object_index * point.tangent * efl_mm(system);
  return -point.depth_mm * system.object_index /
         UnitMarginalRay(system, lens.object_distance_mm).image_reduced_slope;
}

}  // namespace petzval
