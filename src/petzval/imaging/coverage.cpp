// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/coverage.h>
#include <petzval/imaging/field_of_view.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double percent = 100;

/// What a turned camera sees, from the middle of the scene: a rectangle becomes a quadrangle, whose corners
/// lie farthest.
SeenExtent aimed(SeenExtent seen, const AimedPlane& plane) {
  if (plane.is_straight()) return seen;
  SeenExtent turned;
  for (const double right : {-seen.columns, seen.columns})
    for (const double down : {-seen.rows, seen.rows}) {
      const AimedPlane::Place place = plane.at(right, down);
      if (std::isnan(place.right))
        throw InputError(
            "the camera turns away from the plane of the scene; a panorama, or a smaller turn, would be "
            "right");
      turned.columns = std::max(turned.columns, std::abs(place.right));
      turned.rows = std::max(turned.rows, std::abs(place.down));
      turned.radius = std::max(turned.radius, std::hypot(place.right, place.down));
    }
  return turned;
}

}  // namespace

void check_coverage(const Scene& scene, const SeenExtent& wanted, Surround surround,
                    std::vector<std::string>& notes, const SceneAim& aim) {
  if (scene.is_panorama()) return;  // it is everywhere
  const SeenExtent seen = aimed(wanted, {aim, scene});
  constexpr double rounding = 1 + 1e-9;
  if (2 * seen.columns <= scene.columns() * rounding && 2 * seen.rows <= scene.rows() * rounding) return;

  const auto full_angle = [&](double samples) {
    return degrees(2 * std::atan(samples * scene.tangent_per_sample()));
  };
  const double wide = full_angle(seen.columns), high = full_angle(seen.rows),
               across = full_angle(seen.radius);
  const auto short_by = [](double needed, double have) { return std::max(0.0, needed - have); };
  const double margin = margin_of(surround);
  const std::string shortfall = fmt::format(
      "the scene covers {:.2f}° × {:.2f}° ({:.2f}° across its corners), the frame{} {:.2f}° × {:.2f}° "
      "({:.2f}°): it falls short by {:.2f}° horizontally, {:.2f}° vertically and {:.2f}° diagonally",
      scene.horizontal_angle_deg(), scene.vertical_angle_deg(), scene.diagonal_angle_deg(),
      margin > 0 ? fmt::format(" and {:g} % beyond see", percent * margin) : " sees", wide, high, across,
      short_by(wide, scene.horizontal_angle_deg()), short_by(high, scene.vertical_angle_deg()),
      short_by(across, scene.diagonal_angle_deg()));
  if (surround == Surround::error)
    throw InputError(
        shortfall +
        "; a larger `scene.horizontal_angle_deg`, a smaller sensor, or `surround` zero or extend would do");
  notes.push_back(shortfall + (surround == Surround::zero
                                   ? "; beyond it is darkness (`surround` zero)"
                                   : "; beyond it its edge goes on (`surround` extend)"));
}

void note_dark_corners(const std::vector<BandPlan>& plans, const SensorGeometry& frame,
                       std::vector<std::string>& notes) {
  const double corner_mm = half_diagonal_mm(frame);
  double last_mm = corner_mm;
  for (const BandPlan& plan : plans) last_mm = std::min(last_mm, plan.map.last_height_mm());
  if (last_mm < corner_mm)
    notes.push_back(
        fmt::format("the last chief ray of the lens data table lands {:.4f} mm from the axis: beyond, "
                    "towards the corners at {:.4f} mm, the image is dark",
                    last_mm, corner_mm));
}

int points_per_cell(const std::vector<BandPlan>& plans, const SensorGeometry& frame) {
  constexpr int most = 64;
  double samples = 1;
  for (const BandPlan& plan : plans)
    samples = std::max(samples, plan.map.finest_samples_per_mm() * frame.pitch_um * mm_per_um);
  constexpr double rounding = 1e-6;
  return static_cast<int>(std::min<double>(most, std::ceil(samples - rounding)));
}

}  // namespace petzval
