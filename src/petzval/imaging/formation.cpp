// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/cell_choice.h>
#include <petzval/imaging/coverage.h>
#include <petzval/imaging/field_of_view.h>
#include <petzval/imaging/formation.h>
#include <petzval/imaging/image_frame.h>
#include <petzval/imaging/positive_light.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <numeric>
#include <utility>

namespace petzval {

namespace {

void check_distances(const Scene& scene, const LensDataTable& table) {
  const std::optional<double> table_mm = object_to_sensor_mm(table);
  const auto say = [](std::optional<double> mm) {
    return mm ? fmt::format("{:.6g} m", *mm / mm_per_m) : "infinity";
  };
  std::optional<double> scene_mm = scene.distance_m();
  if (scene_mm) *scene_mm *= mm_per_m;
  constexpr double relative_tolerance = 1e-3;
  const bool agree = scene_mm && table_mm ? std::abs(*scene_mm - *table_mm) <= relative_tolerance * *table_mm
                                          : !scene_mm && !table_mm;
  if (!agree)
    throw InputError(
        fmt::format("the scene is at {}, but the lens data table was made for an object at {} from the "
                    "sensor; give the scene that distance, or build the table for the scene's",
                    say(scene_mm), say(table_mm)));
}

}  // namespace

/// How far all bands are, when several are formed at once.
class BandProgress {
 public:
  BandProgress(int bands, const ProgressCallback& callback)
      : callback_(callback), fraction_(static_cast<std::size_t>(bands)) {}

  void tell(std::size_t band, double fraction, const std::string& what) {
    if (!callback_) return;
    const std::lock_guard lock(mutex_);
    fraction_[band] = fraction;
    callback_(std::accumulate(fraction_.begin(), fraction_.end(), 0.0) / double(fraction_.size()), what);
  }

