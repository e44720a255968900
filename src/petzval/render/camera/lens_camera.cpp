// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/render/camera/lens_camera.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval::render {

namespace {

/// Radii of the pupil table reach a little beyond the corner.
constexpr double corner_margin = 1 + 1e-9;

bool any_dispersion(const Lens& lens, const std::vector<double>& wavelengths_nm) {
  for (const Surface& surface : lens.surfaces)
    for (const double nm : wavelengths_nm)
      if (surface.material.index(nm) != surface.material.index(wavelengths_nm.front())) return true;
  return false;
}

}  // namespace

LensCamera::LensCamera(const Lens& lens, const SensorGeometry& film, const WavelengthGroups& groups,
                       const LensCameraOptions& options)
    : film_(film), groups_(groups), options_(options) {
  if (film.columns < 1 || film.rows < 1 || !(film.pitch_um > 0))
    throw InputError("the film needs pixels of a positive pitch");
  if (lens.surfaces.back().material.index(lens.reference_wavelength_nm) != 1)
    throw InputError(fmt::format("{}: the film does not stand in air, which rendering needs", lens.name));
  if (!(lens.surfaces.back().thickness_mm > 0))
    throw InputError(
        fmt::format("{}: the film stands {:g} mm behind the last surface; a positive distance would be right",
                    lens.name, lens.surfaces.back().thickness_mm));
  const double stop_radius = stop_radius_mm(lens);
  const std::vector<double>& nm = groups.wavelengths_nm();
  disperses_ = any_dispersion(lens, nm);
  for (std::size_t i = 0; i < (disperses_ ? nm.size() : 1); ++i)
    tracers_.emplace_back(lens, nm[i], stop_radius);

  if (options.sampling == LensCameraOptions::Sampling::exit_pupil) find_regions(lens);

  const Surface& last = lens.surfaces.back();
  rear_distance_mm_ = last.thickness_mm;
  if (options.sampling == LensCameraOptions::Sampling::rear_disk) {
    if (!last.semi_diameter_mm)
      throw InputError(fmt::format(
          "{}: the last surface has no aperture to aim at; --sampling exit-pupil needs none", lens.name));
    rear_radius_mm_ = *last.semi_diameter_mm;
  }
}

/// The pupils of the ends and the middle of the spectrum hold those between.
void LensCamera::find_regions(const Lens& lens) {
  std::vector<Tracer> ends{tracers_.front()};
  if (disperses_) ends = {tracers_.front(), tracers_[tracers_.size() / 2], tracers_.back()};
  const double corner_mm =
      film_.half_diagonal_mm() + std::sqrt(2) * options_.margin_pixels * film_.pitch_um * mm_per_um;
  regions_.emplace(ends, corner_mm * corner_margin);
  constexpr int probes = 64;
  for (int i = 0; i <= probes; ++i)
    if (regions_->area_sr(0, corner_mm * i / probes) > 0) return;
  throw InputError(
      fmt::format("{}: no light reaches the film, {:.4g} mm behind the lens and {:.4g} mm from corner to "
                  "corner; another film distance or a wider stop would be right",
                  lens.name, lens.surfaces.back().thickness_mm, 2 * corner_mm));
}

const Tracer& LensCamera::tracer(int group, int lane) const {
  return disperses_ ? tracers_[static_cast<std::size_t>(std::max(0, groups_.band(group, lane)))]
                    : tracers_.front();
}

LensCamera::Start LensCamera::start(double x_mm, double y_mm, double u, double v) const {
  if (regions_) {
    const std::optional<ExitPupilRegions::Sample> sample = regions_->sample(x_mm, y_mm, u, v);
    return sample ? Start{sample->alpha, sample->beta, sample->area_sr} : Start{};
  }
  const double r = rear_radius_mm_ * std::sqrt(u), phi = 2 * pi * v;
  const double dx = x_mm - r * std::cos(phi), dy = y_mm - r * std::sin(phi);
  const double length = std::sqrt(dx * dx + dy * dy + rear_distance_mm_ * rear_distance_mm_);
  const double cos = rear_distance_mm_ / length, disk = pi * rear_radius_mm_ * rear_radius_mm_;
  return {dx / length, dy / length, disk * cos * cos * cos * cos / (rear_distance_mm_ * rear_distance_mm_)};
}

double LensCamera::density(double x_mm, double y_mm, double alpha, double beta) const {
  if (regions_) return regions_->density_per_sr(x_mm, y_mm, alpha, beta);
  const double cos = std::sqrt(std::max(0.0, 1 - alpha * alpha - beta * beta));
  if (!(cos > 0)) return 0;
  const double x = x_mm - alpha / cos * rear_distance_mm_, y = y_mm - beta / cos * rear_distance_mm_;
  if (x * x + y * y > rear_radius_mm_ * rear_radius_mm_) return 0;
  return rear_distance_mm_ * rear_distance_mm_ /
         (pi * rear_radius_mm_ * rear_radius_mm_ * cos * cos * cos * cos);
}

