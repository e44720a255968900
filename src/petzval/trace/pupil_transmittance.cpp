// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/trace/pupil_transmittance.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

constexpr int degree = 8;
/// Rays from each film radius, around the pupil and outwards; more where the region holds the pupils of all
/// azimuths, and that of one alone is wanted.
constexpr int around = 20, outwards = 8, posed_around = 28, posed_outwards = 10;
/// A little beyond the pupil, so that no fit runs away where the pupil of the next radius ends.
constexpr double wider = 1.08;
constexpr double wider_clearance = 0.2;  // (r/r_clear)² − 1: a tenth in radius

/// The lens at each of the wavelengths.
struct Light {
  std::span<const Tracer> tracers;
  std::vector<LensTransmittance> transmittances;

  const Tracer& tracer(std::size_t wavelength) const { return tracers[tracers.size() == 1 ? 0 : wavelength]; }
  std::size_t wavelengths() const { return transmittances.size(); }
};

/// A direction on the film.
struct Azimuth {
  double x = 0, y = 1;
};

/// What rays from one film point lose: at directions (u, v) across and along its azimuth, by wavelength.
struct Seen {
  std::vector<double> u, v;
  std::vector<std::vector<double>> transmittance;  ///< [wavelength]
};

/// Adds a direction, unless it is lost at any wavelength.
void add(const Light& light, const Azimuth& at, double radius_mm, double u, double v, Seen& seen) {
  if (!(u * u + v * v < 1)) return;
  std::vector<double> values;
  std::vector<Intersection> path;
  for (std::size_t i = 0; i < light.wavelengths(); ++i) {
    const Tracer& tracer = light.tracer(i);
    const Ray start{{radius_mm * at.x, radius_mm * at.y, tracer.image_z_mm()},
                    {-u * at.y - v * at.x, u * at.x - v * at.y, -std::sqrt(1 - u * u - v * v)}};
    path.clear();
    if (tracer.trace_backward(start, Tracer::Clip::none, &path).status != RayStatus::ok) return;
    if (!tracer.is_centred() && tracer.clearance(start, true).worst > wider_clearance) return;
    values.push_back(light.transmittances[i].along(tracer.from_image(start), path, true));
  }
  seen.u.push_back(u), seen.v.push_back(v);
  for (std::size_t i = 0; i < values.size(); ++i) seen.transmittance[i].push_back(values[i]);
}

Seen seen_from(const Light& light, const ExitPupilRegions& regions, const Azimuth& at, double radius_mm) {
  Seen seen;
  seen.transmittance.resize(light.wavelengths());
  const auto centre = regions.sample(0, radius_mm, 0.5, 0);
  if (!centre) return seen;
  const bool centred = light.tracers.front().is_centred();
  const int turns = centred ? around : posed_around, steps = centred ? outwards : posed_outwards;
  for (int i = 0; i < turns; ++i)
    for (int j = 0; j < steps; ++j) {
      const auto sample = regions.sample(0, radius_mm, (i + 0.5) / turns, (j + 0.5) / steps);
      add(light, at, radius_mm, centre->alpha + wider * (sample->alpha - centre->alpha),
          centre->beta + wider * (sample->beta - centre->beta), seen);
    }
  return seen;
}

/// Of as high a degree as there are rays for; nothing without any.
std::vector<ChebyshevSurface> fitted(const Seen& seen, ChebyshevSurface::Symmetry symmetry) {
  const std::vector<std::span<const double>> values(seen.transmittance.begin(), seen.transmittance.end());
  for (int each = seen.u.empty() ? -1 : degree; each >= 0; each -= 2) {
    if (seen.u.size() < 2 * ChebyshevSurface::unknowns(each, symmetry)) continue;
    std::vector<ChebyshevSurface> surfaces = ChebyshevSurface::fit(seen.u, seen.v, values, each, symmetry);
    if (!surfaces.empty()) return surfaces;
  }
  return {};
}

}  // namespace

PupilTransmittance::PupilTransmittance(const Lens& lens, std::span<const Tracer> tracers,
                                       std::span<const double> wavelengths_nm, const Losses& losses,
                                       const ExitPupilRegions& regions, std::size_t radii)
    : step_mm_(regions.film_radius_mm() / static_cast<double>(radii - 1)),
      meridians_(tracers.front().is_centred() ? 1 : posed_azimuths, Meridian(radii)) {
  Light light{tracers, {}};
  const auto symmetry =
      meridians_.size() == 1 ? ChebyshevSurface::Symmetry::even_in_x : ChebyshevSurface::Symmetry::none;
  for (const double nm : wavelengths_nm) light.transmittances.emplace_back(lens, nm, losses);
  parallel_for(radii * meridians_.size(), [&](std::size_t task) {
    const std::size_t m = task / radii, i = task % radii;
    const double angle = 2 * pi * static_cast<double>(m) / static_cast<double>(meridians_.size());
    const Azimuth azimuth{std::sin(angle), std::cos(angle)};
    meridians_[m][i] =
        fitted(seen_from(light, regions, azimuth, step_mm_ * static_cast<double>(i)), symmetry);
  });
  for (Meridian& fits : meridians_) {
    for (std::size_t i = 1; i < radii; ++i)
      if (fits[i].empty()) fits[i] = fits[i - 1];
    for (std::size_t i = radii - 1; i-- > 0;)
      if (fits[i].empty()) fits[i] = fits[i + 1];
  }
  // A meridian without any light: that of the one before, from wherever there is one.
  for (std::size_t m = 1; m < 2 * meridians_.size(); ++m) {
    Meridian& fits = meridians_[m % meridians_.size()];
    if (fits.front().empty()) fits = meridians_[(m - 1) % meridians_.size()];
  }
}

double PupilTransmittance::on_meridian(std::size_t meridian, std::size_t wavelength, double radius_mm,
                                       double u, double v) const {
  const Meridian& fits = meridians_[meridian];
  const double place = std::min(radius_mm / step_mm_, static_cast<double>(fits.size() - 1));
  const std::size_t inner = std::min(static_cast<std::size_t>(place), fits.size() - 2);
  const double share = place - static_cast<double>(inner);
  const auto& low = fits[inner];
  const auto& high = fits[inner + 1];
  if (low.empty() || high.empty()) return 0;  // no light at all
  return (1 - share) * low[wavelength](u, v) + share * high[wavelength](u, v);
}

double PupilTransmittance::at(std::size_t wavelength, double x_mm, double y_mm, double alpha,
                              double beta) const {
  const double radius = std::hypot(x_mm, y_mm);
  const double along_x = radius > 0 ? x_mm / radius : 0, along_y = radius > 0 ? y_mm / radius : 1;
  const double u = alpha * along_y - beta * along_x, v = alpha * along_x + beta * along_y;
  const std::size_t count = meridians_.size();
  if (count == 1) return std::clamp(on_meridian(0, wavelength, radius, u, v), 0.0, 1.0);
  const double turn = std::atan2(along_x, along_y) / (2 * pi);
  const double azimuth = (turn < 0 ? turn + 1 : turn) * static_cast<double>(count);
  const double below = std::floor(azimuth), t = azimuth - below;
  // Of the meridians one before, below, above and one beyond.
  const double weights[] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                            -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
  double value = 0;
  for (std::size_t k = 0; k < 4; ++k)
    value += weights[k] *
             on_meridian((static_cast<std::size_t>(below) + count + k - 1) % count, wavelength, radius, u, v);
  return std::clamp(value, 0.0, 1.0);
}

}  // namespace petzval
