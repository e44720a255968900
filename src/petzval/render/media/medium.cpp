// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/numeric/sobol.h>
#include <petzval/render/media/medium.h>

namespace petzval::render {

namespace {

/// exp(−coefficient · distance), also over an infinite distance.
Lanes transmittance(const Lanes& coefficient, double distance) {
  return mapped(coefficient,
                [&](float each) { return each > 0 ? std::exp(-static_cast<double>(each) * distance) : 1.0; });
}

}  // namespace

double Lots::next() {
  if (count_++ == 0) return first_;
  return hashed(static_cast<std::uint32_t>(first_ * 0x1p32), count_) * 0x1p-32;
}

Flight Medium::fly(Vector3 origin, Vector3 way, double distance, int group, int hero, Lots& lots) const {
  const Lanes all = extinction(group);
  const auto leading = static_cast<double>(all[hero]);
  if (!scatters || !(leading > 0)) return {pass(origin, way, distance, group, hero, lots), {}};
  const double free = -std::log1p(-lots.next()) / leading;
  Flight flight;
  flight.passage.flown = transmittance(all, std::min(free, distance));
  flight.passage.light = flight.passage.flown;
  if (!(free < distance)) return flight;
  flight.scattered_at = free;
  flight.passage.light *= scattering[static_cast<std::size_t>(group)];
  flight.passage.flown *= all;
  return flight;
}

Passage Medium::pass(Vector3, Vector3, double distance, int group, int, Lots&) const {
  Passage passage;
  passage.light = transmittance(extinction(group), distance);
  if (scatters) passage.flown = passage.light;
  return passage;
}

}  // namespace petzval::render
