// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/wavelength_range.h>
#include <petzval/render/camera/lens_camera.h>
#include <petzval/render/camera/light_probe.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval::render {

namespace {

/// Radii of the pupil table reach a little beyond the corner.
constexpr double corner_margin = 1 + 1e-9;

InputError no_light(const Lens& lens, double corner_mm) {
  return InputError(
      fmt::format("{}: no light reaches the film, {:.4g} mm behind the lens and {:.4g} mm from corner to "
                  "corner, through a stop "
                  "{:.4g} mm wide; another film distance or a wider stop would be right",
                  lens.name, lens.image_distance_mm(), 2 * corner_mm, 2 * stop_radius_mm(lens)));
}

}  // namespace

LensCamera::LensCamera(const Lens& lens, const SensorGeometry& film, const WavelengthGroups& groups,
                       const LensCameraOptions& options)
    : film_(film), groups_(groups), options_(options) {
  if (film.columns < 1 || film.rows < 1 || !(film.pitch_um > 0))
    throw InputError("the film needs pixels of a positive pitch");
  if (lens.medium_behind(lens.surfaces.size() - 1).index(lens.reference_wavelength_nm) != 1)
    throw InputError(fmt::format("{}: the film does not stand in air, which rendering needs", lens.name));
  if (!(lens.image_distance_mm() > 0))
    throw InputError(
        fmt::format("{}: the film stands {:g} mm behind the last surface; a positive distance would be right",
                    lens.name, lens.image_distance_mm()));
  const double stop_radius = stop_radius_mm(lens);
  const std::vector<double>& nm = groups.wavelengths_nm();
  disperses_ = petzval::disperses(lens, nm);
  for (std::size_t i = 0; i < (disperses_ ? nm.size() : 1); ++i)
    tracers_.push_back(Tracer(lens, nm[i], stop_radius).with_blades({}));

  const StopBlades& blades = lens.stop_blades();
  round_ = tracers_.front().is_centred() && blades.count == 0;
  for (const Tracer& tracer : tracers_) {
    const Tracer bladed = tracer.with_blades(blades);
    to_scene_.push_back(kernel_path<double>(bladed, true, Tracer::Clip::apertures));
    for (KernelSurface<double>& surface : to_scene_.back().surfaces) surface.counts_path = false;
    if (disperses_ || options.lands) to_film_.emplace_back(bladed, RadianceTracer::Direction::forward);
  }
  if (options.diffraction) {
    const double origin_z_mm = options.origin_at_front ? 0 : tracers_.front().image_z_mm();
    waves_ = std::make_shared<const WaveImage>(
        lens, film, nm, WaveImage::Options{options.scene_units_per_mm, origin_z_mm, options.losses});
    options_.margin_pixels += waves_->margin_pixels();
  }
  const bool loses = options.losses.of(lens).any();
  if (options.sampling == LensCameraOptions::Sampling::exit_pupil || loses) {
    ExitPupilRegions regions = find_regions(lens);
    if (loses) transmittance_.emplace(lens, tracers_, nm, options.losses, regions);
    if (options.sampling == LensCameraOptions::Sampling::exit_pupil) regions_ = std::move(regions);
    if (regions_ && !options.lamps.empty())
      guide_ =
          LampGuide(options.lamps, spectrum_ends(),
                    {options.scene_units_per_mm, options.origin_at_front ? 0 : tracers_.front().image_z_mm()},
                    film, options_.margin_pixels * film.pitch_um * mm_per_um, *regions_);
  }

  const Surface& last = lens.surfaces.back();
  rear_distance_mm_ = lens.image_distance_mm();
  if (options.sampling == LensCameraOptions::Sampling::rear_disk) {
    if (!last.semi_diameter_mm)
      throw InputError(fmt::format(
          "{}: the last surface has no aperture to aim at; `sampling` exit-pupil needs none", lens.name));
    rear_radius_mm_ = *last.semi_diameter_mm;
  } else if (!any_light_passes(*this, film_, groups.count())) {
    throw no_light(lens, film_.half_diagonal_mm());
  }
}

std::vector<Tracer> LensCamera::spectrum_ends() const {
  if (!disperses_) return {tracers_.front()};
  return {tracers_[tracers_.size() / 2], tracers_.front(), tracers_.back()};
}

