// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/imaging/image_table.h>
#include <petzval/live/bench_json.h>
#include <petzval/live/bench_picture.h>
#include <petzval/sensor/colour_calibration.h>
#include <petzval/simulate/flare.h>
#include <petzval/simulate/prepared_exposure.h>

#include <algorithm>
#include <cstdlib>
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
  int fields, largest_psf_size;
  double neglected_ghosts;  ///< share of their light
};

namespace {

QualityCost preview_cost(int most_columns, int scene_columns) {
  return {"preview", most_columns, scene_columns, {460, 540, 610}, "460,540,610", 2e-2, 6, 64, 1e-2};
}

/// All that the light on the sensor depends on.
std::string light_key_of(const BenchState& state) {
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}", state.lens_json, state.coating_text(),
                     state.f_number.value_or(0), state.focus.text(), state.distance_m.value_or(0),
                     state.defocus_mm, state.scene, state.illuminant, state.sensor);
}

/// All that stray light depends on besides the light of the picture.
std::string stray_light_key(const BenchState& state) {
  if (!state.has_stray_light()) return {};
  const Sun sun = state.sun.value_or(Sun{});
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}", state.sun.has_value(), sun.right_deg, sun.up_deg,
                     sun.illuminance_lx, state.ghosts, state.starburst, state.threshold, state.roughness_nm);
}

/// And what its picture does, besides.
std::string shown_key_of(const BenchState& state) {
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}", light_key_of(state), stray_light_key(state),
                     static_cast<int>(state.exposure.kind), state.exposure.value, state.compensation_ev,
                     state.noise, state.denoise, state.sharpen, state.tone);
}

OutputOptions output_options(const BenchState& state) {
  OutputOptions options;
  options.expose.exposure = state.exposure;
  options.expose.compensation_ev = state.compensation_ev;
  if (!state.noise)
    options.expose.without = {NoiseSource::shot, NoiseSource::dark,   NoiseSource::read,
                              NoiseSource::dsnu, NoiseSource::prnu,   NoiseSource::column,
                              NoiseSource::row,  NoiseSource::defects};
  options.development.options.denoise_strength = state.denoise;
  options.development.options.sharpen_amount = state.sharpen;
  options.development.options.tone = state.tone == "soft" ? ToneCurve::soft : ToneCurve::none;
  options.shown.compensation_ev = state.compensation_ev;
  options.shown.false_colour = true;
  return options;
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
  return options;
}

/// Levels of a display by their linear light, which is asked for every pixel.
class DisplayLevels {
 public:
  DisplayLevels() {
    for (std::size_t i = 0; i <= steps; ++i)
      levels_[i] = quantised_8(srgb_encoded(static_cast<double>(i) / steps));
  }
  std::uint8_t operator()(double linear) const {
    return linear > 0 ? levels_[static_cast<std::size_t>(std::min(linear, 1.0) * steps + 0.5)] : levels_[0];
  }

 private:
  static constexpr std::size_t steps = 1 << 14;  // the steepest level is four of them wide
  std::array<std::uint8_t, steps + 1> levels_{};
};

/// RGBA of 8 bits, as a canvas takes them.
std::vector<std::uint8_t> pixels_of(const Planes& planes) {
  static const DisplayLevels level;
  const std::size_t count = static_cast<std::size_t>(planes.columns) * static_cast<std::size_t>(planes.rows);
  std::vector<std::uint8_t> pixels(4 * count, 255);
  const std::size_t channels = planes.values.size();
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& plane = planes.values[std::min(c, channels - 1)];
    for (std::size_t i = 0; i < count; ++i) pixels[4 * i + c] = level(plane[i]);
  }
  return pixels;
}

std::vector<std::uint8_t> pixels_of(const PngImage& picture) {
  std::vector<std::uint8_t> pixels;
  const std::size_t channels = static_cast<std::size_t>(picture.channels);
  for (std::size_t i = 0; i + channels <= picture.samples.size(); i += channels) {
    for (std::size_t c = 0; c < 3; ++c)
      pixels.push_back(static_cast<std::uint8_t>(picture.samples[i + std::min(c, channels - 1)]));
    pixels.push_back(255);
  }
  return pixels;
}

