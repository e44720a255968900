// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/pupil_fit.h>
#include <petzval/analysis/wave_rays.h>
#include <petzval/numeric/quadrature.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

/// The area inside a polar boundary cuts corners, by up to this; more is a pupil misunderstood.
constexpr double flux_tolerance = 0.01;
constexpr std::size_t azimuths_per_radial = 2;

/// A point of the rim, and whether one aperture takes over from another there.
struct RimPoint {
  double azimuth, radius;
  bool corner = false;
};

PupilNode node_at(const PupilBoundary& pupil, double azimuth, double radius) {
  return {radius * std::sin(azimuth), pupil.centre_v + radius * std::cos(azimuth), 0};
}

/// Walks along the rim of a boundary and finds the corners between its azimuths.
class RimWalk {
 public:
  RimWalk(const FieldTracer& tracer, const ChiefRay& chief, const PupilBoundary& pupil, double tolerance)
      : tracer_(tracer),
        pencil_(Pencil::from_object(tracer.lens(), chief.object_field)),
        pupil_(pupil),
        tolerance_(tolerance) {}

  /// The rim of the half pupil u ≥ 0, from +v on.
  std::vector<RimPoint> points() const {
    std::vector<RimPoint> points;
    int surface = -1;
    for (std::size_t i = 0; i < pupil_.radius.size() / 2; ++i) {
      const RimPoint next{pupil_.azimuth(i), pupil_.radius[i]};
      const int limits = clearance(next.azimuth, next.radius).surface;
      if (i > 0 && limits != surface) points.push_back(corner(points.back(), surface, next));
      points.push_back(next);
      surface = limits;
    }
    return points;
  }

 private:
  Tracer::Clearance clearance(double azimuth, double radius) const {
    const PupilNode node = node_at(pupil_, azimuth, radius);
    return pencil_.clearance(tracer_.tracer(), node.u, node.v, tracer_.clip());
  }

  /// Regula falsi (Illinois) from a bracket about both neighbours; they differ by little.
  double radius_at(double azimuth, double one, double other) const {
    const double spread = 2 * std::abs(one - other) + tolerance_ * one;
    double inside = std::min(one, other) - spread, outside = std::max(one, other) + spread;
    double worst_inside = clearance(azimuth, inside).worst, worst_outside = clearance(azimuth, outside).worst;
    if (!(worst_inside < 0) || !(worst_outside > 0)) {
      inside = 0.8 * std::min(one, other), outside = 1.2 * std::max(one, other);
      worst_inside = clearance(azimuth, inside).worst, worst_outside = clearance(azimuth, outside).worst;
    }
    if (!(worst_inside < 0) || !(worst_outside > 0)) return 0.5 * (one + other);
    int side = 0;
    for (int i = 0; i < 60 && outside - inside > tolerance_ * outside; ++i) {
      double middle = 0.5 * (inside + outside);
      if (std::isfinite(worst_outside) && i % 8 != 7)
        middle = (inside * worst_outside - outside * worst_inside) / (worst_outside - worst_inside);
      const double worst = clearance(azimuth, middle).worst;
      const int now = worst < 0 ? -1 : 1;
      (now < 0 ? inside : outside) = middle;
      (now < 0 ? worst_inside : worst_outside) = worst;
      if (now == side) (now < 0 ? worst_outside : worst_inside) *= 0.5;
      side = now;
    }
    return 0.5 * (inside + outside);
  }

  RimPoint corner(RimPoint low, int surface, RimPoint high) const {
    while (high.azimuth - low.azimuth > tolerance_) {
      const double azimuth = 0.5 * (low.azimuth + high.azimuth);
      const RimPoint middle{azimuth, radius_at(azimuth, low.radius, high.radius)};
      (clearance(azimuth, middle.radius).surface == surface ? low : high) = middle;
    }
    return {high.azimuth, high.radius, true};
  }

  const FieldTracer& tracer_;
  Pencil pencil_;
  const PupilBoundary& pupil_;
  double tolerance_;  ///< PupilFitLimits::corner_tolerance
};

/// The rim, then nodes inside.
std::vector<PupilNode> fit_nodes(const PupilBoundary& pupil, const std::vector<RimPoint>& rim,
                                 int radial_nodes) {
  const QuadratureRule radial = gauss_legendre(radial_nodes);
  std::vector<PupilNode> nodes;
  for (const RimPoint& point : rim) nodes.push_back(node_at(pupil, point.azimuth, point.radius));
  for (std::size_t i = 0; i < pupil.radius.size() / 2; i += azimuths_per_radial)
    for (const double share : radial.nodes)
      nodes.push_back(node_at(pupil, pupil.azimuth(i), share * pupil.radius[i]));
  return nodes;
}

