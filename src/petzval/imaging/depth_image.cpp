// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/band_blur.h>
#include <petzval/imaging/cell_choice.h>
#include <petzval/imaging/coverage.h>
#include <petzval/imaging/depth_image.h>
#include <petzval/imaging/field_of_view.h>
#include <petzval/imaging/image_frame.h>
#include <petzval/imaging/layer_plan.h>
#include <petzval/imaging/layer_stack.h>
#include <petzval/imaging/positive_light.h>
#include <petzval/lens/first_order.h>
#include <petzval/sensor/lens_facts.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

namespace petzval {

namespace {

/// What a distance is, in words.
std::string named_distance(std::optional<double> distance_m) {
  return distance_m ? fmt::format("{:.4g} m", *distance_m) : "infinity";
}

/// Everything that the layers of one image share.
class DepthImaging {
 public:
  DepthImaging(const Scene& scene, const DepthCamera& camera, const SensorGeometry& sensor,
               const ImagingOptions& options, const DepthOptions& depth, const ProgressCallback& progress,
               DepthReport& report, const BandShare& share)
      : scene_(scene),
        camera_(camera),
        share_(share),
        progress_(progress),
        report_(report),
        law_(camera.lens),
        sensor_(sensor),
        layers_(lay_depth_layers(scene, camera.lens, law_, sensor.pitch_um, depth)),
        options_(with_cells(options)),
        frame_(options_.cells_of(sensor)) {
    report_.layers = layers_.layers;
    report_.pupil_to_sensor_mm = law_.pupil_to_sensor_mm();
    if (const auto m = scene.distance_m(); m && *m * mm_per_m <= law_.pupil_to_sensor_mm())
      throw InputError(
          fmt::format("the scene is {} m from the sensor, but the entrance pupil {:.4g} m: its "
                      "angle belongs to no plane in front of the lens",
                      *m, law_.pupil_to_sensor_mm() / mm_per_m));
  }

  /// The two ends of the scene, where blur is largest, tell whether the frame is covered.
  void look_at_ends() {
    for (const std::size_t layer : {layers_.layers.size() - 1, std::size_t{0}}) {
      if (layer + 1 != layers_.layers.size() && layers_.layers.size() == 1) continue;
      if (!ends_.contains(layer)) ends_.emplace(layer, table_of(layer, options_));
      const LensDataTable& table = ends_.at(layer);
      const LayerScene planar(scene_, layers_, layer, law_.pupil_to_sensor_mm(), sensor_.pitch_um);
      const std::vector<BandPlan> plans = plan_layer(scene_, planar, table, frame_, options_);
      std::vector<std::string> notes;
      const Scene blank = planar.blank(scene_.wavelengths_nm().front());
      check_coverage(blank, seen_extent(blank, table, sensor_, options_), options_.surround, notes);
      if (notes.empty()) note_dark_corners(plans, sensor_, notes);
      for (const std::string& note : notes)
        says().notes.push_back(
            fmt::format("layer at {}: {}", named_distance(layers_.layers[layer].distance_m), note));
      says().scene_points_per_cell = std::max(says().scene_points_per_cell, points_per_cell(plans, frame_));
    }
    says().cells_per_pixel = options_.cells_per_pixel();
    path_ = choice_.path(says().scene_points_per_cell);
    taps_ = pixel_taps(options_.photosite, options_.cells_per_pixel(), path_);
  }

  /// The pixels of all bands of the share, nothing of others. Layers hide each other pixel by pixel.
  std::vector<std::optional<CellPlane>> planes() {
    LayerStack stack(sensor_, scene_.bands());
    for (layer_ = 0; layer_ < layers_.layers.size(); ++layer_)
      if (layers_.layers[layer_].share > 0) add_layer(stack);
    return std::move(stack).planes();
  }

 private:
  ImagingReport& says() { return report_.image; }

  /// The options with the cells that the largest layer needs; its table is kept for when its turn comes.
  ImagingOptions with_cells(ImagingOptions options) {
    const auto largest =
        std::max_element(layers_.layers.begin(), layers_.layers.end(),
                         [](const DepthLayer& a, const DepthLayer& b) { return a.share < b.share; });
    const auto layer = static_cast<std::size_t>(largest - layers_.layers.begin());
    const LensDataTable& table = ends_.emplace(layer, table_of(layer, options)).first->second;
    const LayerScene planar(scene_, layers_, layer, law_.pupil_to_sensor_mm(), sensor_.pitch_um);
    choice_ = choose_cells(planar.light(scene_.bands() / 2), table, sensor_, options);
    options.supersample = choice_.cells;
    says().sampling_error = choice_.sampling_error;
    return options;
  }

  LensDataTable table_of(std::size_t layer, const ImagingOptions& options) const {
    return layer_table(camera_, layers_, layer, sensor_.pitch_um, options.product.tolerance,
                       [&](double fraction, const std::string& what) { tell(0.5 * fraction, what); });
  }

  void add_layer(LayerStack& stack) {
    const auto end = ends_.extract(layer_);
    const LensDataTable table = end ? std::move(end.mapped()) : table_of(layer_, options_);
    const LayerScene planar(scene_, layers_, layer_, law_.pupil_to_sensor_mm(), sensor_.pitch_um);
    const std::vector<BandPlan> plans = plan_layer(scene_, planar, table, frame_, options_);
    const LightCentres centres(table);
    BandBlur blur(table, centres, options_, says(), 0);  // of a layer most is dark
    for (int band = 0; band < scene_.bands(); ++band) {
      const BandPlan& plan = plans[static_cast<std::size_t>(band)];
      says().margin_cells = std::max(says().margin_cells, plan.margin);
      says().least_captured = std::min(says().least_captured, plan.least_captured);
      const double wavelength_nm = scene_.wavelengths_nm()[static_cast<std::size_t>(band)];
      const auto start = std::chrono::steady_clock::now();
      // All bands are planned, for the plan of one follows that of the one before.
      blur.choose(plan, wavelength_nm, frame_, band == 0 ? hint_of_last_layer(plan.margin) : blur.plan());
      if (band == 0) keep_plan(blur.plan(), plan.margin);
      if (share_.has(static_cast<std::size_t>(band))) add_band(planar, band, plan, blur, stack);
      says().blur_seconds += seconds_since(start);
      tell(0.5 + 0.5 * (band + 1.0) / scene_.bands(), "image");
    }
  }

