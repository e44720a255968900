// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/live/bench_shown.h>
#include <petzval/simulate/develop.h>
#include <petzval/simulate/prepared_exposure.h>

#include <algorithm>
#include <array>
#include <utility>

namespace petzval {

using nlohmann::json;

namespace {

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

}  // namespace

void ShownSensor::choose(const std::string& path, int most_columns) {
  const std::string wanted = fmt::format("{}|{}", path, most_columns);
  if (key == wanted) return;
  key.clear();
  binned = binned_sensor(path, most_columns);
  calibrations =
      binned.sensor.electronics ? standard_calibrations(binned.sensor) : std::vector<ColourCalibration>{};
  key = wanted;
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

FlareOptions flare_options(const BenchState& state, double neglected_ghosts) {
  FlareOptions options;
  options.suns = state.suns;
  options.ghosts = state.ghosts;
  options.starburst = state.starburst;
  options.scatter = state.roughness_nm > 0;
  if (options.scatter) options.surfaces_scatter = Scatter{.roughness_nm = state.roughness_nm};
  options.search.threshold = state.threshold;
  options.neglected_share = neglected_ghosts;
  return options;
}

void send_picture(const SpectralImage& light, const ShownSensor& sensor, const OutputOptions& outputs,
                  json message, const Context& context, const SendReply& send) {
  const Sensor& used = sensor.binned.sensor;
  std::vector<std::uint8_t> pixels;
  std::string exposure = "light on the sensor";
  if (develops(outputs, used)) {
    const RawImage raw = result_within(context, [&](const ProgressCallback&) {
      const PreparedExposure exposed(light, used, outputs.expose, context, sensor.calibrations);
      return exposed.raw({&exposed.first_current(), 1}, context.seed);
    });
    exposure = fmt::format("{:.4g} s", raw.exposure_s);
    pixels = pixels_of(develop(raw, outputs.development, context).planes);
  } else {
    pixels = pixels_of(srgb_picture(light, outputs.shown));
  }
  message.update({{"kind", "picture"},
                  {"columns", light.columns()},
                  {"rows", light.rows()},
                  {"pitch_um", light.pitch_um()},
                  {"pixels_added", sensor.binned.pixels_added},
                  {"whole", {sensor.binned.whole_columns, sensor.binned.whole_rows}},
                  {"bands", light.bands()},
                  {"sensor_settings", sensor.binned.settings},
                  {"exposure", exposure}});
  send({message.dump(), std::move(pixels), true});
}

}  // namespace petzval
