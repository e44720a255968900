// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/trace/stop_corners.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace petzval {

namespace {

/// Of the stop's radius. Panels of a quadrature end here: an error of this share costs its square.
constexpr double corner_tolerance = 1e-9;
/// Neighbouring rays, as a share of the pupil.
constexpr double nudge_per_scale = 1e-6;
constexpr int most_steps = 30;

using Point = std::array<double, 2>;

std::optional<Point> at_stop(const Tracer& tracer, const Pencil& pencil, const Point& label) {
  const Tracer::Clearance traced = pencil.clearance(tracer, label[0], label[1], Tracer::Clip::none);
  if (!traced.reached_stop || !std::isfinite(traced.stop_x_mm)) return {};
  return Point{traced.stop_x_mm, traced.stop_y_mm};
}

}  // namespace

std::optional<Point> aim_at_stop(const Tracer& tracer, const Pencil& pencil, const Point& wanted, Point label,
                                 double scale, double tolerance) {
  const double nudge = nudge_per_scale * scale;
  const double size = std::isfinite(tracer.stop_radius_mm()) ? tracer.stop_radius_mm() : 1;
  const double close = std::max(tolerance * size, pencil.rounding_mm());
  for (int step = 0; step < most_steps; ++step) {
    const auto here = at_stop(tracer, pencil, label);
    const auto right = at_stop(tracer, pencil, {label[0] + nudge, label[1]});
    const auto above = at_stop(tracer, pencil, {label[0], label[1] + nudge});
    if (!here || !right || !above) return {};
    const double miss_x = wanted[0] - (*here)[0], miss_y = wanted[1] - (*here)[1];
    if (std::hypot(miss_x, miss_y) < close) return label;
    const double xu = ((*right)[0] - (*here)[0]) / nudge, yu = ((*right)[1] - (*here)[1]) / nudge;
    const double xv = ((*above)[0] - (*here)[0]) / nudge, yv = ((*above)[1] - (*here)[1]) / nudge;
    const double area = xu * yv - xv * yu;
    const double du = (miss_x * yv - miss_y * xv) / area, dv = (miss_y * xu - miss_x * yu) / area;
    if (!std::isfinite(du) || !std::isfinite(dv)) return {};
    // No step is longer than half the pupil: far out the rays may fail.
    const double shorter = std::min(1.0, 0.5 * scale / std::hypot(du, dv));
    label = {label[0] + shorter * du, label[1] + shorter * dv};
  }
  return {};
}

double pupil_scale(const Tracer& tracer, const Pencil& pencil, const Point& chief) {
  const auto [u, v] = chief;
  const double nudge = std::min(1e-6 * std::max(1e-3, std::abs(v)), label_nudge(tracer, pencil));
  const auto above = pencil.clearance(tracer, u, v + nudge, Tracer::Clip::none);
  const auto below = pencil.clearance(tracer, u, v - nudge, Tracer::Clip::none);
  const double slope = (above.stop_y_mm - below.stop_y_mm) / (2 * nudge);
  return above.reached_stop && below.reached_stop && slope != 0 ? std::abs(tracer.stop_radius_mm() / slope)
                                                                : nudge;
}

std::vector<Point> aim_at_corners(const Tracer& tracer, const Pencil& pencil, const Point& chief,
                                  double scale) {
  std::vector<Point> labels;
  const StopBlades& blades = tracer.stop_blades();
  for (int i = 0; i < blades.count; ++i) {
    const double turn = radians(90 + blades.rotation_deg) + 2 * pi * i / blades.count;
    const Point corner{tracer.stop_radius_mm() * std::cos(turn), tracer.stop_radius_mm() * std::sin(turn)};
    if (const auto label = aim_at_stop(tracer, pencil, corner, chief, scale, corner_tolerance))
      labels.push_back(*label);
  }
  return labels;
}

}  // namespace petzval
