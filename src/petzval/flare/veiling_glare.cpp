// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/flare/veiling_glare.h>
#include <petzval/numeric/quadrature.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

using Vector = std::array<double, 3>;

Vector unit_towards(const BrightSource& source) {
  const double length = std::sqrt(source.right * source.right + source.up * source.up + 1);
  return {source.right / length, source.up / length, 1 / length};
}

double angle_between(const Vector& a, const Vector& b) {
  const Vector cross{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  return std::atan2(std::hypot(cross[0], cross[1], cross[2]), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/// Rings about a direction in the plane of y and z.
struct Rings {
  Vector middle, over;  ///< `over` is perpendicular, in the same plane

  Vector at(double polar, double azimuth) const {
    Vector result;
    for (std::size_t k = 0; k < 3; ++k)
      result[k] = std::cos(polar) * middle[k] + std::sin(polar) * std::cos(azimuth) * over[k];
    result[0] += std::sin(polar) * std::sin(azimuth);
    return result;
  }
  /// How far a spoke reaches until it is this far from the axis.
  double reach(double azimuth, double surround_rad) const {
    const double a = middle[2], b = std::cos(azimuth) * over[2];
    return std::atan2(b, a) + std::acos(std::clamp(std::cos(surround_rad) / std::hypot(a, b), -1.0, 1.0));
  }
};

/// A direction of the surround and the solid angle that it stands for, with its mirror image.
struct SurroundPoint {
  Vector towards;
  double solid_angle_sr;
};

/// From one polar angle to another, the farthest where nothing is said, in even steps of its logarithm.
void add_rings(const Rings& rings, double from, std::optional<double> to, const GlareOptions& options,
               int spokes, std::vector<SurroundPoint>& points) {
  for (int k = 0; k < spokes; ++k) {
    const double azimuth = pi * (k + 0.5) / spokes;
    const double end = to.value_or(rings.reach(azimuth, radians(options.surround_deg)));
    if (!(end > from)) continue;
    const QuadratureRule rule = gauss_legendre(options.rings, std::log(from), std::log(end));
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double polar = std::exp(rule.nodes[i]);
      points.push_back(
          {rings.at(polar, azimuth), rule.weights[i] * polar * std::sin(polar) * 2 * pi / spokes});
    }
  }
}

double scattered_from(const ScatterTracer& tracer, const std::vector<SurroundPoint>& points,
                      std::optional<double> distance_mm, double height_mm, int across) {
  std::vector<double> parts(points.size());
  const std::array<std::array<double, 2>, 1> place{{{0, height_mm}}};
  parallel_tasks(points.size(), [&](std::size_t i) {
    BrightSource source;
    source.distance_mm = distance_mm;
    source.right = points[i].towards[0] / points[i].towards[2];
    source.up = points[i].towards[1] / points[i].towards[2];
    parts[i] = points[i].solid_angle_sr * scatter_spread(tracer, source, place, {.across = across}).at(0);
  });
  return std::accumulate(parts.begin(), parts.end(), 0.0);
}

}  // namespace

void GlareOptions::validate() const {
  if (!(hole_mm > 0 && std::isfinite(hole_mm)))
    throw InputError(fmt::format("a hole whose image is {:g} mm wide; more than 0 would be right", hole_mm));
  if (!(surround_deg > 0 && surround_deg < 80))
    throw InputError(fmt::format(
        "a surround up to {:g} degrees from the axis; more than 0 and less than 80 would be right",
        surround_deg));
  if (rings < 2 || rings > 500 || spokes < 2 || spokes > 500 || ghost_rings < 2 || ghost_rings > 5000)
    throw InputError("a surround is 2 to 500 rings and spokes");
}

VeilingGlare veiling_glare(const Lens& lens, const ScatterTracer& tracer, double height_mm,
                           double g_sensor_sr, const GlareOptions& options) {
  options.validate();
  const BrightSource middle = source_imaged_at(lens, tracer, 0, height_mm);
  const double half = options.hole_mm / 2;
  const double hole_rad = angle_between(unit_towards(source_imaged_at(lens, tracer, 0, height_mm - half)),
                                        unit_towards(source_imaged_at(lens, tracer, 0, height_mm + half))) /
                          2;
  SourceImage image;
  tracer.light(SourceBeam(middle), options.across, &image);
  if (!(image.clear_flux_mm2 > 0 && hole_rad > 0))
    throw InputError(fmt::format(
        "no light is imaged {:g} mm from the axis; a hole where the lens sees it would be right", height_mm));
  Rings rings{unit_towards(middle), {}};
  rings.over = {0, rings.middle[2], -rings.middle[1]};
  // On the axis one spoke is like the other.
  const int spokes = height_mm == 0 ? 1 : options.spokes;
  std::vector<SurroundPoint> surround, hole;
  add_rings(rings, hole_rad, {}, options, spokes, surround);
  constexpr double innermost = 1e-3;  // of the hole, within which there is a millionth of its light
  add_rings(rings, innermost * hole_rad, hole_rad, options, spokes, hole);
  VeilingGlare glare;
  glare.scattered_share = image.scattered_share();
  glare.scatter_sr = scattered_from(tracer, surround, lens.object_distance_mm, height_mm, options.across);
  glare.white_sr = g_sensor_sr * (1 - glare.scattered_share) + glare.scatter_sr +
                   scattered_from(tracer, hole, lens.object_distance_mm, height_mm, options.across);
  return glare;
}

std::vector<double> ghost_veil(const Lens& lens, double wavelength_nm, std::span<const double> heights_mm,
                               const GlareOptions& options, const GhostLightOptions& how) {
  options.validate();
  const double farthest =
      std::abs(*std::ranges::max_element(heights_mm, {}, [](double height) { return std::abs(height); }));
  const int half = static_cast<int>(std::ceil(farthest / options.hole_mm)) + 1, side = 2 * half + 1;
  const SensorGeometry frame{side, side, options.hole_mm * um_per_mm};
  const QuadratureRule rule = gauss_legendre(options.ghost_rings, 0, radians(options.surround_deg));
  std::vector<BrightSource> sources;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    BrightSource source;
    source.distance_mm = lens.object_distance_mm;
    source.up = std::tan(rule.nodes[i]);
    source.irradiance = {2 * pi * std::sin(rule.nodes[i]) * rule.weights[i]};
    sources.push_back(std::move(source));
  }
  const SpectralImage light = ghost_light(lens, frame, {wavelength_nm}, sources, how);
  // A ring of sources lights a place as its one source lights the ring of places.
  std::vector<double> veil;
  for (const double height : heights_mm) {
    const double radius = std::abs(height) / options.hole_mm;
    const int azimuths = radius == 0 ? 1 : 8 * static_cast<int>(std::ceil(radius)) + 16;
    double sum = 0;
    for (int k = 0; k < azimuths; ++k) {
      const double angle = 2 * pi * (k + 0.5) / azimuths;
      const int column = static_cast<int>(std::floor(half + 0.5 + radius * std::cos(angle))),
                row = static_cast<int>(std::floor(half + 0.5 + radius * std::sin(angle)));
      sum += static_cast<double>(light.at(0, std::clamp(row, 0, side - 1), std::clamp(column, 0, side - 1)));
    }
    veil.push_back(sum / azimuths);
  }
  return veil;
}

}  // namespace petzval
