// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/numeric/sobol.h>
#include <petzval/render/camera/light_probe.h>

#include <algorithm>
#include <vector>

namespace petzval::render {

namespace {

constexpr std::uint32_t rays_each = 1024;

/// \param share  of the film, about its middle, that rays begin on.
bool passes(const FilmCamera& camera, const SensorGeometry& film, int group, double share) {
  const FilmSampling sampling(PixelWindow{0, 0, film.columns, film.rows});
  std::vector<FilmSample> samples(rays_each);
  for (std::uint32_t i = 0; i < rays_each; ++i) {
    SobolSample numbers(1, i);
    const auto [x, y, u, v] = numbers.next4();
    samples[i].column = film.columns * (0.5 + share * (x - 0.5));
    samples[i].row = film.rows * (0.5 + share * (y - 0.5));
    samples[i].u = u, samples[i].v = v;
  }
  std::vector<CameraRay> rays(samples.size());
  camera.trace(group, sampling, samples, rays);
  return std::any_of(rays.begin(), rays.end(), [](const CameraRay& ray) { return ray.passes; });
}

}  // namespace

bool any_light_passes(const FilmCamera& camera, const SensorGeometry& film, int groups) {
  for (int group = 0; group < groups; ++group)
    for (const double share : {1.0, 0.1, 0.01})
      if (passes(camera, film, group, share)) return true;
  return false;
}

}  // namespace petzval::render