 private:
  const ProgressCallback& callback_;
  std::mutex mutex_;
  std::vector<double> fraction_;
};

namespace {

/// The same lights by rows of cells that pixels share in. \param further  cells that a pixel shares in beyond
/// its own, from its first on.
std::vector<AimedLight> on_cells(std::span<const AimedLight> lights, int cells_per_pixel, int further) {
  std::vector<AimedLight> on_cells(lights.begin(), lights.end());
  for (auto& [shares, rows] : on_cells) {
    rows.first *= cells_per_pixel;
    if (rows.end < (INT_MAX - further) / cells_per_pixel) rows.end = rows.end * cells_per_pixel + further;
  }
  return on_cells;
}

}  // namespace

Formation::Formation(const Scene& of_scene, const LensDataTable& of_table, const SensorGeometry& of_sensor,
                     const ImagingOptions& asked, bool keeps, FormationMemory* memory)
    : scene(of_scene),
      table(of_table),
      sensor(of_sensor),
      options(asked),
      may_keep(keeps),
      centres(checked()) {
  const CellChoice choice =
      choose_cells(scene, table, sensor, options, memory != nullptr ? &memory->detail : nullptr);
  options.supersample = choice.cells;
  contrast = choice.contrast;
  of_all.table_error = table.interpolation_error;
  of_all.sampling_error = choice.sampling_error;
  frame = options.cells_of(sensor);
  plans = plan_bands(scene, table, frame, options);
  of_all.scene_points_per_cell = points_per_cell(plans, frame);
  of_all.cells_per_pixel = options.cells_per_pixel();
  path = choice.path(of_all.scene_points_per_cell);
  taps = pixel_taps(options.photosite, of_all.cells_per_pixel, path);
}

const LensDataTable& Formation::checked() const {
  options.validate();
  scene.validate();
  table.validate();
  check_distances(scene, table);
  SpectralImage::check(sensor.columns, sensor.rows, scene.wavelengths_nm(), sensor.pitch_um);
  return table;
}

void Formation::form(std::span<const AimedLight> lights, const TakeBand& take,
                     const ProgressCallback& callback, ImagingReport& report, const BandShare& share) {
  report = of_all;
  check_aims(lights, report.notes);
  note_dark_corners(plans, sensor, report.notes);
  const auto start = std::chrono::steady_clock::now();
  if (places.empty()) {
    places.emplace_back(*this);
    const std::size_t wanted = may_keep && fits(plans.size()) ? plans.size() : places_at_once();
    while (places.size() < wanted) places.emplace_back(*this);
  }
  BandProgress progress(scene.bands(), callback);
  double seconds = 0;  // of all bands
  const auto end = [&](std::size_t band, std::size_t) {
    if (!share.has(band) && share.known) {
      CellPlane pixels = CellPlane::unset(sensor);
      share.known(static_cast<int>(band), pixels.values);
      place_of(band).pixels.push_back(std::move(pixels));
    }
    seconds += hand_over(band, take, progress, report);
  };
  parallel_stages(plans.size(), std::min(places.size(), static_cast<std::size_t>(thread_count())),
                  {[&](std::size_t band, std::size_t) {
                     begin(band, share.has(band) ? lights : std::span<const AimedLight>());
                   },
                   [&](std::size_t band, std::size_t) {
                     if (share.has(band)) work(band, lights, progress);
                   },
                   end});
  share_time(seconds_since(start), seconds, report);
  note_result(report);
  note_unused_layout(report);
}

void Formation::check_aims(std::span<const AimedLight> lights, std::vector<std::string>& notes) const {
  const SeenExtent seen = seen_extent(scene, table, sensor, options);
  for (const AimedLight& light : lights)
    for (const AimedLight::Share& share : light.shares) {
      share.aim.check(scene);
      check_coverage(scene, seen, options.surround, notes, share.aim);
    }
  notes.erase(std::unique(notes.begin(), notes.end()), notes.end());
}

bool Formation::fits(std::size_t count) const {
  constexpr double most_bytes = 1.25e9;
  constexpr int planes = 4;  // the light before and after blur, with room for the pixels
  const double of_planes = planes * double(frame.columns) * double(frame.rows) * sizeof(float);
  return double(count) * (places.front().blur.bytes() + of_planes) <= most_bytes;
}

std::size_t Formation::places_at_once() const {
  std::size_t count = std::min(static_cast<std::size_t>(thread_count()), plans.size());
  while (count > 1 && !fits(count)) --count;
  return count;
}

void Formation::choose(std::size_t band, Place& place) {
  const auto start = std::chrono::steady_clock::now();
  place.says = {};
  place.blur.choose(plans[band], scene.wavelengths_nm()[band], frame, last_plan);
  last_plan = place.blur.plan();
  place.chosen = band;
  place.seconds = place.says.blur_seconds = seconds_since(start);
}

std::size_t Formation::lights_at_once(std::size_t band) const {
  // Lights that look at the same rows in turn share what the lens makes of them.
  constexpr double most_bytes = 1e8;
  const SensorGeometry grid = grown(frame, plans[band].margin);
  return static_cast<std::size_t>(
      std::max(1.0, most_bytes / (double(grid.columns) * double(grid.rows) * sizeof(float))));
}

std::vector<CellPlane> Formation::ideal(std::size_t band, std::span<const AimedLight> lights) const {
  const BandPlan& plan = plans[band];
  // What a pixel's light may come from, after blur and before.
  const std::vector<AimedLight> on_source =
      on_cells(lights, taps.cells, taps.size() - taps.cells + 2 * plan.margin);
  return source_lights(scene, static_cast<int>(band), plan.map, grown(frame, plan.margin), path.source,
                       options.surround, on_source);
}

void Formation::begin(std::size_t band, std::span<const AimedLight> lights) {
  Place& place = place_of(band);
  place.ideal.clear();
  if (place.chosen == band) return;
  const auto some = lights.first(std::min(lights.size(), lights_at_once(band)));
  double light_seconds = 0;
  parallel_for(2, [&](std::size_t part) {
    if (part == 0) return choose(band, place);
    const auto start = std::chrono::steady_clock::now();
    if (!some.empty()) place.ideal = ideal(band, some);
    light_seconds = seconds_since(start);
  });
  place.says.distortion_seconds += light_seconds;
  place.seconds += light_seconds;
}

void Formation::work(std::size_t band, std::span<const AimedLight> lights, BandProgress& progress) {
  Place& place = place_of(band);
  const auto start = std::chrono::steady_clock::now();
  place.blur.make_kernels();
  place.says.blur_seconds += seconds_since(start);
  for (std::size_t i = 0; i < lights.size();) {
    const auto start_of_light = std::chrono::steady_clock::now();
    const auto some = lights.subspan(i, std::min(lights_at_once(band), lights.size() - i));
    std::vector<CellPlane> before = std::exchange(place.ideal, {});
    if (before.empty()) before = ideal(band, some);
    place.says.distortion_seconds += seconds_since(start_of_light);
    const auto start_of_blur = std::chrono::steady_clock::now();
    for (CellPlane& light : before) {
      CellPlane blurred = place.blur(std::move(light), [&](double fraction, const std::string& what) {
        progress.tell(band, (double(i) + fraction) / double(lights.size()), what);
      });
      place.pixels.push_back(without_negative_light(gathered(std::move(blurred), taps, lights[i++].rows)));
    }
    place.says.blur_seconds += seconds_since(start_of_blur);
  }
  place.seconds += seconds_since(start);
}

double Formation::hand_over(std::size_t band, const TakeBand& take, BandProgress& progress,
                            ImagingReport& report) {
  Place& place = place_of(band);
  const auto start = std::chrono::steady_clock::now();
  for (const CellPlane& pixels : place.pixels) {
    take(pixels.values);
  }
  place.pixels.clear();
  scene.release_memory();
  place.says.margin_cells = plans[band].margin;
  place.says.least_captured = plans[band].least_captured;
  add_report(place.says, report);
  progress.tell(band, 1, "image");
  const double seconds = place.seconds + seconds_since(start);
  // What was chosen may serve again; time goes by anew.
  place.seconds = place.says.distortion_seconds = place.says.blur_seconds = place.says.kernel_seconds = 0;
  return seconds;
}

void Formation::share_time(double seconds, double of_bands, ImagingReport& report) {
  if (of_bands <= seconds) return;
  for (double* of_step : {&report.distortion_seconds, &report.blur_seconds, &report.kernel_seconds})
    *of_step *= seconds / of_bands;
}

void Formation::note_unused_layout(ImagingReport& report) const {
  const ProductPlan& product = report.product;
  if ((options.product.nodes != 0 || options.product.tile != 0) && product.tile != 0 && !product.direct &&
      product.transform == 0)
    report.notes.push_back(fmt::format(
        "`nodes` and `tile` had no effect: tiles as asked for do not go into the transforms beside these "
        "PSFs, or serve the tolerance; sections of {0} x {0} cells that fade into each other took their "
        "place",
        product.tile));
}

}  // namespace petzval
