// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/context.h>
#include <petzval/base/parallel.h>
#include <petzval/base/stop.h>
#include <petzval/render/denoise_picture.h>
#include <petzval/render/film/checkpoint.h>
#include <petzval/render/film/noise.h>
#include <petzval/render/passes.h>
#include <petzval/render/picture_so_far.h>
#include <petzval/render/renderer.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <span>

namespace petzval::render {

namespace {

constexpr int tile_side = 16;
/// Before so many passes an estimate of the noise is too uncertain to end at.
constexpr int fewest_passes = 4;

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

/// A piece of a picture, and where it ends with the picture a margin beyond it, whose light reaches in.
PixelWindow with_margin(const PixelWindow& piece, const PixelWindow& picture, int margin) {
  const auto beyond = [&](int at, int end, int by) { return at == end ? at + by : at; };
  return {beyond(piece.left, picture.left, -margin), beyond(piece.top, picture.top, -margin),
          beyond(piece.right, picture.right, margin), beyond(piece.bottom, picture.bottom, margin)};
}

/// \returns passes [first, last). \throws InputError.
std::array<int, 2> passes_of_piece(const FilmPiece& piece, const PixelWindow& whole, const Passes& passes,
                                   const WavelengthGroups& groups, const RenderOptions& options) {
  if (piece.is_whole()) return {0, passes.count()};
  if (options.noise > 0)
    throw InputError("`noise` is that of a whole picture; pieces are rendered with `samples_per_pixel`");
  if (const auto& region = piece.region;
      region && (region->left < whole.left || region->top < whole.top || region->right > whole.right ||
                 region->bottom > whole.bottom || region->columns() < 1 || region->rows() < 1))
    throw InputError(fmt::format("`region` is not within the picture, pixels {},{} to {},{}", whole.left,
                                 whole.top, whole.right - 1, whole.bottom - 1));
  const int each = samples_a_pass(groups), most = effective_samples(groups, options.samples_per_pixel);
  // A last pass of fewer samples is not kept in checkpoints; who has all pieces makes it.
  if (passes.full() == 0)
    throw InputError(fmt::format("`samples_per_pixel` {}: pieces have {} or more", most, each));
  if (!piece.samples) return {0, passes.full()};
  const auto [first, last] = *piece.samples;
  const int kept = passes.full() * each;
  if (first < 0 || last <= first || last > kept || first % each != 0 || last % each != 0)
    throw InputError(fmt::format("`sample_range` {}:{}: multiples of {} from 0 to {} would be right", first,
                                 last, each, kept));
  return {first / each, last / each};
}

Film::Half half_of(const RenderOptions& options) {
  if (options.denoise) return Film::Half::all;
  return options.noise > 0 ? Film::Half::sum_of_bands : Film::Half::none;
}

/// Of the light of all bands.
double noise_now(const Film& film) {
  std::vector<double> whole(film.window.size(), 0.0), half(film.window.size(), 0.0);
  for (std::size_t i = 0; i < film.light.size(); ++i) whole[i % whole.size()] += film.light[i].value();
  for (std::size_t i = 0; i < film.half.size(); ++i) half[i % half.size()] += film.half[i].value();
  return estimated_noise(film.window, whole, half, film.passes);
}

/// Renders one pass into the film. Where it is stopped, the tiles that are done have it, and `results` tell
/// which.
void add_pass(const TileTask& task, const std::vector<PixelWindow>& tiles, const Passes& passes, Film& film,
              std::vector<TileResult>& results, const std::function<void(double)>& told) {
  const std::vector<SampleRange> ranges = passes.ranges(film.end_pass());
  const bool half = !film.half.empty() && film.passes % 2 == 1;
  results.assign(tiles.size(), {});
  std::atomic<std::size_t> done{0};
  // Light that lands in other tiles waits for the end of so many: a few hundred megabytes where waves spread
  // it.
  constexpr std::size_t tiles_at_once = 1024;
  for (std::size_t begin = 0; begin < tiles.size(); begin += tiles_at_once) {
    const std::size_t count = std::min(tiles_at_once, tiles.size() - begin);
    parallel_tasks(count, [&](std::size_t i) {
      results[begin + i] = render_tile(task, tiles[begin + i], ranges, half, film);
      told(static_cast<double>(++done) / static_cast<double>(tiles.size()));
    });
    const std::span<TileResult> here(results.data() + begin, count);
    add_strays(here, ranges.size(), half, film);
    for (TileResult& result : here) {
      result = {};
      result.done = true;
    }
  }
  ++film.passes;
}

/// Whether rendering ends here; and how many passes it is likely to take.
struct Outlook {
  bool done = false;
  double likely_passes = 0;
  std::optional<double> noise;
};

/// \param before  the last one, which stands while the halves are not equal.
Outlook outlook(const Film& film, int wanted_passes, double wanted_noise, Outlook before) {
  Outlook result = before;
  result.done = film.passes >= wanted_passes;
  if (!result.noise) result.likely_passes = wanted_passes;
  if (wanted_noise <= 0 || film.passes % 2 == 1 || film.passes < 2) return result;
  const double noise = noise_now(film);
  result.noise = noise;
  result.done = result.done || (film.passes >= fewest_passes && noise <= wanted_noise);
  // Error falls with the root of the number of samples, or faster.
  if (!result.done)
    result.likely_passes = std::clamp(film.passes * std::pow(noise / wanted_noise, 2), film.passes + 2.0,
                                      static_cast<double>(wanted_passes));
  return result;
}

}  // namespace

int samples_a_pass(const WavelengthGroups& groups) {
  return Passes::indices_a_pass * groups.count();
}

int effective_samples(const WavelengthGroups& groups, int samples_per_pixel) {
  return std::max(samples_per_pixel, groups.count());
}

Rendering render_picture(const World& world, const FilmCamera& camera, const Transform& world_from_camera,
                         const SensorGeometry& sensor, const RenderOptions& options,
                         const ProgressCallback& progress) {
  if (options.samples_per_pixel < 1) throw InputError("a picture takes at least one sample a pixel");
  if (options.denoise && !options.piece.is_whole())
    throw InputError("`denoise_light` looks at a whole picture; pieces without it would be right");
  if (options.denoise && options.light_groups)
    throw InputError("`light_groups` are not denoised; without `denoise_light` would be right");
  const PixelWindow wanted = checked_window(sensor, options);
  const Passes passes(world.groups, options);
  const auto [first_pass, end_pass] = passes_of_piece(options.piece, wanted, passes, world.groups, options);
  const int wanted_passes = end_pass - first_pass;
  const PixelWindow shown = options.piece.region.value_or(wanted);
  const int margin = camera.waves() ? camera.waves()->margin_pixels() : 0;
  const PixelWindow window = with_margin(wanted, wanted, margin);
  Film film(with_margin(shown, wanted, margin), static_cast<int>(world.groups.wavelengths_nm().size()),
            world.groups.count(), options.first_surfaces || options.denoise, half_of(options),
            options.light_groups ? world.lights.sources.size() : 0);
  film.whole = window, film.first_pass = first_pass;
  const FilmSampling gathering(window, options.photosite);
  const FilmSampling everywhere = gathering.without_gaps();
  const bool gaps = camera.waves() && gathering.site_share() < 1;
  const bool keeps = !options.checkpoint.empty();
  if (keeps && read_checkpoint(options.checkpoint, film, options.fingerprint) &&
      film.end_pass() > passes.full())
    throw InputError(options.checkpoint,
                     fmt::format("has {} samples a pixel; as many `samples_per_pixel` or more would be right",
                                 film.end_pass() * passes.samples_a_pass()));

  const TileTask task{world,     camera, world_from_camera, sensor, gaps ? everywhere : gathering,
                      gathering, options};
  const auto raw_picture_of = [&](const Film& sums) {
    return picture_so_far(sums, world.groups, sensor, options.photosite, passes);
  };
  const auto picture_of = [&](const Film& sums) {
    Rendering picture = raw_picture_of(sums);
    if (options.denoise) denoise_picture(sums, world.groups, passes, picture);
    return cropped(std::move(picture), sums.window, shown);
  };
  const std::vector<PixelWindow> tiles = tiles_of(film.window);
  const int resumed_at = film.passes;
  Outlook ahead = outlook(film, wanted_passes, options.noise, {});
  auto saved = std::chrono::steady_clock::now();
  std::optional<Film> full = keeps ? std::optional(film) : std::nullopt;  // after full passes alone
  int saved_passes = film.passes;
  const auto save = [&] {
    if (full->passes == saved_passes) return;
    write_checkpoint(options.checkpoint, *full, options.fingerprint);
    saved_passes = full->passes;
  };
  const auto due = [](std::chrono::steady_clock::time_point since, double seconds) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count() >= seconds;
  };
  std::optional<std::chrono::steady_clock::time_point> previewed;
  std::vector<TileResult> results;
  bool go_on = true;
  while (!ahead.done && go_on) {
    const std::string what =
        ahead.noise ? fmt::format("light, noise {:.2g} of {:g}", *ahead.noise, options.noise) : "light";
    try {
      add_pass(task, tiles, passes, film, results, [&](double share) {
        // Of what this run has to do, so that the time left can be told.
        if (progress) progress((film.passes + share - resumed_at) / (ahead.likely_passes - resumed_at), what);
      });
    } catch (const Cancelled&) {
      const ListenerScope unhurried(nullptr);
      const bool kept = full && full->passes > 0;
      if (kept) save();
      std::optional<Rendering> picture = !options.so_far ? std::nullopt
                                         : kept          ? picture_of(*full)
                                                : picture_of_stopped_pass(tiles, results, film, world.groups,
                                                                          sensor, options.photosite, passes);
      if (picture) options.so_far(cropped(*std::move(picture), film.window, shown));
      throw;
    }
    if (keeps && film.end_pass() <= passes.full()) full = film;
    ahead = outlook(film, wanted_passes, options.noise, ahead);
    if (options.after_pass) go_on = options.after_pass(film.passes, wanted_passes);
    if (keeps && (ahead.done || !go_on || due(saved, options.checkpoint_seconds))) {
      save();
      saved = std::chrono::steady_clock::now();
    }
    if (options.preview && !ahead.done && (!previewed || due(*previewed, options.preview_seconds))) {
      options.preview(picture_of(film));
      previewed = std::chrono::steady_clock::now();
    }
  }
  Rendering result;
  try {
    result = picture_of(film);
  } catch (const Cancelled&) {
    if (options.so_far) options.so_far(cropped(raw_picture_of(film), film.window, shown));
    throw;
  }
  result.complete = ahead.done;
  result.noise = ahead.noise;
  return result;
}

}  // namespace petzval::render
