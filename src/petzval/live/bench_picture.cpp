// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/imaging/image_table.h>
#include <petzval/live/bench_json.h>
#include <petzval/live/bench_picture.h>
#include <petzval/simulate/flare.h>

#include <algorithm>
#include <utility>

namespace petzval {

using nlohmann::json;

/// What a quality costs. The bands of a preview lie where the three channels of a camera are most sensitive.
struct QualityCost {
  const char* name;
  int most_columns, scene_columns;
  std::vector<double> wavelengths_nm;
  const char* wavelengths;  ///< the same, as they are typed
  double tolerance;
  int cells_per_pixel;  ///< 0: as many as the tolerance needs
  int fields, largest_psf_size;
  double neglected_ghosts;  ///< share of their light
};

namespace {

QualityCost preview_cost(int most_columns, int scene_columns) {
  return {"preview", most_columns, scene_columns, {460, 540, 610}, "460,540,610", 2e-2, 1, 6, 64, 1e-2};
}

/// How far light spreads about its chief ray [um], the most of a table.
double spread_um(const LensDataTable& table) {
  double spread = 0;
  for (const Psf& psf : table.psf) spread = std::max(spread, psf.half_width_um());
  return spread;
}

/// A picture without fine detail needs no fine pixels: PSFs of hundreds of pixels would take minutes.
int columns_for(double spread_um, double frame_width_mm, int least, int most) {
  constexpr double pixels = 16, um_per_mm = 1000;  // from the middle of a PSF to its edge
  if (spread_um == 0) return most;
  return std::clamp(static_cast<int>(pixels * frame_width_mm * um_per_mm / spread_um), least, most);
}

/// A table of fewer fields than a single picture takes, and PSFs where a picture of this tolerance needs
/// them: real rays all the same, with more between them.
TableCamera bench_optics(const CoatedLens& used, const Sensor& sensor, const QualityCost& cost,
                         const Context& context) {
  TableOptions options;
  options.wavelengths_nm = cost.wavelengths_nm;
  constexpr double rim = 1.1;  // light comes in from beyond the corner, too
  options.max_image_height_mm = rim * sensor.geometry.half_diagonal_mm();
  options.field_count = cost.fields;
  options.largest_psf_size = cost.largest_psf_size;
  options.losses = used.losses;
  const SpreadWanted wanted{sensor.geometry.pitch_um / 2, cost.tolerance};
  return TableCamera{result_within(context,
                                   [&](const ProgressCallback& progress) {
                                     return build_image_table(used.lens, options, wanted, progress);
                                   }),
                     sensor};
}

/// The scene as a quality asks for it.
SceneRequest scene_of(const std::string& scene_path, const std::string& illuminant, const QualityCost& cost) {
  SceneRequest request;
  request.name = scene_path;
  request.options.wavelengths_nm = cost.wavelengths_nm;
  request.options.illuminant = illuminant;
  if (is_builtin_scene(scene_path)) {
    request.options.columns = cost.scene_columns;
    request.options.rows = cost.scene_columns * 3 / 4;
  }
  return request;
}

ImageOptions image_options(const QualityCost& cost) {
  ImageOptions options;
  options.imaging.product.tolerance = cost.tolerance;
  options.imaging.supersample = cost.cells_per_pixel;
  return options;
}

/// All that the light on the sensor depends on.
std::string light_key_of(const BenchState& state) {
  return fmt::format("{}|{}|{}|{}", state.camera_key(), state.scene, state.illuminant, state.sensor);
}

/// And what its picture does, besides.
std::string shown_key_of(const BenchState& state) {
  return fmt::format("{}|{}|{}", light_key_of(state), state.stray_key(), state.shot_key());
}

/// The picture with suns, ghosts and stars of all bright sources, and with what surfaces scatter.
SpectralImage with_stray_light(const BenchState& state, const CoatedLens& used, const Sensor& sensor,
                               double psf_mm, const SourcesFound& found, const QualityCost& cost,
                               const SpectralImage& light, const Context& context) {
  const FlareOptions options = flare_options(state, cost.neglected_ghosts);
  const LitLens lens{used.lens, used.losses, Tracer::Clip::apertures, reflection_of(sensor), psf_mm};
  SpectralImage stray = light;
  FlareLayers layers = flare_layers(lens, sensor.geometry, light.wavelengths_nm(), found, options, context);
  add_layers(layers, stray);
  if (options.scatter) add_scatter(lens, options, layers, stray, context);
  return stray;
}

const QualityCost full_cost{
    "full",       640,  960, {400, 420, 440, 460, 480, 500, 520, 540, 560, 580, 600, 620, 640, 660, 680, 700},
    "400:20:700", 1e-2, 0,   16,
    128,          1e-3};
const std::array preview_costs{preview_cost(160, 320), preview_cost(320, 480), preview_cost(480, 720),
                               preview_cost(640, 960)};

}  // namespace

bool BenchPicture::form_light(Shot& shot, const BenchState& state, const CoatedLens& used,
                              const std::string& scene_path, const std::string& sensor_path,
                              const QualityCost& cost, const Context& context) {
  const std::string light_key = light_key_of(state);
  bool in_stride = false;
  if (shot.light_key != light_key || !shot.light) {
    shot.light_key.clear();
    shot.stray_key.clear();
    int most_columns = cost.most_columns;
    if (const Shot& preview = previews_[preview_size_]; &shot == &full_ && preview.light_key == light_key)
      most_columns = columns_for(preview.spread_um, preview.sensor.binned.sensor.geometry.width_mm(),
                                 preview_costs[0].most_columns, cost.most_columns);
    shot.sensor.choose(sensor_path, most_columns);
    TableCamera optics = bench_optics(used, shot.sensor.binned.sensor, cost, context);
    shot.spread_um = spread_um(optics.table);
    ImageReport report;
    const std::string scene_key = scene_path + '|' + state.illuminant;
    in_stride = shot.scene_key == scene_key && shot.session;
    if (!in_stride) shot.session.emplace(scene_of(scene_path, state.illuminant, cost), image_options(cost));
    shot.scene_key = scene_key;
    shot.light = shot.session->image(optics, context, &report);
    shot.optics = std::move(optics);
    shot.method = report.method;
    shot.estimated_error = report.imaging.estimated_error();
    shot.light_key = light_key;
  }
  const std::string stray_key = state.stray_key();
  if (shot.stray_key != stray_key || stray_key.empty()) {
    shot.stray_key.clear();
    shot.stray.reset();
    shot.sources = {};
    constexpr double mm_per_um = 1e-3;
    if (!stray_key.empty()) {
      const ImagePlan plan = plan_image(scene_of(scene_path, state.illuminant, cost), *shot.optics,
                                        image_options(cost), context);
      shot.sources =
          find_sources(plan.scene, used.lens.total_track_mm(), SourceSearch{.threshold = state.threshold});
      shot.stray = with_stray_light(state, used, shot.sensor.binned.sensor, shot.spread_um * mm_per_um,
                                    shot.sources, cost, *shot.light, context);
    }
    shot.stray_key = stray_key;
  }
  return in_stride;
}

void BenchPicture::choose_preview(double seconds) {
  // The next size takes up to twice as long.
  constexpr double too_long_s = 0.12, short_s = 0.055;
  if (seconds > too_long_s && preview_size_ > 0)
    --preview_size_;
  else if (seconds < short_s && preview_size_ + 1 < preview_sizes)
    ++preview_size_;
}

void BenchPicture::show(const BenchState& state, const CoatedLens& used, const std::string& scene_path,
                        const std::string& sensor_path, PictureQuality quality, const Context& context,
                        const SendReply& send) {
  const bool full = quality == PictureQuality::full;
  Shot& shot = full ? full_ : previews_[preview_size_];
  const QualityCost& cost = full ? full_cost : preview_costs[preview_size_];
  const std::string shown_key = shown_key_of(state);
  if (shot.shown_key == shown_key) return;
  const auto began = std::chrono::steady_clock::now();
  const bool in_stride = form_light(shot, state, used, scene_path, sensor_path, cost, context);
  for (Shot& other : previews_)
    if (!full) other.shown_key.clear();
  if (full) shot.shown_key.clear();
  shot.outputs = output_options(state);
  send_picture(shot.lit(), shot.sensor, shot.outputs,
               {{"id", state.id},
                {"quality", cost.name},
                {"wavelengths", cost.wavelengths},
                {"tolerance", cost.tolerance},
                {"estimated_error", shot.estimated_error},
                {"scene_columns", is_builtin_scene(scene_path) ? cost.scene_columns : 0},
                {"sources", state.has_stray_light() ? sources_json(used.lens, shot.sources) : json::array()},
                {"neglected_ghosts", cost.neglected_ghosts},
                {"method", shot.method}},
               context, send);
  shot.shown_key = shown_key;
  if (in_stride && !full)
    choose_preview(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
}

void BenchPicture::write(const std::string& path, const Context& context) const {
  const Shot& shot = full_;
  if (!shot.light || shot.shown_key.empty())
    throw InputError("there is no full picture yet; wait until it is no preview");
  write_outputs(shot.lit(), {path}, shot.sensor.binned.sensor, shot.outputs, context);
}

}  // namespace petzval
