// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/film/denoise.h>
#include <petzval/render/film/exact_sum.h>
#include <petzval/simulate/prepared_world.h>
#include <petzval/simulate/render_estimate.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace petzval {

namespace {

constexpr int probe_side = 96;            // pixels along the longer side
constexpr int probe_samples_a_group = 8;  // enough passes for an estimate of the noise

/// The same frame in fewer pixels.
SensorGeometry coarse(const SensorGeometry& film) {
  const double scale = std::max(1.0, std::max(film.columns, film.rows) / static_cast<double>(probe_side));
  SensorGeometry result;
  result.columns = std::max(1, static_cast<int>(std::lround(film.columns / scale)));
  result.rows = std::max(1, static_cast<int>(std::lround(film.rows / scale)));
  result.pitch_um = film.pitch_um * film.columns / result.columns;
  return result;
}

double bytes_of(const PreparedScene& scene) {
  const render::WavelengthGroups& groups = scene.world->world->groups;
  const double bands = static_cast<double>(groups.wavelengths_nm().size());
  const bool halves = scene.request.denoise_light, kept = !scene.request.checkpoint.empty();
  const bool layers = scene.request.first_surfaces || halves;
  const double once = bands + (layers ? bands + groups.count() + 4 : 0);
  const double sums = once * (halves ? 2 : 1) + 1 + (scene.request.noise > 0 && !halves ? 1 : 0);
  const double lights =
      scene.request.light_groups ? static_cast<double>(scene.world->world->lights.sources.size()) : 0;
  // Two halves, two candidates and the result.
  const double smooth = halves ? 5 * bands + 4 * render::PictureHalves::feature_count : 0;
  const double picture = bands * (1 + lights) + (layers ? bands + 5 : 0) + smooth;
  const double pixels = static_cast<double>(scene.film.columns) * scene.film.rows;
  return pixels *
         ((sums + bands * lights) * sizeof(render::ExactSum) * (kept ? 2 : 1) + picture * sizeof(float));
}

}  // namespace

RenderEstimate estimate_render(const PreparedScene& scene, const Context& context) {
  PreparedScene probe = scene;
  auto world = std::make_shared<PreparedWorld>(*scene.world);
  world->camera.film = probe.film = coarse(scene.film);
  world->camera.perspective.columns = probe.film.columns, world->camera.perspective.rows = probe.film.rows;
  probe.world = world;
  RenderRequest& request = probe.request;
  const int groups = scene.world->world->groups.count();
  request.checkpoint.clear();
  request.region.reset(), request.sample_range.reset();
  request.first_surfaces = request.light_groups = request.denoise_light = false;
  request.samples_per_pixel = probe_samples_a_group * groups;
  const double wanted = request.noise;
  request.noise = wanted > 0 ? 1e-9 : 0;  // all samples are taken, and the noise is told
  Context silent = context;
  silent.note = {};
  const auto start = std::chrono::steady_clock::now();
  const Rendering picture = render_scene(probe, silent);
  RenderEstimate estimate;
  estimate.probe_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  estimate.memory_bytes = bytes_of(scene);
  estimate.samples_per_pixel = samples_asked(scene);
  if (wanted > 0 && picture.noise)
    // As a double, for a whole number may not hold what almost no noise would take.
    estimate.samples_per_pixel = static_cast<int>(
        std::clamp(std::ceil(picture.samples_per_pixel * std::pow(*picture.noise / wanted, 2)), 1.0,
                   static_cast<double>(estimate.samples_per_pixel)));
  estimate.seconds = estimate.probe_seconds * static_cast<double>(scene.film.columns) * scene.film.rows /
                     (static_cast<double>(probe.film.columns) * probe.film.rows) *
                     estimate.samples_per_pixel / picture.samples_per_pixel;
  return estimate;
}

}  // namespace petzval
