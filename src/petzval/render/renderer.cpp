// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/render/renderer.h>

#include <atomic>
#include <chrono>

namespace petzval::render {

namespace {

constexpr int tile_side = 16;
/// Samples of each group of wavelengths in one pass over the picture.
constexpr int indices_a_pass = 4;

/// Light that landed outside of the tile that found it.
struct Stray {
  std::size_t at;  ///< into Film::light
  double light;
};

/// All that one tile adds in one pass.
struct TileResult {
  std::vector<Stray> strays;
  std::uint64_t rays = 0, passed = 0;
};

/// Follows the samples of one tile. Everything that it changes in the film are its own pixels.
class TileRenderer {
 public:
  TileRenderer(const World& world, const FilmCamera& camera, const Transform& world_from_camera,
               const SensorGeometry& sensor, const FilmSampling& sampling, const RenderOptions& options,
               const PixelWindow& tile, Film& film)
      : world_(world),
        camera_(camera),
        world_from_camera_(world_from_camera),
        sensor_(sensor),
        sampling_(sampling),
        options_(options),
        tracer_(world, options.path),
        tile_(tile),
        film_(film) {}

  TileResult run(int first_index, int samples_per_pixel) {
    const int groups = world_.groups.count();
    for (int group = 0; group < groups; ++group) {
      // The samples are dealt out to the groups in turn.
      const int of_group = (samples_per_pixel - group + groups - 1) / groups;
      take_samples(group, first_index, std::min(first_index + indices_a_pass, of_group), 1.0 / of_group);
    }
    return std::move(result_);
  }

 private:
  /// Of the i-th sample of a batch.
  Pixel pixel_of(std::size_t i) const {
    const int within = static_cast<int>(i % tile_.size());
    return {tile_.left + within % tile_.columns(), tile_.top + within / tile_.columns()};
  }

  /// The samples [first, last) of each pixel.
  void take_samples(int group, int first, int last, double share) {
    samples_.clear(), places_.clear();
    for (int index = first; index < last; ++index)
      for (std::size_t i = 0; i < tile_.size(); ++i) start_sample(group, index, pixel_of(i));
    rays_.assign(places_.size(), {});
    camera_.trace(group, sampling_, places_, rays_);
    for (std::size_t i = 0; i < places_.size(); ++i) follow(i, group, share);
  }

  void start_sample(int group, int index, Pixel pixel) {
    const auto number = static_cast<std::uint32_t>(pixel.row * sensor_.columns + pixel.column);
    const std::uint32_t seed = hashed(number, hashed(static_cast<std::uint32_t>(options_.seed),
                                                     static_cast<std::uint32_t>(options_.seed >> 32) ^
                                                         static_cast<std::uint32_t>(group) * 0x9e3779b9u));
    samples_.emplace_back(seed, static_cast<std::uint32_t>(index));
    const auto [x, y, u, v] = samples_.back().next4();
    places_.push_back(sampling_.place(pixel, x, y, u, v));
    // In turn from a random start: every wavelength leads equally often.
    places_.back().hero = static_cast<int>((hashed(seed, 0x68e31da4u) + static_cast<std::uint32_t>(index)) %
                                           static_cast<std::uint32_t>(world_.groups.lanes(group)));
  }

  void follow(std::size_t i, int group, double share) {
    const CameraRay& ray = rays_[i];
    ++result_.rays;
    if (!ray.passes) return;
    ++result_.passed;
    const Vector3 origin = world_from_camera_.point(ray.origin);
    const Vector3 direction = normalised(world_from_camera_.direction(ray.direction));
    FirstSurface first;
    const PathLight light =
        tracer_.trace(origin, direction, group, places_[i].hero, samples_[i], options_.far_distance,
                      film_.has_first_surfaces() ? &first : nullptr);
    add_light(i, group, share, light);
    if (first.met) add_first(i, group, first);
  }

