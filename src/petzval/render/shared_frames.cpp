// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/render/camera/pupil_etendue.h>
#include <petzval/render/shared_frames.h>
#include <petzval/render/shared_tile.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace petzval::render {

namespace {

constexpr int shared_tile_side = 16;
/// Boxes of so many tiles wait to be added: tens of megabytes.
constexpr std::size_t shared_tiles_at_once = 32;
constexpr int halves = 2;
/// Paths from all frames that do the work of one of a frame's own: they come less evenly. Measured, see
/// bench/focus_pull.py.
constexpr double paths_for_one = 1.5;
/// Of a pixel: fewer do not tell the radiance that the other half is corrected with.
constexpr double fewest_of_half = 3;
constexpr double most_shared_bytes = 17179869184.0;  // 16 GiB

using Cells = std::vector<SharedCell>;

std::vector<PixelWindow> shared_tiles(const PixelWindow& window) {
  std::vector<PixelWindow> tiles;
  for (int top = window.top; top < window.bottom; top += shared_tile_side)
    for (int left = window.left; left < window.right; left += shared_tile_side)
      tiles.push_back({left, top, std::min(left + shared_tile_side, window.right),
                       std::min(top + shared_tile_side, window.bottom)});
  return tiles;
}

/// Frames on their way.
class SharedFrames {
 public:
  SharedFrames(const SharedTask& task, const PixelWindow& window, const ProgressCallback& progress)
      : task_(task),
        window_(window),
        progress_(progress),
        tiles_(shared_tiles(window)),
        paths_(shared_paths(groups(), task.options.samples_per_pixel, frames())),
        lamps_(task.cameras.size(), std::vector<double>(window.size(), 0.0)),
        light_(lamps_),
        arriving_(groups().wavelengths_nm().size(), 0.0) {
    const double corner_mm = task.sensor.half_diagonal_mm();
    for (const LensCamera& camera : task.cameras) etendues_.emplace_back(camera, groups(), corner_mm);
    for (int i = 0; i < frames(); ++i) {
      Rendering& picture = pictures_.emplace_back();
      const Photosite& site = task.options.photosite;
      picture.irradiance =
          SpectralImage(window.columns(), window.rows(), groups().wavelengths_nm(), task.sensor.pitch_um,
                        site.is_plain() ? PixelAperture::box : PixelAperture::photosite);
      if (!site.is_plain()) picture.irradiance.photosite = site.text();
      picture.samples_per_pixel = task.options.samples_per_pixel;
    }
  }

  std::vector<Rendering> run() {
    for (int group = 0; group < groups().count(); ++group) {
      std::array<std::vector<Cells>, halves> sums;
      for (int half = 0; half < halves; ++half) sums[static_cast<std::size_t>(half)] = sums_of(group, half);
      parallel_tasks(task_.cameras.size(),
                     [&](std::size_t frame) { put(group, frame, sums[0][frame], sums[1][frame]); });
    }
    for (std::size_t frame = 0; frame < task_.cameras.size(); ++frame) finish(frame);
    return std::move(pictures_);
  }

 private:
  const WavelengthGroups& groups() const { return task_.world.groups; }
  int frames() const { return static_cast<int>(task_.cameras.size()); }

  /// Light of one half of the paths of a group, [frame][pixel].
  std::vector<Cells> sums_of(int group, int half) {
    std::vector<Cells> sums(task_.cameras.size(), Cells(window_.size()));
    const auto number = static_cast<std::uint32_t>(group * halves + half);
    const SharedSamples samples{
        group, paths_.own, paths_.every,
        GroupSamples::of(groups(), group, task_.options.seed, static_cast<std::uint32_t>(half) + 1)};
    std::atomic<std::size_t> done{0};
    for (std::size_t begin = 0; begin < tiles_.size(); begin += shared_tiles_at_once) {
      std::vector<SharedTileResult> results(std::min(shared_tiles_at_once, tiles_.size() - begin));
      parallel_tasks(results.size(), [&](std::size_t i) {
        results[i] = share_tile(task_, tiles_[begin + i], samples);
        if (progress_)
          progress_((number + static_cast<double>(begin + ++done) / static_cast<double>(tiles_.size())) /
                        (halves * groups().count()),
                    "light");
      });
      done = 0;
      // Tile by tile in their order, so that sums of floats are the same for any number of threads.
      parallel_tasks(sums.size(), [&](std::size_t frame) {
        for (const SharedTileResult& result : results) gather(frame, result.frames[frame], sums[frame]);
      });
      for (const SharedTileResult& result : results)
        for (int lane = 0; lane < groups().lanes(group); ++lane)
          arriving_[static_cast<std::size_t>(groups().band(group, lane))] +=
              result.arriving[static_cast<std::size_t>(lane)];
    }
    return sums;
  }

  void gather(std::size_t frame, const SharedBox& box, Cells& sums) {
    for (int row = box.window.top; row < box.window.bottom; ++row) {
      const SharedCell* from = box.cells.data() + box.window.index(box.window.left, row);
      SharedCell* to = sums.data() + window_.index(box.window.left, row);
      for (int column = 0; column < box.window.columns(); ++column) {
        to[column].light += from[column].light;
        to[column].field += from[column].field;
      }
    }
    for (const auto& [pixel, light] : box.lamps)
      lamps_[frame][window_.index(pixel.column, pixel.row)] += static_cast<double>(light);
    pictures_[frame].rays += box.rays, pictures_[frame].passed += box.passed;
  }