/// Half of the rim, closed on α = 0 by its own symmetry; false if β does not fall all along it.
bool take_outline(const std::vector<WaveRay>& rays, const std::vector<RimPoint>& points, SmoothPupil& pupil) {
  const std::size_t rim = points.size();
  std::vector<double>& alpha = pupil.outline_alpha;
  std::vector<double>& beta = pupil.outline_beta;
  for (std::size_t i = 0; i < rim; ++i) {
    alpha.push_back(std::abs(rays[i].alpha));
    beta.push_back(rays[i].beta);
  }
  const bool rising = beta.front() < beta.back();
  if (rising) {
    std::reverse(alpha.begin(), alpha.end());
    std::reverse(beta.begin(), beta.end());
  }
  for (std::size_t i = 0; i < rim; ++i)  // counted with the end that is put before them below
    if (points[rising ? rim - 1 - i : i].corner) pupil.corners.push_back(i + 1);
  // β is even in the azimuth, whose first values are half a step and one and a half.
  const auto at_axis = [](double next, double after) { return (9 * next - after) / 8; };
  const double high = at_axis(beta[0], beta[1]), low = at_axis(beta[rim - 1], beta[rim - 2]);
  alpha.insert(alpha.begin(), 0.0);
  alpha.push_back(0.0);
  beta.insert(beta.begin(), high);
  beta.push_back(low);
  return std::adjacent_find(beta.begin(), beta.end(), [](double a, double b) { return !(a > b); }) ==
         beta.end();
}

bool take_surfaces(const std::vector<WaveRay>& rays, const PupilFitLimits& limits, SmoothPupil& pupil) {
  std::vector<double> alpha, beta, phase, amplitude;
  for (const WaveRay& ray : rays) {
    alpha.push_back(ray.alpha);
    beta.push_back(ray.beta);
    phase.push_back(ray.phase_waves);
    amplitude.push_back(ray.amplitude);
  }
  const double bright = *std::max_element(amplitude.begin(), amplitude.end());
  const std::array<std::span<const double>, 2> values{phase, amplitude};
  bool good = false;
  for (int degree = limits.lowest_degree; degree <= limits.highest_degree; degree += 4) {
    std::vector<ChebyshevSurface> surfaces = ChebyshevSurface::fit(alpha, beta, values, degree);
    if (surfaces.empty() || (good && surfaces[0].rms_residual() > pupil.phase_waves.rms_residual())) break;
    pupil.phase_waves = std::move(surfaces[0]);
    pupil.amplitude = std::move(surfaces[1]);
    const double phase_rms = pupil.phase_waves.rms_residual(),
                 amplitude_rms = pupil.amplitude.rms_residual() / bright;
    if (phase_rms <= limits.phase_rms_waves && amplitude_rms <= limits.amplitude_rms) return true;
    good = phase_rms <= limits.largest_phase_rms_waves && amplitude_rms <= limits.largest_amplitude_rms;
  }
  return good;
}

}  // namespace

std::optional<SmoothPupil> fit_pupil(const FieldTracer& tracer, const ChiefRay& chief,
                                     const PupilFitLimits& limits) {
  std::optional<FittedPupil> fitted = fit_pupil_and_boundary(tracer, chief, limits);
  if (!fitted) return {};
  return std::move(fitted->pupil);
}

std::optional<FittedPupil> fit_pupil_and_boundary(const FieldTracer& tracer, const ChiefRay& chief,
                                                  const PupilFitLimits& limits) {
  if (tracer.tracer().stop_blades().count > 0 || !tracer.tracer().is_centred()) return {};  // no mirror image
  std::optional<PupilBoundary> boundary = tracer.object_pupil(chief, limits.outline_azimuths);
  if (!boundary) return {};
  const std::vector<RimPoint> rim = RimWalk(tracer, chief, *boundary, limits.corner_tolerance).points();
  const std::vector<WaveRay> rays =
      trace_wave_rays(tracer, chief, *boundary, fit_nodes(*boundary, rim, limits.radial_nodes));
  SmoothPupil pupil;
  pupil.wavelength_nm = tracer.tracer().wavelength_nm();
  pupil.image_index = tracer.tracer().image_index();
  for (const WaveRay& ray : rays) {
    if (!ray.passes || !(ray.amplitude > 0)) return {};
    pupil.reach_s_mm = std::max(pupil.reach_s_mm, std::abs(ray.s_mm));
    pupil.low_t_mm = std::min(pupil.low_t_mm, ray.t_mm);
    pupil.high_t_mm = std::max(pupil.high_t_mm, ray.t_mm);
  }
  if (!take_outline(rays, rim, pupil)) return {};
  if (!take_surfaces(rays, limits, pupil)) return {};
  pupil.flux = pupil.amplitude_square_integral();
  // What the boundary says of the same area knows nothing of outline, corners and amplitude.
  const double area = tracer.lit_area(Pencil::from_object(tracer.lens(), chief.object_field), *boundary);
  if (!(std::abs(pupil.flux / area - 1) < flux_tolerance)) return {};
  return FittedPupil{std::move(pupil), *std::move(boundary)};
}

}  // namespace petzval
