// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/render/camera/pupil_regions.h>
#include <petzval/trace/pupil.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

constexpr int intervals = 64;
constexpr int azimuths = 64;
/// Points on each edge of an outline, so that no sector misses it.
constexpr int points_an_edge = 8;
/// Grown by this, for what lies between radii and between azimuths.
constexpr double margin = 1.01;
/// Directions a side of the search for light where there is no chief ray to start from.
constexpr int search_side = 48;

using Outline = std::vector<std::pair<double, double>>;

/// All directions of a grid that pass, each with the corners of its cell: crude, and sure enough.
Outline search(const Tracer& tracer, const Pencil& pencil) {
  Outline found;
  for (int i = 0; i < search_side; ++i)
    for (int j = 0; j < search_side; ++j) {
      const double cell = 2.0 / search_side, u = -1 + (i + 0.5) * cell, v = -1 + (j + 0.5) * cell;
      if (u * u + v * v >= 1 || !(pencil.clearance(tracer, u, v, Tracer::Clip::apertures).worst <= 0)) continue;
      for (const double a : {-cell, cell})
        for (const double b : {-cell, cell}) found.emplace_back(u + a, v + b);
    }
  return found;
}

Outline outline(const PupilBoundary& pupil) {
  Outline points;
  for (std::size_t i = 0; i < pupil.radius.size(); ++i) {
    const double phi = pupil.azimuth(i);
    points.emplace_back(pupil.radius[i] * std::sin(phi), pupil.centre_v + pupil.radius[i] * std::cos(phi));
  }
  return points;
}

/// The pupil as seen from one film point at one wavelength; empty where no light arrives.
Outline outline_at(const Lens& lens, const Tracer& tracer, double radius_mm) {
  const Pencil pencil = Pencil::from_image(tracer, radius_mm);
  ChiefRayMarch march(lens, tracer, ChiefRayMarch::From::image);
  if (const std::optional<double> chief = march.v_at(radius_mm))
    if (const std::optional<PupilBoundary> pupil = find_pupil(tracer, pencil, *chief, azimuths)) return outline(*pupil);
  return search(tracer, pencil);
}

double positive_azimuth(double s, double t) {
  const double phi = std::atan2(s, t);
  return phi < 0 ? phi + 2 * pi : phi;
}

}  // namespace

PupilRegions::PupilRegions(const Lens& lens, const std::vector<const Tracer*>& tracers, double largest_radius_mm)
    : largest_radius_mm_(largest_radius_mm) {
  const std::size_t each = tracers.size();
  std::vector<Outline> outlines((intervals + 1) * each);
  parallel_for(outlines.size(), [&](std::size_t i) {
    const double radius = largest_radius_mm * static_cast<double>(i / each) / intervals;
    outlines[i] = outline_at(lens, *tracers[i % each], radius);
  });
  bool light = false;
  for (int k = 0; k < intervals; ++k) {
    const auto first = outlines.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * each);
    regions_.push_back(enclosing({first, first + static_cast<std::ptrdiff_t>(2 * each)}));
    light = light || regions_.back().area > 0;
  }
  if (!light)
    throw InputError(fmt::format("{}: no light reaches the film of {:.4g} mm half diagonal; another film distance or "
                                 "a wider stop would be right",
                                 lens.name, largest_radius_mm));
}

PupilRegions::Region PupilRegions::enclosing(const std::vector<Outline>& outlines) const {
  Region region;
  std::size_t points = 0;
  for (const Outline& outline : outlines)
    for (const auto& [s, t] : outline) region.middle_s += s, region.middle_t += t, ++points;
  if (points == 0) return region;
  region.middle_s = 0;  // mirror symmetric
  region.middle_t /= static_cast<double>(points);
  region.reach.assign(sectors, 0.0);
  for (const Outline& outline : outlines)
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const auto [s0, t0] = outline[i];
      const auto [s1, t1] = outline[(i + 1) % outline.size()];
      for (int k = 0; k < points_an_edge; ++k) {
        const double share = static_cast<double>(k) / points_an_edge;
        const double s = s0 + share * (s1 - s0) - region.middle_s, t = t0 + share * (t1 - t0) - region.middle_t;
        const auto sector = static_cast<std::size_t>(positive_azimuth(s, t) / (2 * pi) * sectors) % sectors;
        region.reach[sector] = std::max(region.reach[sector], margin * std::hypot(s, t));
      }
    }
  // An edge may cross a corner of the next sector between two points.
  const std::vector<double> alone = region.reach;
  for (std::size_t i = 0; i < sectors; ++i)
    if (alone[i] == 0) region.reach[i] = std::max(alone[(i + 1) % sectors], alone[(i + sectors - 1) % sectors]);
  region.cumulative.assign(1, 0.0);
  for (const double reach : region.reach) region.cumulative.push_back(region.cumulative.back() + reach * reach);
  const double sum = region.cumulative.back();
  region.area = sum * pi / sectors;
  for (double& value : region.cumulative) value /= sum;
  return region;
}

const PupilRegions::Region& PupilRegions::at(double radius_mm) const {
  const double place = radius_mm / largest_radius_mm_ * intervals;
  return regions_[static_cast<std::size_t>(std::clamp(static_cast<int>(place), 0, intervals - 1))];
}

PupilRegions::Direction PupilRegions::sample(double radius_mm, double u, double v) const {
  const Region& region = at(radius_mm);
  if (!(region.area > 0)) return {};
  const auto above = std::upper_bound(region.cumulative.begin() + 1, region.cumulative.end(), u);
  const std::size_t sector =
      std::min(static_cast<std::size_t>(above - region.cumulative.begin()) - 1, std::size_t{sectors} - 1);
  const double low = region.cumulative[sector], high = region.cumulative[sector + 1];
  const double share = high > low ? std::clamp((u - low) / (high - low), 0.0, 1.0) : 0.5;
  const double phi = 2 * pi * (static_cast<double>(sector) + share) / sectors;
  const double radius = region.reach[sector] * std::sqrt(v);
  return {region.middle_s + radius * std::sin(phi), region.middle_t + radius * std::cos(phi), region.area};
}

double PupilRegions::density(double radius_mm, double s, double t) const {
  const Region& region = at(radius_mm);
  if (!(region.area > 0)) return 0;
  const double ds = s - region.middle_s, dt = t - region.middle_t;
  const auto sector = static_cast<std::size_t>(positive_azimuth(ds, dt) / (2 * pi) * sectors) % sectors;
  return std::hypot(ds, dt) <= region.reach[sector] ? 1 / region.area : 0;
}

}  // namespace petzval::render