  /// The bands of a group, from the two halves of its paths.
  void put(int group, std::size_t frame, const Cells& a, const Cells& b) {
    const PupilEtendue& etendue = etendues_[frame];
    for (int row = window_.top; row < window_.bottom; ++row)
      for (int column = window_.left; column < window_.right; ++column) {
        const std::size_t at = window_.index(column, row);
        const PupilEtendue::Place place =
            etendue.place(task_.sensor.x_mm(column + 0.5), task_.sensor.y_mm(row + 0.5));
        for (int lane = 0; lane < groups().lanes(group); ++lane) {
          const PupilEtendue::Value field = etendue.at(group, lane, place);
          const double value = light_of_pixel(a[at], b[at], lane, field);
          pictures_[frame].irradiance.band(groups().band(group, lane))[at] = static_cast<float>(value);
          light_[frame][at] += value;
        }
      }
  }

  static double light_of_pixel(const SharedCell& a, const SharedCell& b, int lane,
                               const PupilEtendue::Value& field) {
    const double value = (corrected(a, b, lane, field) + corrected(b, a, lane, field)) / 2;
    // One bright path among few: what is taken away with it may be more than there is.
    if (value >= 0) return value;
    return (static_cast<double>(a.light[lane]) + static_cast<double>(b.light[lane])) / 2;
  }

  /// \param other  of paths that are independent.
  static double corrected(const SharedCell& half, const SharedCell& other, int lane,
                          const PupilEtendue::Value& etendue) {
    const auto light = static_cast<double>(half.light[lane]);
    if (!etendue.exact || !(other.field[lane] > 0)) return light;
    const double radiance = static_cast<double>(other.light[lane]) / static_cast<double>(other.field[lane]);
    return light - radiance * (static_cast<double>(half.field[lane]) - etendue.sr);
  }

  void finish(std::size_t frame) {
    SpectralImage& image = pictures_[frame].irradiance;
    std::vector<std::uint8_t> lamps(window_.size());
    // Of two halves, whose mean is the light.
    for (std::size_t i = 0; i < lamps.size(); ++i)
      lamps[i] = lamps_[frame][i] / halves > light_[frame][i] / 2 ? 1 : 0;
    if (std::ranges::count(lamps, 1) > 0) image.lamps = std::move(lamps);
    std::vector<double> light = arriving_;
    const double most = *std::ranges::max_element(light);
    if (light.size() < 2 || !(most > 0)) return;
    for (double& value : light) value /= most;
    image.illuminant = Spectrum(groups().wavelengths_nm(), light);
  }

  const SharedTask& task_;
  PixelWindow window_;
  const ProgressCallback& progress_;
  std::vector<PixelWindow> tiles_;
  SharedPaths paths_;
  std::vector<PupilEtendue> etendues_;
  std::vector<std::vector<double>> lamps_, light_;  ///< [frame][pixel], summed over bands
  std::vector<double> arriving_;
  std::vector<Rendering> pictures_;
};

void require_shareable(const RenderOptions& options) {
  const auto refuse = [](bool given, const char* what) {
    if (given)
      throw InputError(fmt::format("frames that share paths have no {}; without it would be right", what));
  };
  refuse(options.noise > 0, "`noise` to end at");
  refuse(options.denoise, "`denoise_light`");
  refuse(options.first_surfaces, "depth, normals and albedo");
  refuse(options.light_groups, "`light_groups`");
  refuse(options.motion.has_value(), "camera that moves");
  refuse(!options.checkpoint.empty(), "`checkpoint`");
  refuse(!options.piece.is_whole(), "pieces");
}

}  // namespace

SharedPaths shared_paths(const WavelengthGroups& groups, int samples_per_pixel, int frames) {
  const double wanted =
      std::max(fewest_of_half, paths_for_one * samples_per_pixel / (halves * groups.count()));
  if (wanted > frames) return {static_cast<int>(std::ceil(wanted / frames)), 1};
  return {1, static_cast<int>(frames / wanted)};
}

double shared_frames_bytes(const WavelengthGroups& groups, const PixelWindow& window, int frames) {
  const double of_pixel = halves * sizeof(SharedCell) + 2 * sizeof(double) +
                          sizeof(float) * static_cast<double>(groups.wavelengths_nm().size());
  return of_pixel * static_cast<double>(window.size()) * frames;
}

std::vector<Rendering> render_shared_frames(const World& world, std::span<const LensCamera> cameras,
                                            const Transform& world_from_camera, const SensorGeometry& film,
                                            const RenderOptions& options, const ProgressCallback& progress) {
  if (cameras.empty()) throw InputError("no frames; one at least would be right");
  require_shareable(options);
  const PixelWindow window = options.window.value_or(PixelWindow{0, 0, film.columns, film.rows});
  if (film.columns > most_shared_side || film.rows > most_shared_side)
    throw InputError(
        fmt::format("frames that share paths have at most {} columns and rows", most_shared_side));
  const double bytes = shared_frames_bytes(world.groups, window, static_cast<int>(cameras.size()));
  if (bytes > most_shared_bytes)
    throw InputError(
        fmt::format("{} frames of {} x {} pixels and {} bands need {:.0f} GiB to share paths; "
                    "fewer frames, pixels or bands would fit",
                    cameras.size(), window.columns(), window.rows(), world.groups.wavelengths_nm().size(),
                    bytes / 1073741824));
  const FilmSampling sampling(window, options.photosite);
  const SharedTask task{world, cameras, world_from_camera, film, sampling, options};
  return SharedFrames(task, window, progress).run();
}

}  // namespace petzval::render