void LensCamera::trace(int group, int hero, const FilmSampling& film, std::span<const FilmSample> samples,
                       std::span<CameraRay> rays) const {
  const Tracer& leading = tracer(group, hero);
  RayBatch batch(samples.size());
  std::vector<double> densities(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double x = film_.x_mm(samples[i].column), y = film_.y_mm(samples[i].row);
    const Start direction = start(x, y, samples[i].u, samples[i].v);
    const double n2 = 1 - direction.alpha * direction.alpha - direction.beta * direction.beta;
    batch.x_mm[i] = x, batch.y_mm[i] = y, batch.z_mm[i] = leading.image_z_mm();
    batch.l[i] = -direction.alpha, batch.m[i] = -direction.beta;
    batch.n[i] = -std::sqrt(std::max(n2, 0.0));
    batch.opl_mm[i] = 0;
    densities[i] = direction.area > 0 ? 1 / direction.area : 0;
    if (!(n2 > 0) || !(direction.area > 0)) {
      // Any ray that surely fails: no light arrives that way.
      batch.l[i] = 1, batch.m[i] = 0, batch.n[i] = 0;
    }
  }
  leading.trace_backward(batch);
  const int lanes = groups_.lanes(group);
  const double unit = options_.scene_units_per_mm;
  const double origin_z = options_.origin_at_front ? 0 : leading.image_z_mm();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    CameraRay& ray = rays[i];
    ray.passes = batch.status[i] == RayStatus::ok && densities[i] > 0;
    ray.spread = false;
    if (!ray.passes) continue;
    ray.origin = unit * Vector3{batch.x_mm[i], batch.y_mm[i], origin_z - batch.z_mm[i]};
    ray.direction = {batch.l[i], batch.m[i], -batch.n[i]};
    ray.weight = Lanes::all(1 / densities[i]);
    ray.weight_alone = static_cast<float>(lanes / densities[i]);
  }
  if (disperses_) share_among_wavelengths(group, hero, film, samples, rays, batch, densities);
}

void LensCamera::share_among_wavelengths(int group, int hero, const FilmSampling& film,
                                         std::span<const FilmSample> samples, std::span<CameraRay> rays,
                                         const RayBatch& scene_side,
                                         std::span<const double> hero_density) const {
  const int lanes = groups_.lanes(group);
  std::vector<std::size_t> passing;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays[i].passes) passing.push_back(i);
  std::vector<double> sum(passing.size());
  for (std::size_t k = 0; k < passing.size(); ++k) sum[k] = hero_density[passing[k]];
  for (const std::size_t i : passing) rays[i].spread = true;
  const double pitch_mm = film_.pitch_um * mm_per_um;
  RayBatch batch;
  for (int lane = 0; lane < lane_count; ++lane) {
    if (lane == hero) continue;
    if (lane >= lanes) {
      for (const std::size_t i : passing) rays[i].weight[lane] = 0;
      continue;
    }
    batch = RayBatch();
    for (const std::size_t i : passing)
      batch.push_back(scene_side.x_mm[i], scene_side.y_mm[i], scene_side.z_mm[i], -scene_side.l[i],
                      -scene_side.m[i], -scene_side.n[i]);
    tracer(group, lane).trace(batch);
    for (std::size_t k = 0; k < passing.size(); ++k) {
      CameraRay& ray = rays[passing[k]];
      ray.weight[lane] = 0;
      if (batch.status[k] != RayStatus::ok) continue;
      const double column = film_.columns / 2.0 - batch.x_mm[k] / pitch_mm;
      const double row = film_.rows / 2.0 + batch.y_mm[k] / pitch_mm;
      if (film.pixel_at(samples[passing[k]], column, row))
        sum[k] += density(batch.x_mm[k], batch.y_mm[k], batch.l[k], batch.m[k]);
      ray.weight[lane] = 1;
      ray.column[static_cast<std::size_t>(lane)] = static_cast<float>(column);
      ray.row[static_cast<std::size_t>(lane)] = static_cast<float>(row);
    }
  }
  // Balance heuristic: each wavelength divides by the mean of what all of them might have led here with.
  for (std::size_t k = 0; k < passing.size(); ++k) {
    CameraRay& ray = rays[passing[k]];
    ray.weight[hero] = 1;
    ray.weight *= lanes / sum[k];
  }
}

}  // namespace petzval::render
