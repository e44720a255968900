// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/trace/pencil.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

/// The chief ray hits the stop's centre to this share of its radius.
constexpr double aim_tolerance = 1e-13;
/// March no farther than this between chief rays: far less than any pupil wanders between them.
constexpr double march_step_deg = 2.0;
constexpr double march_steps_per_tangent = 30;
/// Steps are halved down to this share before a chief ray is given up.
constexpr double smallest_step_share = 1e-3;
/// A predicted ray may miss the centre of a pinhole stop by this [mm].
constexpr double least_catch_mm = 1e-3;
constexpr int scan_points = 2000;
/// From here on rays of object points start near the lens [mm].
constexpr double far_mm = 1e5;
/// Differences for slopes, as a share of all labels there are, and of the stop where objects are so far away
/// that this is more than the pupil.
constexpr double nudge_per_range = 1e-7, nudge_per_stop = 1e-4;
/// Roundings that a stop height may have gathered.
constexpr double roundings = 64;

/// Height at the stop of the meridional ray v, or NaN.
double stop_height(const Tracer& tracer, const Pencil& pencil, double v) {
  const Tracer::Clearance traced = pencil.clearance(tracer, 0, v, Tracer::Clip::none);
  return traced.reached_stop ? traced.stop_y_mm : std::numeric_limits<double>::quiet_NaN();
}

std::optional<double> newton_on_stop(const Tracer& tracer, const Pencil& pencil, double v) {
  const double nudge = label_nudge(tracer, pencil);
  const double close = std::max(1e3 * aim_tolerance * tracer.stop_radius_mm(), pencil.rounding_mm());
  double height = stop_height(tracer, pencil, v);
  for (int i = 0; i < 40; ++i) {
    if (!std::isfinite(height)) return {};
    const double slope =
        (stop_height(tracer, pencil, v + nudge) - stop_height(tracer, pencil, v - nudge)) / (2 * nudge);
    if (!std::isfinite(slope) || slope == 0) return {};
    const double step = height / slope;
    const double next_height = stop_height(tracer, pencil, v - step);
    // Converged when the next step no longer helps: the last digits of the height are rounding.
    const bool small = std::abs(height) < aim_tolerance * tracer.stop_radius_mm();
    const bool stalled = std::abs(height) < close && !(std::abs(next_height) < std::abs(height));
    if (small || stalled) return v;
    v -= step;
    height = next_height;
  }
  return {};
}

/// Bisection on a bracket of the stop height's sign.
double bisect_on_stop(const Tracer& tracer, const Pencil& pencil, double low, double high) {
  const bool low_negative = stop_height(tracer, pencil, low) < 0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (((stop_height(tracer, pencil, middle) < 0) == low_negative) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::optional<double> scan_for_chief(const Tracer& tracer, const Pencil& pencil, double guess) {
  const LabelRange range = label_range(tracer, pencil);
  std::optional<double> best;
  double previous_v = 0, previous = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i <= scan_points; ++i) {
    const double v = range.low + (range.high - range.low) * i / scan_points;
    const double height = stop_height(tracer, pencil, v);
    if (std::isfinite(height) && std::isfinite(previous) && (height < 0) != (previous < 0)) {
      const double root = bisect_on_stop(tracer, pencil, previous_v, v);
      if (!best || std::abs(root - guess) < std::abs(*best - guess)) best = root;
    }
    previous_v = v;
    previous = height;
  }
  return best;
}

}  // namespace

LabelRange label_range(const Tracer& tracer, const Pencil& pencil) {
  if (!pencil.object_at_infinity()) return {-1, 1};
  double size = std::abs(tracer.image_z_mm());
  if (std::isfinite(tracer.stop_radius_mm())) size += tracer.stop_radius_mm();
  for (const Tracer::PreparedSurface& surface : tracer.surfaces()) {
    if (surface.mirror) size = std::max(size, std::abs(surface.vertex_z_mm));  // a folded lens is short
    if (std::isfinite(surface.clear_radius_sq)) size = std::max(size, std::sqrt(surface.clear_radius_sq));
  }
  double reach = size;
  for (const Tracer::PreparedSurface& surface : tracer.surfaces())
    if (surface.shape.curvature != 0)
      reach = std::max(reach, std::min(1 / std::abs(surface.shape.curvature), 10 * size));
  return {-2 * reach, 2 * reach};
}

double label_nudge(const Tracer& tracer, const Pencil& pencil) {
  const LabelRange range = label_range(tracer, pencil);
  const double widest = nudge_per_range * (range.high - range.low);
  if (pencil.object_at_infinity() || pencil.backward() || !std::isfinite(tracer.stop_radius_mm()))
    return widest;
  const double step_mm = nudge_per_stop * std::max(tracer.stop_radius_mm(), least_catch_mm);
  return std::min(widest, pencil.v_through(step_mm) - pencil.v_through(0));
}

Pencil Pencil::from_object(const Lens& lens, double field) {
  if (!std::isfinite(field)) throw InputError("a field must be a finite number");
  if (lens.object_distance_mm) return Pencil(Kind::object_point, field, -*lens.object_distance_mm);
  if (std::abs(field) >= 180)
    throw InputError(fmt::format("a field angle of {:g}° looks backwards; it must lie inside ±180°", field));
  return Pencil(Kind::parallel, std::sin(radians(field)), std::cos(radians(field)));
}

Pencil Pencil::from_image(const Tracer& tracer, double image_height_mm, double image_x_mm) {
  return Pencil(Kind::image_point, image_height_mm, tracer.image_z_mm(), image_x_mm);
}

