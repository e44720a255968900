// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/band_blur.h>
#include <petzval/imaging/cell_choice.h>
#include <petzval/imaging/coverage.h>
#include <petzval/imaging/image_frame.h>
#include <petzval/imaging/lens_corrections.h>
#include <petzval/imaging/positive_light.h>
#include <petzval/sensor/lens_facts.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <deque>
#include <mutex>
#include <numeric>
#include <optional>
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

/// The bands of one image, some of them at a time.
class BandByBand {
 public:
  BandByBand(const Scene& scene, const LensDataTable& table, const SensorGeometry& frame,
             const ImagingOptions& options, const std::vector<BandPlan>& plans, const LightPath& path,
             const ProgressCallback& progress, ImagingReport& report, std::span<const SceneAim> aims,
             const TakeBand& take, const SensorGeometry& sensor, const BandShare& share)
      : scene_(scene),
        table_(table),
        centres_(table),
        frame_(frame),
        options_(options),
        plans_(plans),
        path_(path),
        taps_(pixel_taps(options.photosite, options.cells_per_pixel(), path)),
        progress_(scene.bands(), progress),
        report_(report),
        aims_(aims),
        take_(take),
        sensor_(sensor),
        share_(share) {}

  void form() {
    const auto start = std::chrono::steady_clock::now();
    choose(0, places_.emplace_back(table_, centres_, options_));
    while (places_.size() < places_wanted()) places_.emplace_back(table_, centres_, options_);
    parallel_stages(plans_.size(), places_.size(),
                    {[&](std::size_t band, std::size_t place) {
                       if (band > 0) choose(band, places_[place]);
                     },
                     [&](std::size_t band, std::size_t place) { work(band, places_[place]); },
                     [&](std::size_t band, std::size_t place) { end(band, places_[place]); }});
    share_time(seconds_since(start));
  }

 private:
  /// Where one band after the other is formed, using the same memory.
  struct Place {
    Place(const LensDataTable& table, const LightCentres& centres, const ImagingOptions& options)
        : blur(table, centres, options, says) {}
    ImagingReport says;
    BandBlur blur;
    std::vector<CellPlane> pixels;  ///< of each aim
    double seconds = 0;
  };

  /// As many bands at a time as threads and memory allow, going by the first.
  std::size_t places_wanted() const {
    constexpr double most_bytes = 1.25e9, psf_bytes = 64e6;
    constexpr int planes = 4;  // the light before and after blur, with room for the pixels
    const std::optional<ProductPlan>& plan = places_.front().blur.plan();
    const double bytes = (plan ? plan->kernel_bytes : 0) + psf_bytes +
                         planes * double(frame_.columns) * double(frame_.rows) * sizeof(float);
    const auto by_memory = static_cast<std::size_t>(std::max(1.0, most_bytes / bytes));
    return std::min({by_memory, static_cast<std::size_t>(thread_count()), plans_.size()});
  }

  void choose(std::size_t band, Place& place) {
    const auto start = std::chrono::steady_clock::now();
    place.says = {};
    const int margin = plans_[band].margin;
    place.blur.choose(scene_.wavelengths_nm()[band], grown(frame_, margin), margin, last_plan_);
    last_plan_ = place.blur.plan();
    place.seconds = place.says.blur_seconds = seconds_since(start);
  }

  void work(std::size_t band, Place& place) {
    if (!share_.has(band)) return;
    const BandPlan& plan = plans_[band];
    const auto start = std::chrono::steady_clock::now();
    place.blur.make_kernels();
    place.says.blur_seconds += seconds_since(start);
    for (std::size_t i = 0; i < aims_.size(); ++i) {
      const auto start_of_light = std::chrono::steady_clock::now();
      CellPlane ideal = source_light(scene_, static_cast<int>(band), plan.map, grown(frame_, plan.margin),
                                     path_.source, options_.surround, aims_[i]);
      place.says.distortion_seconds += seconds_since(start_of_light);
      const auto start_of_blur = std::chrono::steady_clock::now();
      CellPlane blurred = place.blur(std::move(ideal), [&](double fraction, const std::string& what) {
        progress_.tell(band, (double(i) + fraction) / double(aims_.size()), what);
      });
      place.says.blur_seconds += seconds_since(start_of_blur);
      place.pixels.push_back(without_negative_light(gathered(std::move(blurred), taps_)));
    }
    place.seconds += seconds_since(start);
  }

  void end(std::size_t band, Place& place) {
    const auto start = std::chrono::steady_clock::now();
    if (!share_.has(band) && share_.known) {
      CellPlane pixels = CellPlane::unset(sensor_);
      share_.known(static_cast<int>(band), pixels.values);
      place.pixels.push_back(std::move(pixels));
    }
    for (const CellPlane& pixels : place.pixels) {
      note_extremes(pixels, static_cast<int>(band), report_);
      take_(pixels.values);
    }
    place.pixels.clear();
    scene_.release_memory();
    place.says.margin_cells = plans_[band].margin;
    place.says.least_captured = plans_[band].least_captured;
    add_report(place.says, report_);
    progress_.tell(band, 1, "image");
    seconds_ += place.seconds + seconds_since(start);
  }

  void share_time(double seconds) {
    if (seconds_ <= seconds) return;
    for (double* of_step : {&report_.distortion_seconds, &report_.blur_seconds, &report_.kernel_seconds})
      *of_step *= seconds / seconds_;
  }