  void add_band(const LayerScene& planar, int band, const BandPlan& plan, BandBlur& blur, LayerStack& stack) {
    const double wavelength_nm = scene_.wavelengths_nm()[static_cast<std::size_t>(band)];
    const SensorGeometry grid = grown(frame_, plan.margin);
    blur.make_kernels();
    const auto imaged = [&](const Scene& scene, Surround surround) {
      const auto start_of_ideal = std::chrono::steady_clock::now();
      CellPlane ideal = source_light(scene, 0, plan.map, grid, path_.source, surround);
      says().distortion_seconds += seconds_since(start_of_ideal);
      return gathered(blur(std::move(ideal)), taps_);
    };
    BlurredLayer layer;
    layer.light = imaged(planar.light(band), options_.surround);
    if (!planar.is_everything()) {
      // Darkness around the scene is nothing that could be hidden: it belongs to the farthest layer.
      layer.white = imaged(planar.white(wavelength_nm), Surround::extend);
      if (planar.anything_hidden()) layer.unknown = imaged(planar.unknown(wavelength_nm), options_.surround);
      if (!stack.is_empty(band)) layer.share = imaged(planar.share(wavelength_nm), options_.surround);
    }
    stack.add(band, std::move(layer));
  }

  /// Blur changes little from a layer to the next. Where it is another by half than where a plan was made, a
  /// better one may be had.
  std::optional<ProductPlan> hint_of_last_layer(int margin) const {
    constexpr double alike = 1.5;
    const double change = double(margin) / double(planned_margin_);
    return kept_ && change < alike && change > 1 / alike ? kept_ : std::nullopt;
  }
  void keep_plan(std::optional<ProductPlan> plan, int margin) {
    const bool is_kept = kept_ && plan && plan->tile == kept_->tile && plan->nodes == kept_->nodes;
    if (!is_kept) planned_margin_ = std::max(1, margin);
    if (plan) plan->transform = 0;
    kept_ = std::move(plan);
  }

  void tell(double fraction, const std::string& what) const {
    if (progress_) progress_((double(layer_) + fraction) / double(layers_.layers.size()), what);
  }

  const Scene& scene_;
  const DepthCamera& camera_;
  const BandShare& share_;
  const ProgressCallback& progress_;
  DepthReport& report_;
  const DefocusLaw law_;
  const SensorGeometry sensor_;
  const DepthLayers layers_;
  std::map<std::size_t, LensDataTable> ends_;  ///< tables of the farthest, the nearest and the largest layer
  std::size_t layer_ = 0;                      ///< at work
  std::optional<ProductPlan> kept_;            ///< of the last layer's first band
  int planned_margin_ = 1;                     ///< of the layer where its tiles were chosen
  CellChoice choice_;                          ///< of the largest layer
  const ImagingOptions options_;
  const SensorGeometry frame_;
  LightPath path_;
  PixelTaps taps_;
};

}  // namespace

void form_depth_bands(const Scene& scene, const DepthCamera& camera, const SensorGeometry& sensor,
                      const ImagingOptions& options, const DepthOptions& depth, const TakeBand& take,
                      const ProgressCallback& progress, DepthReport* report, const BandShare& share) {
  DepthReport own;
  DepthReport& says = report != nullptr ? *report : own;
  says = {};
  options.validate();
  scene.validate();
  SpectralImage::check(sensor.columns, sensor.rows, scene.wavelengths_nm(), sensor.pitch_um);
  DepthImaging imaging(scene, camera, sensor, options, depth, progress, says, share);
  imaging.look_at_ends();
  std::vector<std::optional<CellPlane>> planes = imaging.planes();
  for (int band = 0; band < scene.bands(); ++band) {
    CellPlane pixels;
    if (share.has(static_cast<std::size_t>(band))) {
      std::optional<CellPlane>& formed = planes[static_cast<std::size_t>(band)];
      pixels = without_negative_light(formed ? *std::exchange(formed, {}) : CellPlane(sensor));
    } else if (share.known) {
      pixels = CellPlane::unset(sensor);
      share.known(band, pixels.values);
    } else {
      continue;
    }
    note_extremes(pixels.values, band == 0, says.image);
    take(pixels.values);
  }
  note_result(says.image);
}

SpectralImage form_depth_image(const Scene& scene, const DepthCamera& camera, const SensorGeometry& sensor,
                               const ImagingOptions& options, const DepthOptions& depth,
                               const ProgressCallback& progress, DepthReport* report,
                               const BandShare& share) {
  // What does not fit is refused before there is room for an image.
  std::optional<SpectralImage> image;
  int bands = 0;
  const auto put = [&](std::span<const float> pixels) {
    if (!image) image = blank_image(scene, sensor, options);
    image->store_band(bands++, pixels);
    image->release_memory();
  };
  form_depth_bands(scene, camera, sensor, options, depth, put, progress, report, share);
  image->lens = lens_facts(camera.lens.name, first_order(camera.lens));
  return std::move(*image);
}

}  // namespace petzval