std::array<double, 3> Pencil::point_mm() const {
  if (kind_ == Kind::parallel) return {0, 0, -std::numeric_limits<double>::infinity()};
  return {x_, y_, z_};
}

double Pencil::entrance_mm(double v) const {
  return kind_ == Kind::object_point ? y_ - z_ * v / std::sqrt(1 - v * v) : v;
}

double Pencil::v_through(double entrance_mm) const {
  if (kind_ != Kind::object_point) return entrance_mm;
  const double rise = std::copysign(1.0, -z_) * (entrance_mm - y_);
  return rise / std::hypot(rise, z_);
}

double Pencil::rounding_mm() const {
  return kind_ == Kind::object_point ? roundings * std::numeric_limits<double>::epsilon() * std::hypot(y_, z_)
                                     : 0;
}

std::optional<Ray> Pencil::ray(double u, double v) const {
  if (kind_ == Kind::parallel) return Ray{{u, v * z_, -v * y_}, {0, y_, z_}};
  const double cosine_sq = 1 - u * u - v * v;
  if (!(cosine_sq > 0)) return {};
  const double cosine = std::sqrt(cosine_sq);
  // A backward ray travels against the light.
  if (kind_ == Kind::image_point) return Ray{{x_, y_, z_}, {-u, -v, -cosine}};
  if (-z_ < far_mm) return Ray{{0, y_, z_}, {u, v, cosine}};
  const double way = -(y_ * v + z_ * cosine);
  const double x = way * u, y = y_ + way * v, z = -(x * u + y * v) / cosine;
  return Ray{{x, y, z}, {u, v, cosine}, -(x * x + y * y + z * z) / (std::hypot(y_, z_) + way)};
}

Tracer::Clearance Pencil::clearance(const Tracer& tracer, double u, double v, Tracer::Clip clip) const {
  if (const std::optional<Ray> launched = ray(u, v)) return tracer.clearance(*launched, backward(), clip);
  Tracer::Clearance outside;
  outside.worst = std::numeric_limits<double>::infinity();
  return outside;
}

std::optional<double> aim_chief_ray(const Tracer& tracer, const Pencil& pencil, double guess) {
  if (const std::optional<double> found = newton_on_stop(tracer, pencil, guess)) return found;
  const std::optional<double> scanned = scan_for_chief(tracer, pencil, guess);
  if (!scanned) return {};
  const std::optional<double> polished = newton_on_stop(tracer, pencil, *scanned);
  return polished ? polished : scanned;
}

ChiefRayMarch::ChiefRayMarch(const Lens& lens, const Tracer& tracer, From from)
    : lens_(lens), tracer_(tracer), from_(from) {
  if (from == From::object && !lens.object_distance_mm) {
    step_ = march_step_deg;
  } else if (from == From::object) {
    // Before an object that nearly touches the lens tangents are as small as the pupil is far.
    constexpr double nearest_share = 1e-3;
    const double to_pupil_mm = std::abs(*lens.object_distance_mm +
                                        first_order(lens, tracer.wavelength_nm()).entrance_pupil.position_mm);
    step_ = std::max(*lens.object_distance_mm, std::isfinite(to_pupil_mm) ? nearest_share * to_pupil_mm : 0) /
            march_steps_per_tangent;
  } else {
    const double exit_pupil = std::abs(first_order(lens, tracer.wavelength_nm()).exit_pupil.position_mm);
    step_ = (std::isfinite(exit_pupil) ? std::max(exit_pupil, tracer.stop_radius_mm())
                                       : std::abs(tracer.image_z_mm())) /
            march_steps_per_tangent;
  }
}

Pencil ChiefRayMarch::pencil_at(double field) const {
  return from_ == From::object ? Pencil::from_object(lens_, field) : Pencil::from_image(tracer_, field);
}

std::optional<double> ChiefRayMarch::v_at(double field) {
  // From the last field inwards or outwards, or from the axis if that is nearer.
  if (std::abs(field) < 0.5 * std::abs(last_field_) || field * last_field_ < 0)
    last_field_ = last_v_ = last_entrance_ = slope_ = 0;
  double step = step_;
  while (last_field_ != field) {
    const double remaining = field - last_field_;
    const double next = std::abs(remaining) <= step ? field : last_field_ + std::copysign(step, remaining);
    const double predicted = last_entrance_ + slope_ * (next - last_field_);
    const Pencil pencil = pencil_at(next);
    if (const std::optional<double> v = follow(pencil, pencil.v_through(predicted))) {
      const double entrance = pencil.entrance_mm(*v);
      slope_ = (entrance - last_entrance_) / (next - last_field_);
      last_entrance_ = entrance;
      last_v_ = *v;
      last_field_ = next;
      step = std::min(2 * step, step_);
    } else {
      step = 0.5 * std::min(step, std::abs(remaining));
      if (step < smallest_step_share * step_) return {};
    }
  }
  return last_v_;
}

std::optional<double> ChiefRayMarch::follow(const Pencil& pencil, double predicted) const {
  // A neighbour of the last chief ray: it starts inside the stop, so that Newton cannot jump to another
  // branch.
  const double height = stop_height(tracer_, pencil, predicted);
  if (!(std::abs(height) < std::max(tracer_.stop_radius_mm(), least_catch_mm))) return {};
  return newton_on_stop(tracer_, pencil, predicted);
}

}  // namespace petzval
