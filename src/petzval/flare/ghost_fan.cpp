// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/flare/ghost_fan.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace petzval {

namespace {

/// The widest clear radius of the lens: no ray that passes enters farther out than twice as far.
double widest_mm(const Tracer& tracer) {
  double widest = tracer.stop_radius_mm();
  for (std::size_t i = 0; i < tracer.surface_count(); ++i)
    if (const double radius = std::sqrt(tracer.clip_radius_sq(i, Tracer::Clip::apertures));
        std::isfinite(radius))
      widest = std::max(widest, radius);
  return widest;
}

}  // namespace

std::vector<GhostRay> ghost_fan(const GhostTracer& tracer, const GhostPair& pair, const SourceBeam& beam,
                                int count, double lead_mm) {
  constexpr int tries = 2000;
  const double reach = 2 * widest_mm(tracer.tracer());
  std::optional<double> low, high;
  for (int i = 0; i <= tries; ++i) {
    const double y = reach * (2.0 * i / tries - 1);
    const GhostLanding end = tracer.follow(beam.ray(0, y), pair);
    if (!end.arrives || end.clearance > 0) continue;
    if (!low) low = y;
    high = y;
  }
  std::vector<GhostRay> fan;
  if (!low) return fan;
  for (int k = 0; k < count; ++k) {
    const double y = count == 1 ? 0.5 * (*low + *high) : *low + (*high - *low) * k / (count - 1);
    const Ray start = beam.ray(0, y);
    std::vector<std::array<double, 3>> places;
    const GhostLanding end = tracer.follow(start, pair, &places);
    if (!end.arrives || end.clearance > 0) continue;
    GhostRay ray{{-lead_mm, y - lead_mm * start.direction[1] / start.direction[2]}};
    for (const auto& [px, py, pz] : places) ray.push_back({pz, py});
    fan.push_back(std::move(ray));
  }
  return fan;
}

}  // namespace petzval
