// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/trace/pupil_transmittance.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr int degree = 8;
/// Rays from each film radius, around the pupil and outwards.
constexpr int around = 20, outwards = 8;
/// A little beyond the pupil, so that no fit runs away where the pupil of the next radius ends.
constexpr double wider = 1.08;

/// The lens at each of the wavelengths.
struct Light {
  std::span<const Tracer> tracers;
  std::vector<LensTransmittance> transmittances;

  const Tracer& tracer(std::size_t wavelength) const { return tracers[tracers.size() == 1 ? 0 : wavelength]; }
  std::size_t wavelengths() const { return transmittances.size(); }
};

/// What rays from one film point (on +y) lose: at directions (u, v), by wavelength.
struct Seen {
  std::vector<double> u, v;
  std::vector<std::vector<double>> transmittance;  ///< [wavelength]
};

/// Adds a direction, unless it is lost at any wavelength.
void add(const Light& light, double radius_mm, double u, double v, Seen& seen) {
  if (!(u * u + v * v < 1)) return;
  std::vector<double> values;
  std::vector<Intersection> path;
  for (std::size_t i = 0; i < light.wavelengths(); ++i) {
    const Tracer& tracer = light.tracer(i);
    const Ray start{{0, radius_mm, tracer.image_z_mm()}, {-u, -v, -std::sqrt(1 - u * u - v * v)}};
    path.clear();
    if (tracer.trace_backward(start, Tracer::Clip::none, &path).status != RayStatus::ok) return;
    values.push_back(light.transmittances[i].along(tracer.from_image(start), path, true));
  }
  seen.u.push_back(u), seen.v.push_back(v);
  for (std::size_t i = 0; i < values.size(); ++i) seen.transmittance[i].push_back(values[i]);
}

Seen seen_from(const Light& light, const ExitPupilRegions& regions, double radius_mm) {
  Seen seen;
  seen.transmittance.resize(light.wavelengths());
  const auto centre = regions.sample(0, radius_mm, 0.5, 0);
  if (!centre) return seen;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < outwards; ++j) {
      const auto sample = regions.sample(0, radius_mm, (i + 0.5) / around, (j + 0.5) / outwards);
      add(light, radius_mm, centre->alpha + wider * (sample->alpha - centre->alpha),
          centre->beta + wider * (sample->beta - centre->beta), seen);
    }
  return seen;
}

/// Of as high a degree as there are rays for; nothing without any.
std::vector<ChebyshevSurface> fitted(const Seen& seen) {
  const std::vector<std::span<const double>> values(seen.transmittance.begin(), seen.transmittance.end());
  for (int each = seen.u.empty() ? -1 : degree; each >= 0; each -= 2) {
    if (seen.u.size() < 2 * ChebyshevSurface::unknowns(each)) continue;
    std::vector<ChebyshevSurface> surfaces = ChebyshevSurface::fit(seen.u, seen.v, values, each);
    if (!surfaces.empty()) return surfaces;
  }
  return {};
}

}  // namespace

PupilTransmittance::PupilTransmittance(const Lens& lens, std::span<const Tracer> tracers,
                                       std::span<const double> wavelengths_nm, const Losses& losses,
                                       const ExitPupilRegions& regions, std::size_t radii)
    : step_mm_(regions.film_radius_mm() / static_cast<double>(radii - 1)), fits_(radii) {
  Light light{tracers, {}};
  for (const double nm : wavelengths_nm) light.transmittances.emplace_back(lens, nm, losses);
  parallel_for(radii, [&](std::size_t i) {
    fits_[i] = fitted(seen_from(light, regions, step_mm_ * static_cast<double>(i)));
  });
  for (std::size_t i = 1; i < radii; ++i)
    if (fits_[i].empty()) fits_[i] = fits_[i - 1];
  for (std::size_t i = radii - 1; i-- > 0;)
    if (fits_[i].empty()) fits_[i] = fits_[i + 1];
}

double PupilTransmittance::at(std::size_t wavelength, double x_mm, double y_mm, double alpha,
                              double beta) const {
  const double radius = std::hypot(x_mm, y_mm);
  const double along_x = radius > 0 ? x_mm / radius : 0, along_y = radius > 0 ? y_mm / radius : 1;
  const double u = alpha * along_y - beta * along_x, v = alpha * along_x + beta * along_y;
  const double place = std::min(radius / step_mm_, static_cast<double>(fits_.size() - 1));
  const std::size_t inner = std::min(static_cast<std::size_t>(place), fits_.size() - 2);
  const double share = place - static_cast<double>(inner);
  const auto& low = fits_[inner];
  const auto& high = fits_[inner + 1];
  if (low.empty() || high.empty()) return 0;  // no light at all
  const double value = (1 - share) * low[wavelength](u, v) + share * high[wavelength](u, v);
  return std::clamp(value, 0.0, 1.0);
}

}  // namespace petzval
