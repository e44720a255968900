// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/trace/exit_pupil_region.h>
#include <petzval/trace/passing_region.h>

#include <algorithm>
#include <cmath>

namespace petzval {

/// What one film radius shows.
struct ExitPupilRegions::Probe {
  double film_radius_mm = 0;
  std::vector<PassingRegion> wavelengths;  ///< those that let any light through
  double bend_u = 0, bend_v = 0;           ///< by how much the box departs from moving evenly here
  double wander_u = 0, wander_v = 0;       ///< and by how much more between two azimuths of a lens with poses

  bool dark() const { return wavelengths.empty(); }
  LabelBox box() const {
    LabelBox all = wavelengths.front().box;
    for (const PassingRegion& each : wavelengths) all = all.hull(each.box);
    return all;
  }
};

/// A film point's zone and frame.
struct ExitPupilRegions::Place {
  const Zone* zone;
  double centre_v;
  double along_x, along_y;  ///< unit vector from the axis to the film point
};

namespace {

double sector_width(std::size_t sectors) {
  return 2 * pi / static_cast<double>(sectors);
}

struct SineCosine {
  double sin, cos;
};

/// Of the azimuth at a share of a sector: that of the sector's middle, turned. Series to the last digit for
/// angles up to half a sector.
template <std::size_t Sectors>
SineCosine direction_in_sector(std::size_t sector, double share) {
  static_assert(Sectors >= 64);
  static const auto middles = [] {
    std::array<SineCosine, Sectors> all;
    for (std::size_t i = 0; i < Sectors; ++i) {
      const double azimuth = (static_cast<double>(i) + 0.5) * sector_width(Sectors);
      all[i] = {std::sin(azimuth), std::cos(azimuth)};
    }
    return all;
  }();
  const double turn = (share - 0.5) * sector_width(Sectors), t2 = turn * turn;
  const double sin = turn * (1 - t2 / 6 * (1 - t2 / 20 * (1 - t2 / 42 * (1 - t2 / 72))));
  const double cos = 1 - t2 / 2 * (1 - t2 / 12 * (1 - t2 / 30 * (1 - t2 / 56)));
  const SineCosine middle = middles[sector];
  return {middle.sin * cos + middle.cos * sin, middle.cos * cos - middle.sin * sin};
}

/// Film azimuths at which a lens with poses is looked at.
constexpr int film_azimuths = 8;

/// The lens as film points see it that lie on +y after it was turned: once, or at every azimuth as it is and
/// mirrored, since a passing region shows one half.
std::vector<Tracer> views_of(std::span<const Tracer> tracers) {
  std::vector<Tracer> views;
  for (const Tracer& tracer : tracers) {
    if (tracer.is_centred()) {
      views.push_back(tracer);
      continue;
    }
    for (int i = 0; i < film_azimuths; ++i) {
      views.push_back(tracer.turned(2 * pi * i / film_azimuths));
      views.push_back(views.back().mirrored());
    }
  }
  return views;
}

double change(const LabelBox& a, const LabelBox& b) {
  return std::max(std::abs(a.low_v - b.low_v), std::abs(a.high_v - b.high_v));
}

}  // namespace

ExitPupilRegions::ExitPupilRegions(std::span<const Tracer> tracers, double film_radius_mm, std::size_t radii)
    : film_radius_mm_(film_radius_mm) {
  if (tracers.empty()) throw InputError("exit pupil regions need a wavelength, and there is none");
  if (!(film_radius_mm > 0) || !std::isfinite(film_radius_mm))
    throw InputError(fmt::format("a film radius of {:g} mm; it must be positive", film_radius_mm));
  if (radii < 2 || radii > 100'000)
    throw InputError(fmt::format("{} film radii; 2 to 100000 would be right", radii));
  const double step = film_radius_mm / static_cast<double>(radii - 1);
  std::vector<Probe> probes(radii);
  const std::vector<Tracer> views = views_of(tracers);
  const bool centred = views.size() == tracers.size();
  parallel_for(radii, [&](std::size_t i) {
    Probe& probe = probes[i];
    probe.film_radius_mm = step * static_cast<double>(i);
    std::vector<std::optional<LabelBox>> boxes;
    for (const Tracer& tracer : views) {
      auto passing = find_passing_region(tracer, Pencil::from_image(tracer, probe.film_radius_mm));
      boxes.push_back(passing ? std::optional(passing->box) : std::nullopt);
      if (passing) probe.wavelengths.push_back(std::move(*passing));
    }
    constexpr std::size_t halves = 2;  // the same half at the next azimuth
    for (std::size_t v = 0; !centred && v < boxes.size(); ++v) {
      const std::size_t first = v - v % (halves * film_azimuths);
      const auto& next = boxes[first + (v - first + halves) % (halves * film_azimuths)];
      if (!boxes[v] || !next) continue;
      probe.wander_u = std::max(probe.wander_u, std::abs(boxes[v]->high_u - next->high_u));
      probe.wander_v = std::max(probe.wander_v, change(*boxes[v], *next));
    }
  });
  find_bends(probes);
  for (std::size_t i = 0; i + 1 < radii; ++i) zones_.push_back(zone_between(probes[i], probes[i + 1], step));
  for (const Zone& zone : zones_) densities_.rows.push_back(density_row(zone));
  densities_.zone_mm = static_cast<float>(step);
}

PupilDensityTable::Row ExitPupilRegions::density_row(const Zone& zone) {
  PupilDensityTable::Row row;
  if (!(zone.area_sr > 0)) return row;
  row.centre_v = static_cast<float>(zone.centre_v);
  row.centre_v_per_mm = static_cast<float>(zone.centre_v_per_mm);
  row.per_scale_u = static_cast<float>(1 / zone.scale_u);
  row.per_scale_v = static_cast<float>(1 / zone.scale_v);
  row.density_per_sr = static_cast<float>(1 / zone.area_sr);
  for (std::size_t i = 0; i < sectors; ++i)
    row.radius_sq[i] = static_cast<float>(zone.radius[i] * zone.radius[i]);
  return row;
}

void ExitPupilRegions::find_bends(std::vector<Probe>& probes) {
  for (std::size_t i = 1; i + 1 < probes.size(); ++i) {
    if (probes[i - 1].dark() || probes[i].dark() || probes[i + 1].dark()) continue;
    const LabelBox before = probes[i - 1].box(), here = probes[i].box(), after = probes[i + 1].box();
    const auto bend = [](double a, double b, double c) { return std::abs(a - 2 * b + c); };
    probes[i].bend_u = bend(before.high_u, here.high_u, after.high_u);
    probes[i].bend_v =
        std::max(bend(before.low_v, here.low_v, after.low_v), bend(before.high_v, here.high_v, after.high_v));
  }
}

ExitPupilRegions::Zone ExitPupilRegions::zone_between(const Probe& inner, const Probe& outer,
                                                      double step_mm) {
  Zone zone;
  if (inner.dark() && outer.dark()) return zone;
  // Where light ends inside the zone, what the one end shows may lie anywhere from there to the other.
  const Probe& lit = inner.dark() ? outer : inner;
  const Probe& other = outer.dark() ? inner : outer;
  const LabelBox from = lit.box(), to = other.box();
  const bool ends = inner.dark() || outer.dark();
  const double centre_from = from.middle_v(), centre_to = to.middle_v();
  zone.centre_v = 0.5 * (centre_from + centre_to);
  zone.centre_v_per_mm = (centre_to - centre_from) / step_mm;
  zone.scale_u = std::max(from.high_u, to.high_u);
  zone.scale_v = 0.5 * std::max(from.high_v - from.low_v, to.high_v - to.low_v);

  // Where an aperture begins to clip inside the zone, an edge goes a quarter of its bend off the straight
  // way.
  const double margin_u =
      0.5 * (std::max(inner.bend_u, outer.bend_u) + std::max(inner.wander_u, outer.wander_u));
  const double margin_v =
      0.5 * (std::max(inner.bend_v, outer.bend_v) + std::max(inner.wander_v, outer.wander_v));
  const double width = sector_width(sectors);
  const auto cover = [&](double u, double v) {
    const double x = u / zone.scale_u, y = v / zone.scale_v;
    const double azimuth = std::atan2(x, y) + (x < 0 ? 2 * pi : 0);
    double& radius = zone.radius[std::min(static_cast<std::size_t>(azimuth / width), sectors - 1)];
    radius = std::max(radius, std::hypot(x, y));
  };
  for (const Probe* probe : {&lit, &other})
    for (const PassingRegion& passing : probe->wavelengths)
      for (const auto& [u, v] : passing.outline)
        for (const double du : {-passing.cell_u - margin_u, passing.cell_u + margin_u})
          for (const double dv : {-passing.cell_v - margin_v, passing.cell_v + margin_v}) {
            const double offset = v + dv - (probe == &lit ? centre_from : centre_to);
            cover(u + du, offset);
            cover(-u - du, offset);
          }
  if (ends) {
    // A wider berth: the pupil wanders, and closes, within the step.
    for (double& radius : zone.radius) radius = 1.5 * std::max(radius, 0.5);
  }
  double sum = 0;
  for (std::size_t i = 0; i < sectors; ++i) {
    zone.share[i] = sum;
    sum += 0.5 * zone.radius[i] * zone.radius[i] * width;
  }
  zone.share[sectors] = sum;
  for (double& share : zone.share) share /= sum;
  for (std::size_t i = 0, sector = 0; i < sectors; ++i) {
    while (sector + 1 < sectors && zone.share[sector + 1] <= static_cast<double>(i) / sectors) ++sector;
    zone.first[i] = static_cast<std::uint8_t>(sector);
  }
  zone.area_sr = sum * zone.scale_u * zone.scale_v;
  return zone;
}

const ExitPupilRegions::Zone& ExitPupilRegions::zone_at(double radius_mm) const {
  const double position = radius_mm / film_radius_mm_ * static_cast<double>(zones_.size());
  return zones_[std::min(static_cast<std::size_t>(position), zones_.size() - 1)];
}

ExitPupilRegions::Place ExitPupilRegions::place(double x_mm, double y_mm) const {
  const double radius = std::sqrt(x_mm * x_mm + y_mm * y_mm);
  const Zone& zone = zone_at(radius);
  const auto index = static_cast<double>(&zone - zones_.data());
  const double step = film_radius_mm_ / static_cast<double>(zones_.size());
  const double from_middle = std::clamp(radius - (index + 0.5) * step, -0.5 * step, 0.5 * step);
  return {&zone, zone.centre_v + zone.centre_v_per_mm * from_middle, radius > 0 ? x_mm / radius : 0,
          radius > 0 ? y_mm / radius : 1};
}

std::optional<ExitPupilRegions::Sample> ExitPupilRegions::sample(double x_mm, double y_mm, double random_1,
                                                                 double random_2) const {
  const Place at = place(x_mm, y_mm);
  const Zone& zone = *at.zone;
  if (!(zone.area_sr > 0)) return {};
  std::size_t sector = zone.first[std::min(static_cast<std::size_t>(random_1 * sectors), sectors - 1)];
  while (sector + 1 < sectors && zone.share[sector + 1] <= random_1) ++sector;
  const double within = (random_1 - zone.share[sector]) / (zone.share[sector + 1] - zone.share[sector]);
  const auto [sin, cos] = direction_in_sector<sectors>(sector, std::clamp(within, 0.0, 1.0));
  const double radius = zone.radius[sector] * std::sqrt(random_2);
  const double u = zone.scale_u * radius * sin;
  const double v = at.centre_v + zone.scale_v * radius * cos;
  return Sample{u * at.along_y + v * at.along_x, v * at.along_y - u * at.along_x, zone.area_sr};
}

double ExitPupilRegions::area_sr(double x_mm, double y_mm) const {
  return zone_at(std::hypot(x_mm, y_mm)).area_sr;
}

double ExitPupilRegions::density_per_sr(double x_mm, double y_mm, double alpha, double beta) const {
  const Place at = place(x_mm, y_mm);
  const Zone& zone = *at.zone;
  if (!(zone.area_sr > 0)) return 0;
  const double u = alpha * at.along_y - beta * at.along_x, v = alpha * at.along_x + beta * at.along_y;
  const double x = u / zone.scale_u, y = (v - at.centre_v) / zone.scale_v;
  const double azimuth = std::atan2(x, y) + (x < 0 ? 2 * pi : 0);
  const auto sector = std::min(static_cast<std::size_t>(azimuth / sector_width(sectors)), sectors - 1);
  return std::hypot(x, y) <= zone.radius[sector] ? 1 / zone.area_sr : 0;
}

double lit_radius_mm(const Tracer& tracer, double film_radius_mm) {
  constexpr int places = 100;
  const std::vector<Tracer> views = views_of({&tracer, 1});
  for (int i = places; i > 0; --i) {
    const double radius = film_radius_mm * i / places;
    for (const Tracer& view : views)
      if (find_passing_region(view, Pencil::from_image(view, radius))) return radius;
  }
  return 0;
}

}  // namespace petzval
