// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/context.h>
#include <petzval/base/parallel.h>
#include <petzval/render/film/noise.h>
#include <petzval/render/renderer.h>
#include <petzval/render/tile_renderer.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>

namespace petzval::render {

namespace {

constexpr int tile_side = 16;
/// Samples of each group of wavelengths in one pass over the picture.
constexpr int indices_a_pass = 4;
/// Before so many passes an estimate of the noise is too uncertain to end at.
constexpr int fewest_passes = 4;

/// How the samples of a pixel are dealt out: to the groups of wavelengths in turn, four of each in a pass.
class Passes {
 public:
  Passes(const WavelengthGroups& groups, const RenderOptions& options)
      : groups_(groups.count()),
        samples_(effective_samples(groups, options.samples_per_pixel)),
        halves_(options.noise > 0) {
    count_ = (most_of_group() + indices_a_pass - 1) / indices_a_pass;
    if (!halves_) return;
    count_ += count_ % 2;
    samples_ = count_ * indices_a_pass * groups_;
  }

  int count() const { return count_; }
  std::vector<SampleRange> ranges(int pass) const {
    // Of two halves each has samples of its own.
    const int index = (halves_ ? pass / 2 : pass) * indices_a_pass;
    std::vector<SampleRange> result;
    for (int group = 0; group < groups_; ++group)
      result.push_back({index, index + taken(group, pass + 1) - taken(group, pass)});
    return result;
  }
  /// Samples of a group after some passes.
  int taken(int group, int passes) const {
    const int of_group = (samples_ - group + groups_ - 1) / groups_;
    return std::min(passes * indices_a_pass, of_group);
  }
  int taken(int passes) const {
    int sum = 0;
    for (int group = 0; group < groups_; ++group) sum += taken(group, passes);
    return sum;
  }
  /// Passes that take as many samples as a pass can: what follows them does not depend on how many are
  /// wanted.
  int full() const { return samples_ / (indices_a_pass * groups_); }

 private:
  int most_of_group() const { return (samples_ + groups_ - 1) / groups_; }

