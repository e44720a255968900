// SPDX-License-Identifier: BSD-3-Clause
// What a lens camera makes of light that another camera has found, and of a uniform field.
#include <petzval/numeric/sobol.h>
#include <petzval/render/camera/lens_camera.h>

#include <cmath>

namespace petzval::render {

void LensCamera::land(int group, int lane, const RadianceRays& from_scene, LandedLight& landed) const {
  landed.rays = from_scene;
  RadianceRays& rays = landed.rays;
  if (!options_.origin_at_front) {
    const auto origin_z = static_cast<float>(tracers_.front().image_z_mm());
    for (float& z : rays.z_mm) z += origin_z;
  }
  to_film_[band(group, lane)].trace(rays);
  landed.per_sr.resize(rays.size());
  densities({rays.x_mm.data(), rays.y_mm.data(), rays.l.data(), rays.m.data(), rays.size()},
            landed.per_sr.data());
  for (std::size_t k = 0; k < rays.size(); ++k)
    if (rays.passes[k] == 0) landed.per_sr[k] = 0;
}

float LensCamera::kept(int group, int lane, const LandedLight& landed, std::size_t k) const {
  return through(group, lane, landed.rays, k);
}

double LensCamera::etendue_sr(int group, int lane, double x_mm, double y_mm, std::size_t count) const {
  constexpr std::uint32_t seed = 0x65746e64u;
  RayBatch rays;
  rays.resize(count);
  std::vector<double> area(count), alpha(count), beta(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto [u, v] = SobolSample(seed, static_cast<std::uint32_t>(k)).next2();
    const Start start = unguided_start(x_mm, y_mm, u, v);
    const double n2 = 1 - start.alpha * start.alpha - start.beta * start.beta;
    area[k] = n2 > 0 ? start.area : 0, alpha[k] = start.alpha, beta[k] = start.beta;
    rays.x_mm[k] = x_mm, rays.y_mm[k] = y_mm, rays.z_mm[k] = tracers_.front().image_z_mm();
    rays.l[k] = -start.alpha, rays.m[k] = -start.beta, rays.n[k] = area[k] > 0 ? -std::sqrt(n2) : -1;
  }
  std::vector<std::uint8_t> passes(count);
  trace_columns(to_scene_[band(group, lane)],
                RayColumns<double>{rays.x_mm.data(), rays.y_mm.data(), rays.z_mm.data(), rays.l.data(),
                                   rays.m.data(), rays.n.data(), rays.opl_mm.data(), passes.data(), count});
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (passes[k] == 0) continue;
    const auto at = static_cast<std::size_t>(groups_.band(group, lane));
    sum += area[k] * (transmittance_ ? transmittance_->at(at, x_mm, y_mm, alpha[k], beta[k]) : 1);
  }
  return sum / static_cast<double>(count);
}

}  // namespace petzval::render
