// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/render/camera/pupil_etendue.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

constexpr std::size_t etendue_radii = 65;
constexpr int etendue_azimuths = 24;  ///< of a lens that is not round, or has blades
constexpr std::size_t rays_a_node = 2048;
/// Between so many, light of further wavelengths is found by straight lines.
constexpr int most_etendue_wavelengths = 7;
/// Of a node's value; in the middle between nodes a straight line then errs by an eighth of it.
constexpr double most_bend = 0.02;

}  // namespace

PupilEtendue::PupilEtendue(const LensCamera& camera, const WavelengthGroups& groups, double radius_mm)
    : groups_(groups.count()),
      azimuths_(camera.is_round() ? 1 : etendue_azimuths),
      step_mm_(radius_mm / static_cast<double>(etendue_radii - 1)) {
  const int bands = static_cast<int>(groups.wavelengths_nm().size());
  const int planes = !camera.disperses() && !camera.loses() ? 1 : std::min(bands, most_etendue_wavelengths);
  const auto band_of = [&](int plane) { return planes == 1 ? 0 : plane * (bands - 1) / (planes - 1); };
  for (int band = 0, plane = 0; band < bands; ++band) {
    while (plane + 1 < planes - 1 && band_of(plane + 1) <= band) ++plane;
    const double from = band_of(plane), to = band_of(std::min(plane + 1, planes - 1));
    const std::vector<double>& nm = groups.wavelengths_nm();
    const auto nm_of = [&](double at) { return nm[static_cast<std::size_t>(at)]; };
    between_.push_back({static_cast<std::size_t>(plane),
                        to > from ? (nm_of(band) - nm_of(from)) / (nm_of(to) - nm_of(from)) : 0});
  }
  nodes_.resize(static_cast<std::size_t>(planes) * static_cast<std::size_t>(azimuths_) * etendue_radii);
  parallel_for(nodes_.size(), [&](std::size_t i) {
    const std::size_t radius = i % etendue_radii, spoke = i / etendue_radii;
    const double azimuth =
        2 * pi * static_cast<double>(spoke % static_cast<std::size_t>(azimuths_)) / azimuths_;
    const int band = band_of(static_cast<int>(spoke / static_cast<std::size_t>(azimuths_)));
    const double r = step_mm_ * static_cast<double>(radius);
    nodes_[i].sr = camera.etendue_sr(band % groups_, band / groups_, r * std::sin(azimuth),
                                     r * std::cos(azimuth), rays_a_node);
  });
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const std::size_t radius = i % etendue_radii;
    const std::size_t inner = radius > 0 ? i - 1 : i + 1, outer = radius + 1 < etendue_radii ? i + 1 : i - 1;
    const double bend = std::abs(nodes_[inner].sr - 2 * nodes_[i].sr + nodes_[outer].sr);
    nodes_[i].bends = radius + 1 < etendue_radii && bend > most_bend * nodes_[i].sr;
  }
}

PupilEtendue::Place PupilEtendue::place(double x_mm, double y_mm) const {
  const double along = std::min(std::hypot(x_mm, y_mm) / step_mm_, etendue_radii - 1.000001);
  const auto radius = static_cast<std::size_t>(along);
  double azimuth = azimuths_ == 1 ? 0 : std::atan2(x_mm, y_mm) / (2 * pi) * azimuths_;
  if (azimuth < 0) azimuth += azimuths_;
  const auto spoke = static_cast<std::size_t>(azimuth), count = static_cast<std::size_t>(azimuths_);
  return {{spoke % count * etendue_radii + radius, (spoke + 1) % count * etendue_radii + radius},
          along - static_cast<double>(radius),
          azimuth - static_cast<double>(spoke)};
}

PupilEtendue::Value PupilEtendue::on_plane(std::size_t plane, const Place& place) const {
  const auto spoke = [&](std::size_t first) {
    const Node* at = nodes_.data() + plane * static_cast<std::size_t>(azimuths_) * etendue_radii + first;
    return Value{at[0].sr + place.outwards * (at[1].sr - at[0].sr), !at[0].bends && !at[1].bends};
  };
  const Value here = spoke(place.spokes[0]);
  if (azimuths_ == 1) return here;
  const Value next = spoke(place.spokes[1]);
  return {here.sr + place.turn * (next.sr - here.sr),
          here.exact && next.exact && std::abs(next.sr - here.sr) <= most_bend * here.sr};
}

PupilEtendue::Value PupilEtendue::at(int group, int lane, const Place& place) const {
  const Between& band = between_[static_cast<std::size_t>(group + lane * groups_)];
  const Value first = on_plane(band.plane, place);
  if (band.share == 0) return first;
  const Value second = on_plane(band.plane + 1, place);
  return {first.sr + band.share * (second.sr - first.sr), first.exact && second.exact};
}

}  // namespace petzval::render