  int groups_, samples_, count_ = 0;
  bool halves_;
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

/// The means over the samples that were taken, and over those that met a surface.
Rendering developed(const Film& film, const WavelengthGroups& groups, const SensorGeometry& sensor,
                    const Photosite& photosite, const Passes& passes) {
  Rendering result;
  result.irradiance =
      SpectralImage(film.window.columns(), film.window.rows(), groups.wavelengths_nm(), sensor.pitch_um,
                    photosite.is_plain() ? PixelAperture::box : PixelAperture::photosite);
  if (!photosite.is_plain()) result.irradiance.photosite = photosite.text();
  const std::size_t pixels = film.window.size();
  for (int band = 0; band < result.irradiance.bands(); ++band) {
    const std::span<float> plane = result.irradiance.band(band);
    const double samples = std::max(1, passes.taken(band % groups.count(), film.passes));
    for (std::size_t i = 0; i < pixels; ++i)
      plane[i] = static_cast<float>(film.light[static_cast<std::size_t>(band) * pixels + i] / samples);
  }
  result.samples_per_pixel = passes.taken(film.passes);
  result.rays = film.rays, result.passed = film.passed;
  if (!film.has_first_surfaces()) return result;
  FirstSurfaces& first = result.first_surfaces.emplace();
  first.depth.resize(pixels), first.normal.resize(3 * pixels), first.share.resize(pixels);
  first.albedo.resize(film.albedo.size());
  for (std::size_t i = 0; i < pixels; ++i) {
    const double met = film.met[i] > 0 ? film.met[i] : 1;
    first.share[i] = static_cast<float>(film.met[i] / result.samples_per_pixel);
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

/// Of the light of all bands.
double noise_now(const Film& film) {
  std::vector<double> whole(film.half.size(), 0.0);
  for (std::size_t i = 0; i < film.light.size(); ++i) whole[i % whole.size()] += film.light[i];
  return estimated_noise(film.window, whole, film.half, film.passes);
}

/// Renders one pass into the film.
void add_pass(const TileTask& task, const std::vector<PixelWindow>& tiles, const Passes& passes, Film& film,
              const std::function<void(double)>& told) {
  const std::vector<SampleRange> ranges = passes.ranges(film.passes);
  const bool half = !film.half.empty() && film.passes % 2 == 1;
  std::vector<TileResult> results(tiles.size());
  std::atomic<std::size_t> done{0};
  parallel_tasks(tiles.size(), [&](std::size_t i) {
    results[i] = render_tile(task, tiles[i], ranges, half, film);
    told(static_cast<double>(++done) / static_cast<double>(tiles.size()));
  });
  // In the order of the tiles, whoever finished first. Groups of wavelengths have no band in common.
  parallel_for(ranges.size(), [&](std::size_t group) {
    for (const TileResult& tile : results)
      for (const Stray& stray : tile.strays[group]) film.light[stray.at] += stray.light;
  });
  for (const TileResult& tile : results) {
    if (half)
      for (const std::vector<Stray>& strays : tile.strays)
        for (const Stray& stray : strays) film.half[stray.at % film.half.size()] += stray.light;
    film.rays += tile.rays, film.passed += tile.passed;
  }
  ++film.passes;
}

/// Whether rendering ends here; and how many passes it is likely to take.
struct Outlook {
  bool done = false;
  double likely_passes = 0;
  std::optional<double> noise;
};

Outlook outlook(const Film& film, const Passes& passes, double wanted_noise) {
  Outlook result{film.passes >= passes.count(), static_cast<double>(passes.count()), {}};
  // Equal halves, and enough of them.
  const int fewest = result.done ? 2 : fewest_passes;
  if (film.half.empty() || film.passes % 2 == 1 || film.passes < fewest) return result;
  const double noise = noise_now(film);
  result.noise = noise;
  result.done = result.done || noise <= wanted_noise;
  // Error falls with the root of the number of samples, or faster.
  if (!result.done)
    result.likely_passes =
        std::clamp(film.passes * std::pow(noise / wanted_noise, 2), film.passes + 2.0, result.likely_passes);
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
  Film film(window, static_cast<int>(world.groups.wavelengths_nm().size()), options.first_surfaces,
            options.noise > 0);
  const Passes passes(world.groups, options);
  const bool keeps = !options.checkpoint.empty();
  if (keeps && read_checkpoint(options.checkpoint, film, options.fingerprint) && film.passes > passes.full())
    throw InputError(options.checkpoint,
                     fmt::format("has {} samples a pixel; as many `samples_per_pixel` or more would be right",
                                 film.passes * indices_a_pass * world.groups.count()));

  const TileTask task{world, camera, world_from_camera, sensor, sampling, options};
  const std::vector<PixelWindow> tiles = tiles_of(window);
  const int resumed_at = film.passes;
  Outlook ahead = outlook(film, passes, options.noise);
  auto saved = std::chrono::steady_clock::now();
  std::optional<Film> full = keeps ? std::optional(film) : std::nullopt;  // after full passes alone
  int saved_passes = film.passes;
  const auto save = [&] {
    if (full->passes == saved_passes) return;
    write_checkpoint(options.checkpoint, *full, options.fingerprint);
    saved_passes = full->passes;
  };
  bool go_on = true;
  while (!ahead.done && go_on) {
    try {
      add_pass(task, tiles, passes, film, [&](double share) {
        // Of what this run has to do, so that the time left can be told.
        if (progress)
          progress((film.passes + share - resumed_at) / (ahead.likely_passes - resumed_at), "light");
      });
    } catch (const Cancelled&) {
      if (full && full->passes > 0) {
        save();
        if (options.so_far) options.so_far(developed(*full, world.groups, sensor, options.photosite, passes));
      }
      throw;
    }
    if (keeps && film.passes <= passes.full()) full = film;
    ahead = outlook(film, passes, options.noise);
    if (options.after_pass) go_on = options.after_pass(film.passes, passes.count());
    const auto now = std::chrono::steady_clock::now();
    const bool due = std::chrono::duration<double>(now - saved).count() >= options.checkpoint_seconds;
    if (keeps && (ahead.done || !go_on || due)) {
      save();
      saved = now;
    }
  }
  Rendering result = developed(film, world.groups, sensor, options.photosite, passes);
  result.complete = ahead.done;
  result.noise = ahead.noise;
  return result;
}

}  // namespace petzval::render