  const Scene& scene_;
  const LensDataTable& table_;
  const LightCentres centres_;
  const SensorGeometry& frame_;
  const ImagingOptions& options_;
  const std::vector<BandPlan>& plans_;
  const LightPath path_;
  const PixelTaps taps_;
  BandProgress progress_;
  ImagingReport& report_;
  std::span<const SceneAim> aims_;
  const TakeBand& take_;
  const SensorGeometry& sensor_;
  const BandShare& share_;
  std::deque<Place> places_;
  std::optional<ProductPlan> last_plan_;
  double seconds_ = 0;  ///< of all bands
};

}  // namespace

SectionOptions ImagingOptions::section_options() const {
  return {sections.section, sections.transform, method == BlurMethod::blended};
}

SensorGeometry ImagingOptions::cells_of(const SensorGeometry& sensor) const {
  const int cells = cells_per_pixel();
  return grown(subdivided(sensor, cells), taps_reach(photosite, cells, method == BlurMethod::none));
}

LightPath ImagingOptions::light_path(int points) const {
  constexpr int least_parts = 2;  // a plain mean over a cell would leave too much beyond its frequency
  if (method == BlurMethod::none) return {SourceFilter(1), false};
  return {SourceFilter(std::max(least_parts, points)), true};
}

void ImagingOptions::validate() const {
  constexpr int most = 16;
  if (supersample < 0 || supersample > most)
    throw InputError(fmt::format("supersampling of {}: 1 to {} is right, or 0 to choose", supersample, most));
  check_photosite(photosite);
  product.validate();
  if (by_sections()) transform_size({sections.section, 0, method == BlurMethod::blended}, 0);
}

namespace {

/// \param take  is handed each band of every aim, then the next band.
void form_aimed_bands(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                      const ImagingOptions& asked, std::span<const SceneAim> aims, const TakeBand& take,
                      const ProgressCallback& progress, ImagingReport* report, const BandShare& share) {
  ImagingReport own;
  ImagingReport& says = report != nullptr ? *report : own;
  says = {};

  // Everything that can be refused is refused before the work starts.
  asked.validate();
  scene.validate();
  table.validate();
  check_distances(scene, table);
  for (const SceneAim& aim : aims) aim.check(scene);
  SpectralImage::check(sensor.columns, sensor.rows, scene.wavelengths_nm(), sensor.pitch_um);
  const CellChoice choice = choose_cells(scene, table, sensor, asked);
  ImagingOptions options = asked;
  options.supersample = choice.cells;
  says.sampling_error = choice.sampling.error;
  says.finer_detail_error = choice.sampling.finer;
  const SensorGeometry frame = options.cells_of(sensor);
  const std::vector<BandPlan> plans = plan_bands(scene, table, frame, options);
  for (const SceneAim& aim : aims) check_coverage(scene, plans, frame, options.surround, says.notes, aim);
  note_dark_corners(plans, sensor, says.notes);
  says.scene_points_per_cell = points_per_cell(plans, frame);

  says.cells_per_pixel = options.cells_per_pixel();
  const LightPath path = options.light_path(says.scene_points_per_cell);
  BandByBand(scene, table, frame, options, plans, path, progress, says, aims, take, sensor, share).form();
  note_result(says);
  const ProductPlan& product = says.product;
  if ((asked.product.nodes != 0 || asked.product.tile != 0) && product.tile != 0 && !product.direct &&
      product.transform == 0)
    says.notes.push_back(fmt::format(
        "`nodes` and `tile` had no effect: tiles as asked for do not go into the transforms beside these "
        "PSFs, or "
        "serve the tolerance; sections of {0} x {0} cells that fade into each other took their place",
        product.tile));
}

}  // namespace

void form_bands(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                const ImagingOptions& options, const TakeBand& take, const ProgressCallback& progress,
                ImagingReport* report, const BandShare& share) {
  const SceneAim straight;
  form_aimed_bands(scene, table, sensor, options, std::span(&straight, 1), take, progress, report, share);
}

std::vector<SpectralImage> form_aimed_images(const Scene& scene, const LensDataTable& table,
                                             const SensorGeometry& sensor, const ImagingOptions& options,
                                             std::span<const SceneAim> aims, ImagingReport* report) {
  std::vector<SpectralImage> images;
  std::size_t planes = 0;
  const auto put = [&](std::span<const float> pixels) {
    if (images.empty()) images.assign(aims.size(), blank_image(scene, sensor, options));
    images[planes % aims.size()].store_band(static_cast<int>(planes / aims.size()), pixels);
    ++planes;
  };
  form_aimed_bands(scene, table, sensor, options, aims, put, {}, report, {});
  for (SpectralImage& image : images) {
    image.lens = lens_facts(table.lens_name, table.first_order);
    add_corrections(*image.lens, table, sensor);
  }
  return images;
}

SpectralImage form_image(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                         const ImagingOptions& options, const ProgressCallback& progress,
                         ImagingReport* report, const BandShare& share) {
  // What does not fit is refused before there is room for an image.
  std::optional<SpectralImage> image;
  int bands = 0;
  const auto put = [&](std::span<const float> pixels) {
    if (!image) image = blank_image(scene, sensor, options);
    image->store_band(bands++, pixels);
    image->release_memory();
  };
  form_bands(scene, table, sensor, options, put, progress, report, share);
  image->lens = lens_facts(table.lens_name, table.first_order);
  add_corrections(*image->lens, table, sensor);
  return std::move(*image);
}

}  // namespace petzval
