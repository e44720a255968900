// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/trace/tracer.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

constexpr double unlimited_mm = std::numeric_limits<double>::infinity();

/// The on-axis ray towards the edge of the paraxial entrance pupil.
Ray ray_to_pupil_edge(const Lens& lens, const FirstOrder& paraxial) {
  const double edge = 0.5 * paraxial.entrance_pupil.diameter_mm;
  if (!lens.object_distance_mm) return {{0, edge, 0}, {0, 0, 1}};
  const double to_pupil = *lens.object_distance_mm + paraxial.entrance_pupil.position_mm;
  if (!std::isfinite(to_pupil) || !std::isfinite(edge))
    throw InputError(
        "the lens is telecentric in object space, so its entrance pupil gives no stop radius; "
        "give aperture.stop_semi_diameter_mm instead");
  // A pupil in front of the object is seen backwards: the same line, travelled towards the lens.
  const double length = std::copysign(std::hypot(edge, to_pupil), to_pupil);
  return {{0, 0, -*lens.object_distance_mm}, {0, edge / length, to_pupil / length}};
}

/// The radius that the lens's `aperture` asks for, whatever the stop's own rim. Nothing when the real ray to
/// the edge of the paraxial pupil does not reach the stop: the glass passes less than was asked. \throws
/// InputError in that case, if `must_reach`.
std::optional<double> asked_radius_mm(const Lens& lens, bool must_reach) {
  if (lens.aperture.kind == Aperture::Kind::stop_semi_diameter_mm) return lens.aperture.value;
  const FirstOrder paraxial = first_order(lens, lens.reference_wavelength_nm);
  const Tracer tracer(as_designed(lens), lens.reference_wavelength_nm, unlimited_mm);
  const Tracer::Clearance traced =
      tracer.clearance(ray_to_pupil_edge(lens, paraxial), false, Tracer::Clip::none);
  if (!traced.reached_stop && !must_reach) return {};
  if (!traced.reached_stop)
    throw InputError(
        fmt::format("{}: the aperture is too wide: the ray to the edge of the entrance pupil ({:.6g} mm in "
                    "diameter) fails at "
                    "surfaces[{}]; a smaller aperture, or aperture.stop_semi_diameter_mm, would be right",
                    lens.name, paraxial.entrance_pupil.diameter_mm, traced.ray.failed_at));
  return std::hypot(traced.stop_x_mm, traced.stop_y_mm);
}

}  // namespace

double stop_radius_mm(const Lens& lens) {
  const std::optional<double>& rim = lens.surfaces[lens.stop_index()].semi_diameter_mm;
  const std::optional<double> asked = asked_radius_mm(lens, !rim.has_value());
  return std::min(rim.value_or(unlimited_mm), asked.value_or(unlimited_mm));
}

}  // namespace petzval