/// How many radii of the film regions are found at. Those of a lens with poses, which are looked for at all
/// azimuths, take longer than a small picture.
std::size_t LensCamera::film_radii(double corner_mm) const {
  constexpr std::size_t most = ExitPupilRegions::default_radii, least = 12;
  constexpr double pixels_apart = 4;
  if (tracers_.front().is_centred()) return most;
  const double pixels = corner_mm / (film_.pitch_um * mm_per_um);
  return std::clamp(static_cast<std::size_t>(pixels / pixels_apart), least, most);
}

/// Of the round stop, whatever its blades: regions depend on the film radius alone. The pupils of the ends
/// and the middle of the spectrum hold those between.
ExitPupilRegions LensCamera::find_regions(const Lens& lens) const {
  const std::vector<Tracer> ends = spectrum_ends();
  const double corner_mm =
      film_.half_diagonal_mm() + std::sqrt(2) * options_.margin_pixels * film_.pitch_um * mm_per_um;
  ExitPupilRegions regions(ends, corner_mm * corner_margin, film_radii(corner_mm));
  constexpr int probes = 64;
  for (int i = 0; i <= probes; ++i)
    if (regions.area_sr(0, corner_mm * i / probes) > 0) return regions;
  throw no_light(lens, corner_mm);
}

std::size_t LensCamera::band(int group, int lane) const {
  return disperses_ ? static_cast<std::size_t>(std::max(0, groups_.band(group, lane))) : 0;
}

LensCamera::Start LensCamera::guided_start(double x_mm, double y_mm, double u, double v) const {
  LampGuide::Direction direction;
  if (u < LampGuide::share) {
    direction = guide_.sample(x_mm, y_mm, u / LampGuide::share, v);
  } else {
    const auto sample = regions_->sample(x_mm, y_mm, (u - LampGuide::share) / (1 - LampGuide::share), v);
    if (!sample) return {};
    direction = {sample->alpha, sample->beta};
  }
  const auto [alpha, beta] = direction;
  const double density = LampGuide::share * guide_.density_per_sr(x_mm, y_mm, alpha, beta) +
                         (1 - LampGuide::share) * regions_->density_per_sr(x_mm, y_mm, alpha, beta);
  return {alpha, beta, density > 0 ? 1 / density : 0};
}

LensCamera::Start LensCamera::start(double x_mm, double y_mm, double u, double v) const {
  if (regions_ && guide_.concerns(x_mm, y_mm)) return guided_start(x_mm, y_mm, u, v);
  return unguided_start(x_mm, y_mm, u, v);
}

