// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/flare/veiling_glare.h>
#include <petzval/lens/pose.h>
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

/// Rings about a direction.
struct Rings {
  Vector middle, over, beside;  ///< `over` lies in the plane of the middle and the axis

  explicit Rings(const Vector& about) : middle(about) {
    const double sine = std::hypot(about[0], about[1]);
    // In the plane of y and z the way up; else away from the axis.
    const bool upright = about[0] == 0;
    const double x = upright ? 0 : about[0] / sine, y = upright ? 1 : about[1] / sine;
    over = {x * about[2], y * about[2], upright ? -about[1] : -sine};
    beside = {y, -x, 0};
  }
  Vector at(double polar, double azimuth) const {
    Vector result;
    for (std::size_t k = 0; k < 3; ++k)
      result[k] = std::cos(polar) * middle[k] + std::sin(polar) * std::cos(azimuth) * over[k] +
                  std::sin(polar) * std::sin(azimuth) * beside[k];
    return result;
  }
  /// How far a spoke reaches until it is this far from the axis.
  double reach(double azimuth, double surround_rad) const {
    const double a = middle[2], b = std::cos(azimuth) * over[2];
    return std::atan2(b, a) + std::acos(std::clamp(std::cos(surround_rad) / std::hypot(a, b), -1.0, 1.0));
  }
};

/// A direction of the surround and the solid angle that it stands for.
struct SurroundPoint {
  Vector towards;
  double solid_angle_sr;
};

/// From one polar angle to another, the farthest where nothing is said, in even steps of its logarithm.
/// \param turn  of the spokes: π where each stands for its mirror image, too, else 2π.
void add_rings(const Rings& rings, double from, std::optional<double> to, const GlareOptions& options,
               int spokes, double turn, std::vector<SurroundPoint>& points) {
  for (int k = 0; k < spokes; ++k) {
    const double azimuth = turn * (k + 0.5) / spokes;
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
                      std::optional<double> distance_mm, const std::array<double, 2>& at, int across) {
  std::vector<double> parts(points.size());
  const std::array<std::array<double, 2>, 1> place{at};
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
  if (rings < 2 || rings > 500 || spokes < 2 || spokes > 500 || ghost_rings < 2 || ghost_rings > 5000 ||
      ghost_azimuths < 2 || ghost_azimuths > 500)
    throw InputError("a surround is 2 to 500 rings and spokes");
}

VeilingGlare veiling_glare(const Lens& lens, const ScatterTracer& tracer, const std::array<double, 2>& at,
                           double g_sensor_sr, const GlareOptions& options) {
  options.validate();
  const BrightSource middle = source_imaged_at(lens, tracer, at[0], at[1]);
  // Its width is measured away from the axis.
  const double from_axis = std::hypot(at[0], at[1]);
  const std::array<double, 2> away = from_axis == 0
                                         ? std::array<double, 2>{0, 1}
                                         : std::array<double, 2>{at[0] / from_axis, at[1] / from_axis};
  const auto edge = [&](double beyond_mm) {
    return unit_towards(
        source_imaged_at(lens, tracer, at[0] + away[0] * beyond_mm, at[1] + away[1] * beyond_mm));
  };
  const double hole_rad = angle_between(edge(-options.hole_mm / 2), edge(options.hole_mm / 2)) / 2;
  SourceImage image;
  tracer.light(SourceBeam(middle), options.across, &image);
  if (!(image.clear_flux_mm2 > 0 && hole_rad > 0))
    throw InputError(
        fmt::format("no light is imaged {:g} mm from the axis; a hole where the lens sees it would be right",
                    std::hypot(at[0], at[1])));
  const Rings rings(unit_towards(middle));
  // On the axis one spoke is like the other.
  const bool centred = tracer.tracer().is_centred();
  const int spokes = !centred ? 2 * options.spokes : at[0] == 0 && at[1] == 0 ? 1 : options.spokes;
  const double turn = centred ? pi : 2 * pi;
  std::vector<SurroundPoint> surround, hole;
  add_rings(rings, hole_rad, {}, options, spokes, turn, surround);
  constexpr double innermost = 1e-3;  // of the hole, within which there is a millionth of its light
  add_rings(rings, innermost * hole_rad, hole_rad, options, spokes, turn, hole);
  VeilingGlare glare;
  glare.scattered_share = image.scattered_share();
  glare.scatter_sr = scattered_from(tracer, surround, lens.object_distance_mm, at, options.across);
  glare.white_sr = g_sensor_sr * (1 - glare.scattered_share) + glare.scatter_sr +
                   scattered_from(tracer, hole, lens.object_distance_mm, at, options.across);
  return glare;
}

namespace {

/// Rings of the surround about the axis, each with so many sources, turned from ring to ring.
std::vector<BrightSource> ring_sources(const Lens& lens, const GlareOptions& options, int azimuths) {
  constexpr double golden_turn = 0.6180339887498949;
  const QuadratureRule rule = gauss_legendre(options.ghost_rings, 0, radians(options.surround_deg));
  std::vector<BrightSource> sources;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i)
    for (int k = 0; k < azimuths; ++k) {
      BrightSource source;
      source.distance_mm = lens.object_distance_mm;
      const double slope = std::tan(rule.nodes[i]);
      const double angle =
          azimuths == 1 ? 0
                        : 2 * pi * (k / static_cast<double>(azimuths) + golden_turn * static_cast<double>(i));
      source.right = azimuths == 1 ? 0 : slope * std::sin(angle);
      source.up = azimuths == 1 ? slope : slope * std::cos(angle);
      source.irradiance = {2 * pi * std::sin(rule.nodes[i]) * rule.weights[i] / azimuths};
      sources.push_back(std::move(source));
    }
  return sources;
}

}  // namespace

std::vector<double> ghost_veil(const Lens& lens, double wavelength_nm,
                               std::span<const std::array<double, 2>> places_mm, const GlareOptions& options,
                               const GhostLightOptions& how) {
  options.validate();
  double farthest = 0;
  for (const auto& [x, y] : places_mm) farthest = std::max(farthest, std::hypot(x, y));
  const int half = static_cast<int>(std::ceil(farthest / options.hole_mm)) + 1, side = 2 * half + 1;
  const SensorGeometry frame{side, side, options.hole_mm * um_per_mm};
  const bool centred = is_round(lens);
  const SpectralImage light = ghost_light(
      lens, frame, {wavelength_nm}, ring_sources(lens, options, centred ? 1 : options.ghost_azimuths), how);
  // Columns of the upright picture run against x, rows with y.
  const auto at = [&](double x, double y) {
    const auto cell = [&](double across) {
      return std::clamp(static_cast<int>(std::floor(half + 0.5 + across)), 0, side - 1);
    };
    return static_cast<double>(light.at(0, cell(y), cell(-x)));
  };
  std::vector<double> veil;
  for (const auto& [x, y] : places_mm) {
    if (!centred) {
      veil.push_back(at(x / options.hole_mm, y / options.hole_mm));
      continue;
    }
    // A ring of sources lights a place as its one source lights the ring of places.
    const double radius = std::hypot(x, y) / options.hole_mm;
    const int azimuths = radius == 0 ? 1 : 8 * static_cast<int>(std::ceil(radius)) + 16;
    double sum = 0;
    for (int k = 0; k < azimuths; ++k) {
      const double angle = 2 * pi * (k + 0.5) / azimuths;
      sum += at(-radius * std::cos(angle), radius * std::sin(angle));
    }
    veil.push_back(sum / azimuths);
  }
  return veil;
}

}  // namespace petzval
