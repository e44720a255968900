// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/flare/scatter_spread.h>
#include <petzval/lens/first_order.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

double scattered_to(const ScatterTracer& tracer, std::size_t surface, const std::vector<LitPlace>& lit,
                    const std::array<double, 2>& place) {
  double sum = 0;
  std::optional<std::array<double, 2>> guess;
  for (const LitPlace& from : lit) {
    const std::optional<ScatterLink> link = tracer.link(surface, from, place[0], place[1], guess);
    guess.reset();
    if (!link) continue;
    guess = link->direction;
    sum += link->per_mm2 * tracer.bsdf(surface).at(from.shares, link->tau);
  }
  return sum;
}

}  // namespace

void ScatterSpreadOptions::validate() const {
  constexpr int fewest = 4, most = 512;
  if (across < fewest || across > most)
    throw InputError(
        fmt::format("{} rays across what is lit; {} to {} would be right", across, fewest, most));
}

namespace {

/// How near to its place an image must lie, as a share of its distance from the axis.
constexpr double close_image = 1e-5;

/// Of a lens without symmetry, by Broyden's method: its derivatives are those of the designed lens first.
BrightSource source_imaged_anywhere(const Lens& lens, const ScatterTracer& tracer, double x_mm, double y_mm,
                                    double magnified_mm) {
  constexpr int steps = 15, few_rays = 10;
  constexpr double inwards = 0.7;
  const double tolerance_mm = close_image * std::max(std::hypot(x_mm, y_mm), 1e-2 * magnified_mm);
  BrightSource source;
  source.distance_mm = lens.object_distance_mm;
  // d(right, up)/d(x, y)
  std::array<double, 4> by{-1 / magnified_mm, 0, 0, -1 / magnified_mm};
  std::array<double, 2> moved{}, miss_before{};
  bool seen_before = false;
  for (int step = 0; step < steps; ++step) {
    SourceImage image;
    tracer.light(SourceBeam(source), few_rays, &image);
    if (!(image.clear_flux_mm2 > 0)) {
      source.right *= inwards, source.up *= inwards;
      seen_before = false;
      continue;
    }
    const std::array<double, 2> miss{x_mm - image.x_mm, y_mm - image.y_mm};
    if (std::hypot(miss[0], miss[1]) < tolerance_mm) break;
    if (seen_before) {
      // How far the image has come, and how far the derivatives say that the source had to go for it.
      const std::array<double, 2> came{miss_before[0] - miss[0], miss_before[1] - miss[1]};
      const std::array<double, 2> said{by[0] * came[0] + by[1] * came[1], by[2] * came[0] + by[3] * came[1]};
      const double along = moved[0] * said[0] + moved[1] * said[1];
      if (along != 0) {
        const std::array<double, 2> left{moved[0] * by[0] + moved[1] * by[2],
                                         moved[0] * by[1] + moved[1] * by[3]};
        for (std::size_t i = 0; i < 2; ++i)
          for (std::size_t k = 0; k < 2; ++k) by[2 * i + k] += (moved[i] - said[i]) * left[k] / along;
      }
    }
    moved = {by[0] * miss[0] + by[1] * miss[1], by[2] * miss[0] + by[3] * miss[1]};
    source.right += moved[0], source.up += moved[1];
    miss_before = miss;
    seen_before = true;
  }
  return source;
}

}  // namespace

BrightSource source_imaged_at(const Lens& lens, const ScatterTracer& tracer, double x_mm, double y_mm) {
  BrightSource source;
  source.distance_mm = lens.object_distance_mm;
  const double radius = std::hypot(x_mm, y_mm);
  const bool centred = tracer.tracer().is_centred();
  if (centred && radius == 0) return source;
  const FirstOrder first = first_order(lens);
  const double magnified = lens.object_distance_mm ? std::abs(first.magnification) * *lens.object_distance_mm
                                                   : std::abs(first.efl_mm);
  if (!centred) return source_imaged_anywhere(lens, tracer, x_mm, y_mm, magnified);
  double slope = radius / magnified, widest = std::tan(radians(80));
  constexpr int steps = 12, few_rays = 10;
  constexpr double inwards = 0.9;
  for (int step = 0; step < steps; ++step) {
    slope = std::min(slope, widest);
    source.right = -x_mm / radius * slope, source.up = -y_mm / radius * slope;
    SourceImage image;
    tracer.light(SourceBeam(source), few_rays, &image);
    if (!(image.clear_flux_mm2 > 0)) {
      widest = slope *= inwards;
      continue;
    }
    const double reached = std::hypot(image.x_mm, image.y_mm);
    if (!(reached > 0) || std::abs(reached / radius - 1) < close_image) break;
    slope *= radius / reached;
  }
  return source;
}

double ScatterSpread::at(std::size_t place) const {
  return std::accumulate(by_surface.at(place).begin(), by_surface.at(place).end(), 0.0);
}

ScatterSpread scatter_spread(const ScatterTracer& tracer, const BrightSource& source,
                             std::span<const std::array<double, 2>> places,
                             const ScatterSpreadOptions& options) {
  options.validate();
  source.validate(source.irradiance.size());
  ScatterSpread spread;
  const std::vector<std::vector<LitPlace>> lit =
      tracer.light(SourceBeam(source), options.across, &spread.image);
  const std::size_t surfaces = tracer.surface_count();
  spread.by_surface.assign(places.size(), std::vector<double>(surfaces));
  parallel_for(places.size() * surfaces, [&](std::size_t i) {
    const std::size_t place = i / surfaces, surface = i % surfaces;
    spread.by_surface[place][surface] = scattered_to(tracer, surface, lit[surface], places[place]);
  });
  return spread;
}

}  // namespace petzval