LensCamera::Start LensCamera::unguided_start(double x_mm, double y_mm, double u, double v) const {
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

void LensCamera::densities(const PupilDirections& rays, float* per_sr) const {
  if (regions_) {
    regions_->densities_per_sr(rays, per_sr);
    for (std::size_t i = 0; i < rays.count; ++i) {
      const auto x = static_cast<double>(rays.x_mm[i]), y = static_cast<double>(rays.y_mm[i]);
      if (!guide_.concerns(x, y)) continue;
      const double guided =
          guide_.density_per_sr(x, y, static_cast<double>(rays.alpha[i]), static_cast<double>(rays.beta[i]));
      per_sr[i] = static_cast<float>(LampGuide::share * guided +
                                     (1 - LampGuide::share) * static_cast<double>(per_sr[i]));
    }
    return;
  }
  const auto radius = static_cast<float>(rear_radius_mm_), distance = static_cast<float>(rear_distance_mm_);
  const float disk_sr = static_cast<float>(pi) * radius * radius / (distance * distance);
  for (std::size_t i = 0; i < rays.count; ++i) {
    const float cos_sq = 1 - rays.alpha[i] * rays.alpha[i] - rays.beta[i] * rays.beta[i];
    const float along = distance / std::sqrt(cos_sq);
    const float x = rays.x_mm[i] - rays.alpha[i] * along, y = rays.y_mm[i] - rays.beta[i] * along;
    const bool inside = cos_sq > 0 && x * x + y * y <= radius * radius;
    per_sr[i] = inside ? 1 / (disk_sr * cos_sq * cos_sq) : 0;
  }
}

/// The samples of a batch that one wavelength leads.
struct LensCamera::Led {
  int group, hero, lanes;
  const FilmSampling& sampling;
  std::span<const FilmSample> samples;
  std::span<CameraRay> rays;
  bool alone;                      ///< nobody asks where other wavelengths would land
  std::vector<std::size_t> which;  ///< of samples and rays
  RayBatch batch;                  ///< from the film, later in front of the lens
  std::vector<double> density;     ///< [1/sr]
  std::vector<std::uint8_t> passes;
  /// Where on the film each began, and in which direction its light comes in, if that is still wanted.
  std::vector<double> x_mm, y_mm, alpha, beta;
};

void LensCamera::trace(int group, const FilmSampling& sampling, std::span<const FilmSample> samples,
                       std::span<CameraRay> rays) const {
  follow_heroes(group, sampling, samples, rays, false);
}

void LensCamera::lead(int group, const FilmSampling& sampling, std::span<const FilmSample> samples,
                      std::span<CameraRay> rays) const {
  follow_heroes(group, sampling, samples, rays, true);
}

void LensCamera::follow_heroes(int group, const FilmSampling& sampling, std::span<const FilmSample> samples,
                               std::span<CameraRay> rays, bool alone) const {
  const int lanes = groups_.lanes(group);
  Led led{group, 0, lanes, sampling, samples, rays, alone, {}, {}, {}, {}, {}, {}, {}, {}};
  for (led.hero = 0; led.hero < (disperses_ ? lanes : 1); ++led.hero) {
    led.which.clear();
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (!disperses_ || samples[i].hero == led.hero) led.which.push_back(i);
    if (!led.which.empty()) trace_led(led);
  }
}

/// Rays from the film into the region of directions that its place has.
void LensCamera::launch(Led& led) const {
  RayBatch& batch = led.batch;
  batch.resize(led.which.size());
  led.density.resize(led.which.size());
  const double film_z = tracers_.front().image_z_mm();
  for (std::size_t k = 0; k < led.which.size(); ++k) {
    const FilmSample& sample = led.samples[led.which[k]];
    const double x = film_.x_mm(sample.column), y = film_.y_mm(sample.row);
    const Start direction = start(x, y, sample.u, sample.v);
    const double n2 = 1 - direction.alpha * direction.alpha - direction.beta * direction.beta;
    const bool any = n2 > 0 && direction.area > 0;
    batch.x_mm[k] = x, batch.y_mm[k] = y, batch.z_mm[k] = film_z;
    batch.l[k] = -direction.alpha, batch.m[k] = -direction.beta;
    batch.n[k] = any ? -std::sqrt(n2) : -1;
    led.density[k] = any ? 1 / direction.area : 0;
  }
  if (!transmittance_) return;
  led.x_mm = batch.x_mm, led.y_mm = batch.y_mm;
  led.alpha = batch.l, led.beta = batch.m;
  for (std::vector<double>* cosines : {&led.alpha, &led.beta})
    for (double& cosine : *cosines) cosine = -cosine;
}

void LensCamera::trace_to_scene(Led& led) const {
  RayBatch& batch = led.batch;
  led.passes.resize(batch.size());
  const RayColumns<double> rays{batch.x_mm.data(),   batch.y_mm.data(), batch.z_mm.data(),
                                batch.l.data(),      batch.m.data(),    batch.n.data(),
                                batch.opl_mm.data(), led.passes.data(), batch.size()};
  trace_columns(to_scene_[band(led.group, led.hero)], rays);
}

void LensCamera::trace_led(Led& led) const {
  launch(led);
  trace_to_scene(led);
  const RayBatch& batch = led.batch;
  const double unit = options_.scene_units_per_mm;
  const double origin_z = options_.origin_at_front ? 0 : tracers_.front().image_z_mm();
  for (std::size_t k = 0; k < led.which.size(); ++k) {
    CameraRay& ray = led.rays[led.which[k]];
    ray.passes = led.passes[k] && led.density[k] > 0;
    ray.spread = false;
    if (!ray.passes) continue;
    ray.origin = unit * Vector3{batch.x_mm[k], batch.y_mm[k], origin_z - batch.z_mm[k]};
    ray.direction = {batch.l[k], batch.m[k], -batch.n[k]};
    ray.weight_alone = static_cast<float>(led.lanes / led.density[k]);
    ray.weight = Lanes::all(1 / led.density[k]);
    if (led.alone) ray.density = Lanes::all(led.density[k]);
  }
  if (led.alone) return;
  if (disperses_) share_among_wavelengths(led);
  if (transmittance_) dim(led);
}

/// What the lens itself takes: from the hero, or from all where they go the same way.
void LensCamera::dim(const Led& led) const {
  for (std::size_t k = 0; k < led.which.size(); ++k) {
    CameraRay& ray = led.rays[led.which[k]];
    if (!ray.passes) continue;
    for (int lane = 0; lane < led.lanes; ++lane) {
      if (disperses_ && lane != led.hero) continue;
      const double through = transmittance_->at(static_cast<std::size_t>(groups_.band(led.group, lane)),
                                                led.x_mm[k], led.y_mm[k], led.alpha[k], led.beta[k]);
      ray.weight[lane] *= static_cast<float>(through);
      if (lane == led.samples[led.which[k]].hero) ray.weight_alone *= static_cast<float>(through);
    }
  }
}

namespace {

/// Rays of single precision that run the other way.
RadianceRays turned_round(const RayBatch& rays, std::span<const std::size_t> which) {
  RadianceRays turned(which.size());
  for (std::size_t k = 0; k < which.size(); ++k) {
    const std::size_t i = which[k];
    turned.x_mm[k] = static_cast<float>(rays.x_mm[i]);
    turned.y_mm[k] = static_cast<float>(rays.y_mm[i]);
    turned.z_mm[k] = static_cast<float>(rays.z_mm[i]);
    turned.l[k] = static_cast<float>(-rays.l[i]);
    turned.m[k] = static_cast<float>(-rays.m[i]);
    turned.n[k] = static_cast<float>(-rays.n[i]);
  }
  return turned;
}

}  // namespace

/// Of the k-th ray's light at a wavelength, where that lands.
float LensCamera::through(int group, int lane, const RadianceRays& landed, std::size_t k) const {
  if (!transmittance_) return 1;
  return static_cast<float>(
      transmittance_->at(static_cast<std::size_t>(groups_.band(group, lane)),
                         static_cast<double>(landed.x_mm[k]), static_cast<double>(landed.y_mm[k]),
                         static_cast<double>(landed.l[k]), static_cast<double>(landed.m[k])));
}

void LensCamera::share_among_wavelengths(const Led& led) const {
  std::vector<std::size_t> passing;  // in the order of led.which
  for (std::size_t k = 0; k < led.which.size(); ++k)
    if (led.rays[led.which[k]].passes) passing.push_back(k);
  if (passing.empty()) return;
  const std::size_t count = passing.size();
  std::vector<float> sum(count), density(count);
  std::vector<CameraRay*> rays(count);
  for (std::size_t k = 0; k < count; ++k) {
    rays[k] = &led.rays[led.which[passing[k]]];
    rays[k]->spread = true;
    sum[k] = static_cast<float>(led.density[passing[k]]);
    rays[k]->density = only(led.hero, sum[k]);
  }
  const RadianceRays from_scene = turned_round(led.batch, passing);
  RadianceRays landed;
  const auto per_mm = static_cast<float>(1 / (film_.pitch_um * mm_per_um));
  const float middle_column = static_cast<float>(film_.columns) / 2,
              middle_row = static_cast<float>(film_.rows) / 2;
  for (int lane = 0; lane < lane_count; ++lane) {
    if (lane == led.hero) continue;
    if (lane >= led.lanes) {
      for (CameraRay* ray : rays) ray->weight[lane] = 0;
      continue;
    }
    landed = from_scene;
    to_film_[band(led.group, lane)].trace(landed);
    densities({landed.x_mm.data(), landed.y_mm.data(), landed.l.data(), landed.m.data(), count},
              density.data());
    const auto at = static_cast<std::size_t>(lane);
    for (std::size_t k = 0; k < count; ++k) {
      const float column = middle_column - landed.x_mm[k] * per_mm;
      const float row = middle_row + landed.y_mm[k] * per_mm;
      const bool passes = landed.passes[k] != 0;
      if (passes && led.sampling.pixel_at(led.samples[led.which[passing[k]]], static_cast<double>(column),
                                          static_cast<double>(row)))
        sum[k] += rays[k]->density[lane] = density[k];
      rays[k]->weight[lane] = passes ? through(led.group, lane, landed, k) : 0;
      rays[k]->column[at] = column;
      rays[k]->row[at] = row;
    }
  }
  // Balance heuristic: each wavelength divides by the mean of what all of them might have led here with.
  for (std::size_t k = 0; k < count; ++k) {
    rays[k]->weight[led.hero] = 1;
    rays[k]->weight *= static_cast<double>(static_cast<float>(led.lanes) / sum[k]);
  }
}

}  // namespace petzval::render
