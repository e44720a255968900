// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/imaging/image_table.h>
#include <petzval/live/bench_picture.h>
#include <petzval/live/bench_sensor.h>

#include <algorithm>
#include <utility>

namespace petzval {

namespace {

/// What a quality costs. The bands of a preview lie where the three channels of a camera are most sensitive.
struct QualityCost {
  const char* name;
  int most_columns, scene_columns;
  std::vector<double> wavelengths_nm;
  const char* wavelengths;  ///< the same, as they are typed
  double tolerance;
  int fields, largest_psf_size;
};

const QualityCost& cost_of(PictureQuality quality) {
  static const QualityCost preview{"preview", 160, 320, {460, 540, 610}, "460,540,610", 5e-2, 6, 48};
  static const QualityCost full{
      "full",       640,
      960,          {400, 420, 440, 460, 480, 500, 520, 540, 560, 580, 600, 620, 640, 660, 680, 700},
      "400:20:700", 1e-2,
      16,           128};
  return quality == PictureQuality::preview ? preview : full;
}

/// All that the light on the sensor depends on.
std::string light_key_of(const BenchState& state) {
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}", state.lens_json, state.f_number.value_or(0),
                     state.focus.text(), state.distance_m.value_or(0), state.defocus_mm, state.scene,
                     state.illuminant, state.sensor);
}

/// And what its picture does, besides.
std::string shown_key_of(const BenchState& state) {
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}", light_key_of(state), static_cast<int>(state.exposure.kind),
                     state.exposure.value, state.compensation_ev, state.noise, state.denoise, state.sharpen,
                     state.tone);
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
TableCamera bench_optics(const Lens& used, const Sensor& sensor, const QualityCost& cost,
                         const Context& context) {
  TableOptions options;
  options.wavelengths_nm = cost.wavelengths_nm;
  constexpr double rim = 1.1;  // light comes in from beyond the corner, too
  options.max_image_height_mm = rim * sensor.geometry.half_diagonal_mm();
  options.field_count = cost.fields;
  options.largest_psf_size = cost.largest_psf_size;
  const SpreadWanted wanted{sensor.geometry.pitch_um / 2, cost.tolerance};
  return TableCamera{result_within(context,
                                   [&](const ProgressCallback& progress) {
                                     return build_image_table(used, options, wanted, progress);
                                   }),
                     sensor};
}

ImagingSession session_of(const std::string& scene_path, const std::string& illuminant,
                          const QualityCost& cost) {
  SceneRequest request;
  request.name = scene_path;
  request.options.wavelengths_nm = cost.wavelengths_nm;
  request.options.illuminant = illuminant;
  if (is_builtin_scene(scene_path)) {
    request.options.columns = cost.scene_columns;
    request.options.rows = cost.scene_columns * 3 / 4;
  }
  ImageOptions options;
  options.imaging.product.tolerance = cost.tolerance;
  return ImagingSession(std::move(request), std::move(options));
}

/// RGBA of 8 bits, as a canvas takes them.
std::vector<std::uint8_t> pixels_of(const Planes& planes) {
  std::vector<std::uint8_t> pixels;
  const std::size_t count = static_cast<std::size_t>(planes.columns) * static_cast<std::size_t>(planes.rows);
  pixels.reserve(4 * count);
  const std::size_t channels = planes.values.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      pixels.push_back(quantised_8(srgb_encoded(planes.values[std::min(c, channels - 1)][i])));
    pixels.push_back(255);
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

}  // namespace

void BenchPicture::show(const BenchState& state, const Lens& used, const std::string& scene_path,
                        const std::string& sensor_path, PictureQuality quality, const Context& context,
                        const SendReply& send) {
  Shot& shot = shots_[quality == PictureQuality::full ? 1 : 0];
  const std::string light_key = light_key_of(state), shown_key = shown_key_of(state);
  if (shot.shown_key == shown_key) return;
  const QualityCost& cost = cost_of(quality);
  if (shot.light_key != light_key || !shot.light) {
    shot.light_key.clear();
    int most_columns = cost.most_columns;
    if (quality == PictureQuality::full && shots_[0].light_key == light_key)
      most_columns = columns_for(shots_[0].spread_um, shots_[0].sensor->geometry.width_mm(),
                                 cost_of(PictureQuality::preview).most_columns, cost.most_columns);
    BinnedSensor binned = binned_sensor(sensor_path, most_columns);
    TableCamera optics = bench_optics(used, binned.sensor, cost, context);
    shot.spread_um = spread_um(optics.table);
    ImageReport report;
    const std::string scene_key = scene_path + '|' + state.illuminant;
    if (shot.scene_key != scene_key || !shot.session)
      shot.session = session_of(scene_path, state.illuminant, cost);
    shot.scene_key = scene_key;
    shot.light = shot.session->image(std::move(optics), context, &report);
    shot.sensor = std::move(binned.sensor);
    shot.sensor_settings = std::move(binned.settings);
    shot.pixels_added = binned.pixels_added;
    shot.method = report.method;
    shot.light_key = light_key;
  }
  shot.shown_key.clear();
  shot.outputs = output_options(state);
  std::vector<std::uint8_t> pixels;
  std::string exposure;
  if (develops(shot.outputs, shot.sensor)) {
    const RawImage raw = expose(*shot.light, *shot.sensor, shot.outputs.expose, context);
    exposure = fmt::format("{:.4g} s", raw.exposure_s);
    pixels = pixels_of(develop(raw, shot.outputs.development, context).planes);
  } else {
    pixels = pixels_of(srgb_picture(*shot.light, shot.outputs.shown));
    exposure = "light on the sensor";
  }
  const SensorGeometry& frame = shot.sensor->geometry;
  send({nlohmann::json{{"kind", "picture"},
                       {"id", state.id},
                       {"quality", cost.name},
                       {"columns", frame.columns},
                       {"rows", frame.rows},
                       {"pitch_um", frame.pitch_um},
                       {"pixels_added", shot.pixels_added},
                       {"bands", shot.light->bands()},
                       {"wavelengths", cost.wavelengths},
                       {"tolerance", cost.tolerance},
                       {"scene_columns", is_builtin_scene(scene_path) ? cost.scene_columns : 0},
                       {"sensor_settings", shot.sensor_settings},
                       {"exposure", exposure},
                       {"method", shot.method}}
            .dump(),
        std::move(pixels), true});
  shot.shown_key = shown_key;
}

void BenchPicture::write(const std::string& path, const Context& context) const {
  const Shot& shot = shots_[1];
  if (!shot.light || shot.shown_key.empty())
    throw InputError("there is no full picture yet; wait until it is no preview");
  write_outputs(*shot.light, {path}, shot.sensor, shot.outputs, context);
}

}  // namespace petzval