  void add_light(std::size_t i, int group, double share, const PathLight& light) {
    const CameraRay& ray = rays_[i];
    const int hero = places_[i].hero;
    for (int lane = 0; lane < world_.groups.lanes(group); ++lane) {
      double value = static_cast<double>(light.shared[lane] * ray.weight[lane]);
      if (lane == hero) value += static_cast<double>(light.alone * ray.weight_alone);
      if (value == 0) continue;
      std::optional<Pixel> pixel = pixel_of(i);
      if (ray.spread && lane != hero)
        pixel =
            sampling_.pixel_at(places_[i], static_cast<double>(ray.column[static_cast<std::size_t>(lane)]),
                               static_cast<double>(ray.row[static_cast<std::size_t>(lane)]));
      if (pixel) add(*pixel, world_.groups.band(group, lane), share * value);
    }
  }

  void add(Pixel pixel, int band, double value) {
    const std::size_t at =
        static_cast<std::size_t>(band) * film_.window.size() + film_.window.index(pixel.column, pixel.row);
    if (tile_.contains(pixel.column, pixel.row))
      film_.light[at] += value;
    else
      result_.strays.push_back({at, value});
  }

  void add_first(std::size_t i, int group, const FirstSurface& first) {
    const Pixel pixel = pixel_of(i);
    const std::size_t at = film_.window.index(pixel.column, pixel.row);
    film_.met[at] += 1;
    film_.depth[at] += world_from_camera_.inverse_point(first.position).z;
    film_.normal[3 * at] += first.normal.x;
    film_.normal[3 * at + 1] += first.normal.y;
    film_.normal[3 * at + 2] += first.normal.z;
    for (int lane = 0; lane < world_.groups.lanes(group); ++lane)
      film_.albedo[static_cast<std::size_t>(world_.groups.band(group, lane)) * film_.window.size() + at] +=
          static_cast<double>(first.albedo[lane]);
  }

