// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/media/medium.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

/// No float has places beyond.
constexpr double farthest = 1e18;
/// What is left of light is nothing below.
constexpr double least_left = 1e-9;

/// exp(−coefficient · distance), also over an infinite distance.
Lanes transmittance(const Lanes& coefficient, double distance) {
  return mapped(coefficient,
                [&](float each) { return each > 0 ? std::exp(-static_cast<double>(each) * distance) : 1.0; });
}

}  // namespace

/// The coefficients of all wavelengths are in the same proportion everywhere, so that collisions tell them
/// apart by their number and the depth of the bound alone. Everything over what the hero has.
Passage Medium::passage_of(const DensityGrid::Walk& walk, int group, int hero) const {
  const Lanes all = extinction(group);
  const auto leading = static_cast<double>(all[hero]);
  Passage passage;
  for (int lane = 0; lane < lane_count; ++lane) {
    const auto each = static_cast<double>(all[lane]);
    const double collided = walk.collisions > 0 ? walk.collisions * std::log(each / leading) : 0;
    passage.asked[lane] = static_cast<float>(std::exp(collided + (leading - each) * walk.bound_depth));
  }
  passage.light = walk.survived * passage.asked;
  passage.flown = scatters ? passage.light : passage.asked;
  return passage;
}

Flight Medium::fly(Vector3 origin, Vector3 way, double distance, int group, int hero, Lots& lots) const {
  if (colours) return fly_through_colours(origin, way, distance, group, hero, scatters, lots);
  const Lanes all = extinction(group);
  const auto leading = static_cast<double>(all[hero]);
  const Lanes& back = scattering[static_cast<std::size_t>(group)];
  if (density) {
    const DensityGrid::Walk walk = density->walk(origin, way, distance, leading, scatters, lots);
    Flight flight{passage_of(walk, group, hero), walk.stopped_at};
    if (walk.stopped_at)
      for (int lane = 0; lane < lane_count; ++lane)
        flight.passage.light[lane] *= all[lane] > 0 ? back[lane] / all[lane] : 0;
    return flight;
  }
  if (!scatters || !(leading > 0)) return {pass(origin, way, distance, group, hero, lots), {}};
  const double free = -std::log1p(-lots.next()) / leading;
  if (free < std::min(distance, farthest)) return scattered_at(free, group);
  Flight flight;
  flight.passage.flown = flight.passage.light = transmittance(all, distance);
  return flight;
}

Flight Medium::scattered_at(double distance, int group) const {
  const Lanes all = extinction(group), left = transmittance(all, distance);
  Flight flight{{}, distance};
  flight.passage.light = scattering[static_cast<std::size_t>(group)] * left;
  flight.passage.flown = all * left;
  return flight;
}

Passage Medium::pass(Vector3 origin, Vector3 way, double distance, int group, int hero, Lots& lots) const {
  if (colours) return fly_through_colours(origin, way, distance, group, hero, false, lots).passage;
  if (density) {
    const auto leading = static_cast<double>(extinction(group)[hero]);
    return passage_of(density->walk(origin, way, distance, leading, false, lots), group, hero);
  }
  Passage passage;
  passage.light = transmittance(extinction(group), distance);
  if (scatters) passage.flown = passage.light;
  return passage;
}

/// At collisions that all wavelengths share, so that only what each makes of them tells them apart.
Flight Medium::fly_through_colours(Vector3 origin, Vector3 way, double distance, int group, int hero,
                                   bool stops, Lots& lots) const {
  Flight flight;
  Passage& passage = flight.passage;
  density->each_collision(origin, way, distance, 1, lots, [&](const DensityGrid::Collision& met) {
    const Lanes back = 1 / met.bound * colours->scattered(met.place, group);
    const Lanes all = back + 1 / met.bound * colours->absorbed(met.place, group);
    if (stops && lots.next() < static_cast<double>(all[hero])) {
      passage.light *= back, passage.flown *= all;
      flight.scattered_at = met.distance;
      return false;
    }
    const Lanes kept = mapped(all, [](float share) { return std::max(0.0f, 1 - share); });
    passage.light *= kept;
    if (scatters) passage.flown *= kept;
    if (static_cast<double>(passage.light.largest()) > least_left) return true;
    passage.light = Lanes::all(0);
    return false;
  });
  return flight;
}

Lanes Medium::glow(Vector3 origin, Vector3 way, double distance, int group, Lots& lots) const {
  if (density) return glow_of_grid(origin, way, distance, group, lots);
  const Lanes all = extinction(group);
  Lanes light = emission->radiance[static_cast<std::size_t>(group)];
  for (int lane = 0; lane < lane_count; ++lane) {
    const auto coefficient = static_cast<double>(all[lane]);
    const auto absorbed = static_cast<double>(absorption[static_cast<std::size_t>(group)][lane]);
    light[lane] *=
        absorbed > 0 ? static_cast<float>(-std::expm1(-coefficient * distance) * absorbed / coefficient) : 0;
  }
  return light;
}

/// At collisions that all wavelengths share, each with its own way to survive them (Novák, Selle & Jarosz
/// 2014), so many that thin media are as quiet as others.
Lanes Medium::glow_of_grid(Vector3 origin, Vector3 way, double distance, int group, Lots& lots) const {
  constexpr double least_across = 8;
  const double per_density = std::max(static_cast<double>(extinction(group).largest()),
                                      least_across / (density->greatest() * density->diagonal()));
  Lanes light = Lanes::all(0), left = Lanes::all(1);
  if (!std::isfinite(per_density)) return light;
  density->each_collision(origin, way, distance, per_density, lots, [&](const DensityGrid::Collision& met) {
    const double over = 1 / (per_density * met.bound);
    const double times = colours ? over : over * std::min(met.bound, density->at_unit(met.place));
    const auto at = static_cast<std::size_t>(group);
    const Lanes absorbed = times * (colours ? colours->absorbed(met.place, group) : absorption[at]);
    const Lanes scattered = times * (colours ? colours->scattered(met.place, group) : scattering[at]);
    light += left * absorbed * emission->at(met.place, group);
    left *= mapped(absorbed + scattered, [](float share) { return std::max(0.0f, 1 - share); });
    return static_cast<double>(left.largest()) > least_left;
  });
  return light;
}

}  // namespace petzval::render