/// The picture with a sun, ghosts and stars of all bright sources, and with what surfaces scatter.
SpectralImage with_stray_light(const BenchState& state, const CoatedLens& used, const Sensor& sensor,
                               double psf_mm, const SourcesFound& found, const QualityCost& cost,
                               const SpectralImage& light, const Context& context) {
  FlareOptions options;
  if (state.sun) options.suns = {*state.sun};
  options.ghosts = state.ghosts;
  options.starburst = state.starburst;
  options.scatter = state.roughness_nm > 0;
  options.neglected_share = cost.neglected_ghosts;
  const LitLens lens{used.lens, used.losses, Tracer::Clip::apertures, reflection_of(sensor), psf_mm};
  SpectralImage stray = light;
  FlareLayers layers = flare_layers(lens, sensor.geometry, light.wavelengths_nm(), found, options, context);
  add_layers(layers, stray);
  if (options.scatter) {
    options.surfaces_scatter = Scatter{.roughness_nm = state.roughness_nm};
    add_scatter(lens, options, layers, stray, context);
  }
  return stray;
}

const QualityCost full_cost{
    "full",       640,  960, {400, 420, 440, 460, 480, 500, 520, 540, 560, 580, 600, 620, 640, 660, 680, 700},
    "400:20:700", 1e-2, 16,  128,
    1e-3};
const std::array preview_costs{preview_cost(160, 320), preview_cost(320, 480), preview_cost(640, 960)};

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
      most_columns = columns_for(preview.spread_um, preview.sensor.sensor.geometry.width_mm(),
                                 preview_costs[0].most_columns, cost.most_columns);
    const std::string sensor_key = fmt::format("{}|{}", sensor_path, most_columns);
    if (shot.sensor_key != sensor_key) {
      shot.sensor_key.clear();
      shot.sensor = binned_sensor(sensor_path, most_columns);
      shot.calibrations = shot.sensor.sensor.electronics ? standard_calibrations(shot.sensor.sensor)
                                                         : std::vector<ColourCalibration>{};
      shot.sensor_key = sensor_key;
    }
    TableCamera optics = bench_optics(used, shot.sensor.sensor, cost, context);
    shot.spread_um = spread_um(optics.table);
    ImageReport report;
    const std::string scene_key = scene_path + '|' + state.illuminant;
    in_stride = shot.scene_key == scene_key && shot.session;
    if (!in_stride) shot.session.emplace(scene_of(scene_path, state.illuminant, cost), image_options(cost));
    shot.scene_key = scene_key;
    shot.light = shot.session->image(optics, context, &report);
    shot.optics = std::move(optics);
    shot.method = report.method;
    shot.light_key = light_key;
  }
  const std::string stray_key = stray_light_key(state);
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
      shot.stray = with_stray_light(state, used, shot.sensor.sensor, shot.spread_um * mm_per_um, shot.sources,
                                    cost, *shot.light, context);
    }
    shot.stray_key = stray_key;
  }
  return in_stride;
}

void BenchPicture::choose_preview(double seconds) {
  // The next size takes two to three times as long.
  constexpr double too_long_s = 0.13, short_s = 0.045;
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
  const Sensor& sensor = shot.sensor.sensor;
  std::vector<std::uint8_t> pixels;
  std::string exposure;
  if (develops(shot.outputs, sensor)) {
    const RawImage raw = result_within(context, [&](const ProgressCallback&) {
      const PreparedExposure exposed(shot.lit(), sensor, shot.outputs.expose, context, shot.calibrations);
      return exposed.raw({&exposed.first_current(), 1}, context.seed);
    });
    exposure = fmt::format("{:.4g} s", raw.exposure_s);
    pixels = pixels_of(develop(raw, shot.outputs.development, context).planes);
  } else {
    pixels = pixels_of(srgb_picture(shot.lit(), shot.outputs.shown));
    exposure = "light on the sensor";
  }
  const SensorGeometry& frame = sensor.geometry;
  send({json{{"kind", "picture"},
             {"id", state.id},
             {"quality", cost.name},
             {"columns", frame.columns},
             {"rows", frame.rows},
             {"pitch_um", frame.pitch_um},
             {"pixels_added", shot.sensor.pixels_added},
             {"bands", shot.light->bands()},
             {"wavelengths", cost.wavelengths},
             {"tolerance", cost.tolerance},
             {"scene_columns", is_builtin_scene(scene_path) ? cost.scene_columns : 0},
             {"sensor_settings", shot.sensor.settings},
             {"exposure", exposure},
             {"sources", state.has_stray_light() ? sources_json(used.lens, shot.sources) : json::array()},
             {"neglected_ghosts", cost.neglected_ghosts},
             {"method", shot.method}}
            .dump(),
        std::move(pixels), true});
  shot.shown_key = shown_key;
  if (in_stride && !full)
    choose_preview(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
}

void BenchPicture::write(const std::string& path, const Context& context) const {
  const Shot& shot = full_;
  if (!shot.light || shot.shown_key.empty())
    throw InputError("there is no full picture yet; wait until it is no preview");
  write_outputs(shot.lit(), {path}, shot.sensor.sensor, shot.outputs, context);
}

}  // namespace petzval
