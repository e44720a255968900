// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/fft_point_spread.h>
#include <petzval/analysis/round_stop.h>
#include <petzval/analysis/wave_rays.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/wave/angle_characteristic.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr int least_pupil_samples = 8, most_pupil_samples = 1024;

/// Radius of a boundary at an azimuth, linear between its own.
double rim_radius(const PupilBoundary& pupil, double azimuth) {
  const auto count = static_cast<std::ptrdiff_t>(pupil.radius.size());
  const double at = azimuth / (2 * pi) * static_cast<double>(count) - 0.5;
  const auto below = static_cast<std::ptrdiff_t>(std::floor(at));
  const auto radius = [&](std::ptrdiff_t i) {
    return pupil.radius[static_cast<std::size_t>(((i % count) + count) % count)];
  };
  const double share = at - static_cast<double>(below);
  return (1 - share) * radius(below) + share * radius(below + 1);
}

/// Half of the square grid, u > 0, where the boundary has light.
std::vector<PupilNode> grid_nodes(const PupilBoundary& pupil, double radius, int samples) {
  const double step = 2 * radius / samples;
  std::vector<PupilNode> nodes;
  for (int i = 0; i < samples; ++i)
    for (int j = samples / 2; j < samples; ++j) {
      const double u = (j + 0.5) * step - radius, v = (i + 0.5) * step - radius;
      if (std::hypot(u, v) <= rim_radius(pupil, std::atan2(u, v)))
        nodes.push_back({u, pupil.centre_v + v, 1});
    }
  return nodes;
}

}  // namespace

std::optional<Psf> fft_point_spread(const FieldTracer& tracer, const ChiefRay& chief, const PsfGrid& grid,
                                    int pupil_samples) {
  require_centred(tracer.lens(), "the plain FFT's model knows centred lenses");
  require_round_stop(tracer.lens(), "the plain FFT's model knows round ones");
  if (pupil_samples < least_pupil_samples || pupil_samples > most_pupil_samples || pupil_samples % 2 != 0)
    throw InputError("the pupil of an FFT PSF is sampled by an even number of points, 8 to 1024 across");
  if (grid.samples_per_cell != 1) throw InputError("an FFT PSF has samples, not cells");
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief);
  // The scale of the axial pupil holds for all fields.
  const ChiefRay axis;
  const std::optional<PupilBoundary> axial = tracer.object_pupil(axis);
  if (!pupil || !axial) return {};
  const double radius = *std::max_element(axial->radius.begin(), axial->radius.end());
  const double widest = std::max(radius, *std::max_element(pupil->radius.begin(), pupil->radius.end()));
  const std::vector<PupilNode> nodes = grid_nodes(*pupil, widest, pupil_samples);
  const double per_radius = 1 / (2 * first_order(tracer.lens()).working_f_number * radius);
  const double sphere_mm = reference_sphere_radius_mm(tracer, chief), index = tracer.tracer().image_index();
  const double lambda_mm = tracer.tracer().wavelength_nm() * mm_per_nm;

  PupilWaves waves;
  waves.wavelength_nm = tracer.tracer().wavelength_nm();
  waves.image_index = index;
  const std::vector<WaveRay> rays = trace_wave_rays(tracer, chief, *pupil, nodes);
  // Light from the upper part of a pupil comes down to the image, unless the lens turns it over.
  double turned = 0;
  const double outwards = chief.image_height_mm < 0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) turned += rays[i].passes ? nodes[i].u * rays[i].alpha : 0;
  const double sense = turned < 0 ? -1 : 1;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!rays[i].passes) continue;
    const double behind_mm =
        sphere_behind_foot_mm(rays[i].s_mm, rays[i].t_mm, rays[i].alpha, rays[i].beta, sphere_mm);
    waves.alpha.push_back(sense * nodes[i].u * per_radius);
    waves.beta.push_back(sense * outwards * (nodes[i].v - pupil->centre_v) * per_radius);
    waves.phase_waves.push_back(rays[i].phase_waves - index * behind_mm / lambda_mm);
    waves.amplitude.push_back(1);
  }
  if (waves.size() == 0) return {};
  // Parseval on the grid: every point of weight one stands for a square of the pupil.
  const double step = 2 * widest / pupil_samples * per_radius;
  waves.flux = 2 * static_cast<double>(waves.size()) / (step * step);
  return sum_plane_waves(waves, grid.size, grid.spacing_um);
}

}  // namespace petzval
