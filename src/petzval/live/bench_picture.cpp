// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/imaging/image_table.h>
#include <petzval/live/bench_json.h>
#include <petzval/live/bench_picture.h>
#include <petzval/scene/scene_file.h>
#include <petzval/simulate/flare.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

namespace petzval {

using nlohmann::json;

/// What a quality costs. The bands of a preview lie where the three channels of a camera are most sensitive.
struct QualityCost {
  const char* name;
  int most_columns;   ///< 0: as many as most_pixels lets it
  int scene_columns;  ///< of a chart; 0: its figures, laid on the cells of the picture
  std::vector<double> wavelengths_nm;
  double tolerance;
  int cells_per_pixel;  ///< 0: as many as the tolerance needs
  int fields, largest_psf_size;
  double neglected_ghosts;  ///< share of their light
};

/// What a stage is given.
struct BenchPicture::Stage {
  const BenchState& state;
  const CoatedLens& used;
  const BenchScene& scene;
  const std::string& sensor_path;
  const QualityCost& cost;
  PictureQuality quality;
  const Context& context;
};

namespace {

constexpr std::size_t preview_bands = 3;

QualityCost preview_cost(int most_columns, int scene_columns) {
  return {"preview", most_columns, scene_columns, {460, 540, 610}, 2e-2, 1, 6, 64, 1e-2};
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
  return static_cast<int>(std::clamp<double>(pixels * frame_width_mm * um_per_mm / spread_um, least, most));
}

/// A table of fewer fields than a single picture takes, and PSFs where a picture of this tolerance needs
/// them: real rays all the same, with more between them.
TableCamera bench_optics(const CoatedLens& used, const Sensor& sensor, const QualityCost& cost,
                         const std::vector<double>& wavelengths_nm, const Context& context) {
  TableOptions options;
  options.wavelengths_nm = wavelengths_nm;
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

/// A chart or a photograph as a stage asks for it.
SceneRequest scene_of(const BenchScene& scene, const std::string& illuminant,
                      const std::vector<double>& wavelengths_nm, int scene_columns) {
  SceneRequest request;
  request.name = scene.path;
  request.options.wavelengths_nm = wavelengths_nm;
  request.options.illuminant = illuminant;
  if (scene_columns > 0) {
    request.options.columns = scene_columns;
    request.options.rows = scene_columns * 3 / 4;
  }
  return request;
}

/// How many samples a chart has: none, where its figures can be laid on the cells of the picture.
int chart_columns(const BenchScene& scene, const QualityCost& cost) {
  if (!is_builtin_scene(scene.path)) return 0;
  if (cost.scene_columns > 0) return cost.scene_columns;
  constexpr int fine_columns = 1536, any_nm = 550;
  return read_scene(scene.path, {.wavelengths_nm = {any_nm}}).drawing() ? 0 : fine_columns;
}

/// As many of the bands of a stage as the samples of a file leave room for, every second or fourth else.
std::vector<double> bands_of(const BenchScene& scene, const QualityCost& cost) {
  std::vector<double> liked = cost.wavelengths_nm;
  while (liked.size() > preview_bands && liked.size() * scene.samples > most_bench_values) {
    std::vector<double> few;
    for (std::size_t i = 0; i < liked.size(); i += 2) few.push_back(liked[i]);
    liked = std::move(few);
  }
  return scene.wavelengths_nm(liked);
}

/// "400:10:700", or all of them.
std::string wavelengths_text(const std::vector<double>& nm) {
  const std::size_t last = nm.size() - 1;
  const double step = last > 0 ? (nm[last] - nm[0]) / static_cast<double>(last) : 0;
  bool even = nm.size() > preview_bands;
  for (std::size_t i = 0; i <= last; ++i) even = even && nm[i] == nm[0] + step * static_cast<double>(i);
  return even ? fmt::format("{:g}:{:g}:{:g}", nm[0], step, nm[last])
              : fmt::format("{:.8g}", fmt::join(nm, ","));
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

std::vector<double> visible_bands(double step_nm) {
  constexpr double first_nm = 400, last_nm = 700;
  std::vector<double> bands;
  for (double nm = first_nm; nm <= last_nm; nm += step_nm) bands.push_back(nm);
  return bands;
}

const QualityCost full_cost{"full", 640, 960, visible_bands(20), 1e-2, 0, 16, 128, 1e-3};
const QualityCost finest_cost{"finest", 0, 0, visible_bands(10), 1e-2, 0, 16, 256, 1e-3};
const std::array preview_costs{preview_cost(160, 320), preview_cost(320, 480), preview_cost(480, 720),
                               preview_cost(640, 960)};

}  // namespace

int BenchPicture::most_columns(const Stage& stage) {
  const QualityCost& coarse = preview_costs[0];
  // A picture of 31 bands then takes less than 200 MB.
  constexpr double most_pixels = 1.6e6;
  const bool finest = stage.quality == PictureQuality::finest;
  const int most = finest ? columns_for_pixels(stage.sensor_path, most_pixels) : stage.cost.most_columns;
  if (stage.quality == PictureQuality::preview) return most;
  // By a table of its own, lest a picture depend on which preview came before it.
  ShownSensor sensor;
  sensor.choose(stage.sensor_path, coarse.most_columns);
  const TableCamera optics =
      bench_optics(stage.used, sensor.binned.sensor, coarse, bands_of(stage.scene, coarse), stage.context);
  return columns_for(spread_um(optics.table), sensor.binned.sensor.geometry.width_mm(), coarse.most_columns,
                     most);
}

void BenchPicture::form_image_light(Shot& shot, const Stage& stage) {
  const std::string scene_key = stage.scene.path + '|' + stage.state.illuminant;
  const ImageOptions options = image_options(stage.cost);
  if (shot.scene_key != scene_key) {
    shot.scene_key.clear();
    shot.session.reset();
    shot.cube.reset();
    shot.scene_columns = chart_columns(stage.scene, stage.cost);
    if (stage.scene.is_spectral())
      shot.cube = read_bench_scene(stage.scene, stage.state.illuminant, shot.wavelengths_nm);
    shot.scene_key = scene_key;
  }
  const auto request = [&] {
    return scene_of(stage.scene, stage.state.illuminant, shot.wavelengths_nm, shot.scene_columns);
  };
  ImageReport report;
  if (shot.cube) {
    place_bench_scene(*shot.cube, *shot.optics, options);
    shot.light = image(*shot.cube, *shot.optics, options, stage.context, &report);
  } else if (stage.quality == PictureQuality::finest) {
    shot.light = image(request(), *shot.optics, options, stage.context, &report);
  } else {
    if (!shot.session) shot.session.emplace(request(), options);
    shot.light = shot.session->image(*shot.optics, stage.context, &report);
  }
  shot.method = report.method;
  shot.estimated_error = report.imaging.estimated_error();
}

void BenchPicture::form_stray_light(Shot& shot, const Stage& stage) {
  shot.stray.reset();
  shot.sources = {};
  if (!stage.state.has_stray_light()) return;
  constexpr double mm_per_um = 1e-3;
  const ImageOptions options = image_options(stage.cost);
  const ImagePlan plan =
      shot.cube
          ? plan_image(*shot.cube, *shot.optics, options, stage.context)
          : plan_image(scene_of(stage.scene, stage.state.illuminant, shot.wavelengths_nm, shot.scene_columns),
                       *shot.optics, options, stage.context);
  shot.sources = find_sources(plan.scene, stage.used.lens.total_track_mm(),
                              SourceSearch{.threshold = stage.state.threshold});
  shot.stray =
      with_stray_light(stage.state, stage.used, shot.sensor.binned.sensor, shot.spread_um * mm_per_um,
                       shot.sources, stage.cost, *shot.light, stage.context);
}

bool BenchPicture::form_light(Shot& shot, const Stage& stage) {
  const std::string light_key = light_key_of(stage.state);
  bool in_stride = false;
  if (shot.light_key != light_key || !shot.light) {
    in_stride = shot.scene_key == stage.scene.path + '|' + stage.state.illuminant;
    shot.light_key.clear();
    shot.stray_key.clear();
    shot.light.reset();
    shot.sensor.choose(stage.sensor_path, most_columns(stage));
    shot.wavelengths_nm = bands_of(stage.scene, stage.cost);
    shot.optics =
        bench_optics(stage.used, shot.sensor.binned.sensor, stage.cost, shot.wavelengths_nm, stage.context);
    shot.spread_um = spread_um(shot.optics->table);
    form_image_light(shot, stage);
    shot.light_key = light_key;
  }
  const std::string stray_key = stage.state.stray_key();
  if (shot.stray_key != stray_key || stray_key.empty()) {
    shot.stray_key.clear();
    form_stray_light(shot, stage);
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

void BenchPicture::show(const BenchState& state, const CoatedLens& used, const BenchScene& scene,
                        const std::string& sensor_path, PictureQuality quality, const Context& context,
                        const SendReply& send) {
  const bool preview = quality == PictureQuality::preview;
  Shot& shot = preview ? previews_[preview_size_] : quality == PictureQuality::full ? full_ : finest_;
  const QualityCost& cost = preview                           ? preview_costs[preview_size_]
                            : quality == PictureQuality::full ? full_cost
                                                              : finest_cost;
  const std::string shown_key = shown_key_of(state);
  if (shot.shown_key == shown_key) return;
  if (finest_.light_key != light_key_of(state)) finest_ = {};  // its memory, which nothing needs any more
  finest_.shown_key.clear();
  const auto began = std::chrono::steady_clock::now();
  const Stage stage{state, used, scene, sensor_path, cost, quality, context};
  const bool in_stride = form_light(shot, stage);
  if (preview)
    for (Shot& other : previews_) other.shown_key.clear();
  shot.shown_key.clear();
  shot.outputs = output_options(state);
  send_picture(shot.lit(), shot.sensor, shot.outputs, message_of(shot, stage), context, send);
  shot.shown_key = shown_key;
  if (in_stride && preview)
    choose_preview(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
}

json BenchPicture::message_of(const Shot& shot, const Stage& stage) const {
  json message{{"id", stage.state.id},
               {"quality", stage.cost.name},
               {"wavelengths", wavelengths_text(shot.wavelengths_nm)},
               {"tolerance", stage.cost.tolerance},
               {"estimated_error", shot.estimated_error},
               {"scene_columns", shot.scene_columns},
               {"sources",
                stage.state.has_stray_light() ? sources_json(stage.used.lens, shot.sources) : json::array()},
               {"neglected_ghosts", stage.cost.neglected_ghosts},
               {"method", shot.method}};
  if (shot.cube) {
    message["scene_angle_deg"] = shot.cube->horizontal_angle_deg();
    message["scene_distance_m"] = shot.cube->distance_m() ? json(*shot.cube->distance_m()) : json();
    message["scene_illuminant"] =
        stage.state.illuminant.empty() ? stage.scene.usual_illuminant : stage.state.illuminant;
  }
  return message;
}

void BenchPicture::write(const std::string& path, const Context& context) const {
  const bool finest = finest_.light && !finest_.shown_key.empty();
  const Shot& shot = finest ? finest_ : full_;
  if (!shot.light || shot.shown_key.empty())
    throw InputError("there is no full picture yet; wait until it is no preview");
  write_outputs(shot.lit(), {path}, shot.sensor.binned.sensor, shot.outputs, context);
}

}  // namespace petzval