  const World& world_;
  const FilmCamera& camera_;
  const Transform& world_from_camera_;
  const SensorGeometry& sensor_;
  const FilmSampling& sampling_;
  const RenderOptions& options_;
  PathTracer tracer_;
  PixelWindow tile_;
  Film& film_;
  TileResult result_;
  std::vector<SobolSample> samples_;
  std::vector<FilmSample> places_;
  std::vector<CameraRay> rays_;
};

std::vector<PixelWindow> tiles_of(const PixelWindow& window) {
  std::vector<PixelWindow> tiles;
  for (int top = window.top; top < window.bottom; top += tile_side)
    for (int left = window.left; left < window.right; left += tile_side)
      tiles.push_back(
          {left, top, std::min(left + tile_side, window.right), std::min(top + tile_side, window.bottom)});
  return tiles;
}

PixelWindow checked_window(const SensorGeometry& sensor, const RenderOptions& options) {
  const PixelWindow window = options.window.value_or(PixelWindow{0, 0, sensor.columns, sensor.rows});
  if (window.left < 0 || window.top < 0 || window.right > sensor.columns || window.bottom > sensor.rows ||
      window.columns() < 1 || window.rows() < 1)
    throw InputError("the window to be rendered does not lie inside of the picture");
  return window;
}

/// The mean over the samples that met a surface, and the light.
Rendering developed(const Film& film, const WavelengthGroups& groups, const SensorGeometry& sensor,
                    const Photosite& photosite, double samples_of_pixel) {
  Rendering result;
  result.irradiance =
      SpectralImage(film.window.columns(), film.window.rows(), groups.wavelengths_nm(), sensor.pitch_um,
                    photosite.is_plain() ? PixelAperture::box : PixelAperture::photosite);
  if (!photosite.is_plain()) result.irradiance.photosite = photosite.text();
  const std::size_t pixels = film.window.size();
  for (int band = 0; band < result.irradiance.bands(); ++band) {
    const std::span<float> plane = result.irradiance.band(band);
    for (std::size_t i = 0; i < pixels; ++i)
      plane[i] = static_cast<float>(film.light[static_cast<std::size_t>(band) * pixels + i]);
  }
  result.rays = film.rays, result.passed = film.passed;
  if (!film.has_first_surfaces()) return result;
  FirstSurfaces& first = result.first_surfaces.emplace();
  first.depth.resize(pixels), first.normal.resize(3 * pixels), first.share.resize(pixels);
  first.albedo.resize(film.albedo.size());
  for (std::size_t i = 0; i < pixels; ++i) {
    const double met = film.met[i] > 0 ? film.met[i] : 1;
    first.share[i] = static_cast<float>(film.met[i] / samples_of_pixel);
    first.depth[i] = static_cast<float>(film.depth[i] / met);
    const Vector3 normal = normalised({film.normal[3 * i], film.normal[3 * i + 1], film.normal[3 * i + 2]});
    first.normal[3 * i] = static_cast<float>(normal.x);
    first.normal[3 * i + 1] = static_cast<float>(normal.y);
    first.normal[3 * i + 2] = static_cast<float>(normal.z);
    for (std::size_t band = 0; band * pixels < film.albedo.size(); ++band)
      // Each band is in one group of `count`, which saw as large a share of the samples.
      first.albedo[band * pixels + i] =
          static_cast<float>(film.albedo[band * pixels + i] * groups.count() / met);
  }
  return result;
}

}  // namespace

int effective_samples(const WavelengthGroups& groups, int samples_per_pixel) {
  return std::max(samples_per_pixel, groups.count());
}

Rendering render_picture(const World& world, const FilmCamera& camera, const Transform& world_from_camera,
                         const SensorGeometry& sensor, const RenderOptions& options,
                         const ProgressCallback& progress) {
  if (options.samples_per_pixel < 1) throw InputError("a picture takes at least one sample a pixel");
  const PixelWindow window = checked_window(sensor, options);
  const FilmSampling sampling(window, options.photosite);
  Film film(window, static_cast<int>(world.groups.wavelengths_nm().size()), options.first_surfaces);
  if (!options.checkpoint.empty()) read_checkpoint(options.checkpoint, film, options.fingerprint);

  const int samples = effective_samples(world.groups, options.samples_per_pixel);
  const int most_of_group = (samples + world.groups.count() - 1) / world.groups.count();
  const int passes = (most_of_group + indices_a_pass - 1) / indices_a_pass;
  const std::vector<PixelWindow> tiles = tiles_of(window);
  std::vector<TileResult> results(tiles.size());
  auto saved = std::chrono::steady_clock::now();
  bool go_on = true;
  while (film.passes < passes && go_on) {
    std::atomic<std::size_t> done{0};
    parallel_for(tiles.size(), [&](std::size_t i) {
      results[i] = TileRenderer(world, camera, world_from_camera, sensor, sampling, options, tiles[i], film)
                       .run(film.passes * indices_a_pass, samples);
      if (progress)
        progress((film.passes + static_cast<double>(++done) / static_cast<double>(tiles.size())) / passes,
                 "light");
    });
    // In the order of the tiles, whoever finished first.
    for (TileResult& tile : results) {
      for (const Stray& stray : tile.strays) film.light[stray.at] += stray.light;
      film.rays += tile.rays, film.passed += tile.passed;
    }
    ++film.passes;
    if (options.after_pass) go_on = options.after_pass(film.passes, passes);
    const auto now = std::chrono::steady_clock::now();
    const bool save = film.passes < passes && (!go_on || std::chrono::duration<double>(now - saved).count() >=
                                                             options.checkpoint_seconds);
    if (!options.checkpoint.empty() && save) {
      write_checkpoint(options.checkpoint, film, options.fingerprint);
      saved = now;
    }
  }
  Rendering result = developed(film, world.groups, sensor, options.photosite, samples);
  result.complete = film.passes == passes;
  return result;
}

}  // namespace petzval::render
