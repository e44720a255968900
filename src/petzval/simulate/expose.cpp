// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/version.h>
#include <petzval/colour/illuminants.h>
#include <petzval/scene/wavelength_list.h>
#include <petzval/sensor/colour_calibration.h>
#include <petzval/sensor/merged_exposures.h>
#include <petzval/simulate/expose.h>
#include <petzval/simulate/prepared_exposure.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace petzval {

namespace {

constexpr std::string_view by_value = "ev:";

/// "0.01", "0.01s", "10ms", "10000us", and the fractions of photographers, "1/100".
std::optional<double> time_s(std::string_view text) {
  double unit_s = 1;
  for (const auto& [name, size] : {std::pair<std::string_view, double>{"ms", 1e-3}, {"us", 1e-6}, {"s", 1}})
    if (text.ends_with(name)) {
      text.remove_suffix(name.size());
      unit_s = size;
      break;
    }
  const std::size_t slash = text.find('/');
  const std::optional<double> number = parse_number(text.substr(0, slash));
  if (!number || slash == text.npos) return number ? std::optional(*number * unit_s) : std::nullopt;
  const std::optional<double> below = parse_number(text.substr(slash + 1));
  return below && *below > 0 ? std::optional(*number / *below * unit_s) : std::nullopt;
}

double exposure_s(const ExposeOptions& options, const SpectralImage& light, const PhotoCurrent& current,
                  double saturation_e) {
  if (options.exposure.kind == Exposure::Kind::automatic)
    return metered_exposure_s(current, saturation_e, {options.metering, options.compensation_ev},
                              light.lamps);
  const double compensation = std::exp2(options.compensation_ev);
  if (options.exposure.kind == Exposure::Kind::seconds) return options.exposure.value * compensation;
  const double n = options.f_number.value_or(light.lens ? light.lens->f_number : 0);
  if (!(n > 0))
    throw InputError("an exposure value needs an f-number, and the irradiance has none; `f_number` gives it");
  return exposure_of_ev_s(options.exposure.value, n) * compensation;
}

/// White balance of the light of the scene, as asked, as the image says, or as if the scene were grey on
/// average.
std::vector<double> neutral(const ExposeOptions& options, const SpectralImage& light, const Sensor& sensor,
                            const PhotoCurrent& current, const Context& context) {
  if (sensor.electronics->channels.size() == 1) return {};
  if (options.illuminant) return neutral_of(sensor, *options.illuminant);
  if (light.illuminant) return neutral_of(sensor, *light.illuminant);
  std::vector<double> means = channel_means(current, *sensor.electronics);
  const double most = *std::max_element(means.begin(), means.end());
  for (double& mean : means) {
    if (!(mean > 0)) return {};
    mean /= most;
  }
  send_note(context,
            "the light of the scene is not known: white balance as if the scene were grey on average "
            "(`scene.illuminant` D65 says otherwise)");
  return means;
}

/// Light that the sensor is blind to because nobody measured how it sees it: silence would look like
/// darkness.
void note_unmeasured_light(const SpectralImage& light, const Sensor& sensor, const Context& context) {
  double shortest_nm = INFINITY, longest_nm = 0;
  for (const SensorChannel& channel : sensor.electronics->channels) {
    shortest_nm = std::min(shortest_nm, channel.quantum_efficiency.front_nm());
    longest_nm = std::max(longest_nm, channel.quantum_efficiency.back_nm());
  }
  const std::string beyond = runs_of_bands(light.wavelengths_nm(), [&](double nm) {
    if (nm >= shortest_nm && nm <= longest_nm) return false;
    const auto at = std::ranges::find(light.wavelengths_nm(), nm) - light.wavelengths_nm().begin();
    return std::ranges::any_of(light.band(static_cast<int>(at)), [](float value) { return value > 0; });
  });
  if (!beyond.empty())
    send_note(
        context,
        fmt::format("the quantum efficiency of sensor {} is known from {:g} to {:g} nm and taken to be 0 "
                    "beyond: it does not see the light at {} nm",
                    sensor.name, shortest_nm, longest_nm, beyond));
}

/// White balance and colours of a sensor without crosstalk are those of its channels.
Sensor altered(Sensor sensor, const ExposeOptions& options) {
  if (options.without.contains(NoiseSource::crosstalk))
    sensor.electronics->crosstalk = SensorElectronics().crosstalk;
  return sensor;
}

PhotoCurrentOptions current_options(const ExposeOptions& options) {
  return {!options.without.contains(NoiseSource::crosstalk),
          !options.without.contains(NoiseSource::microlens), options.exit_pupil_mm};
}

constexpr std::string_view all_gains = "dual";

/// The mode that a merged exposure saturates in; else the one asked for.
std::string widest_mode(const SensorElectronics& electronics, const ExposeOptions& options) {
  if (options.gain_mode != all_gains) return options.gain_mode;
  const std::vector<GainMode>& modes = electronics.gain_modes;
  if (modes.size() < 2)
    throw InputError(
        "`gain_mode` dual is for a sensor with several conversion gains; this one has one, and no "
        "`gain_mode` "
        "would be right");
  if (!options.bracket_ev.empty())
    throw InputError("exposures of a bracket are read once; `bracket_ev` or `gain_mode` dual would be right");
  return std::ranges::max_element(
             modes, {},
             [&](const GainMode& mode) { return electronics.saturation_e(mode, options.analog_gain); })
      ->name;
}

RawImage captured(const ExposeOptions& options, const Sensor& sensor, std::span<const PhotoCurrent> currents,
                  double seconds, std::uint64_t seed, int first_frame) {
  CaptureOptions capturing{
      options.gain_mode, options.analog_gain, options.temperature_c, seed, options.serial,
      options.without,   options.frames,      first_frame,           0};
  if (options.gain_mode == all_gains) {
    std::vector<RawImage> readings;
    for (const GainMode& mode : sensor.electronics->gain_modes) {
      capturing.gain_mode = mode.name;
      readings.push_back(capture(currents.front(), sensor, seconds, capturing));
      ++capturing.reading;
    }
    return merge_readings(readings);
  }
  if (options.bracket_ev.empty()) return capture(currents.front(), sensor, seconds, capturing);
  std::vector<RawImage> exposures;
  for (std::size_t i = 0; i < options.bracket_ev.size(); ++i) {
    exposures.push_back(capture(currents[std::min(i, currents.size() - 1)], sensor,
                                seconds * std::exp2(options.bracket_ev[i]), capturing));
    ++capturing.seed;  // noise of its own
  }
  return merge_bracket(exposures);
}

}  // namespace

PreparedExposure::PreparedExposure(const SpectralImage& light, Sensor sensor, const ExposeOptions& options,
                                   const Context& context, std::vector<ColourCalibration> calibrations)
    : sensor_(altered(std::move(sensor), options)), options_(options) {
  const SensorElectronics& electronics = *sensor_.electronics;
  note_unmeasured_light(light, sensor_, context);
  const GainMode& mode = electronics.gain_mode(widest_mode(electronics, options));
  current_ = current(light);
  seconds_ = exposure_s(options, light, current_, electronics.saturation_e(mode, options.analog_gain));

  facts_.calibrations = calibrations.empty() ? standard_calibrations(sensor_) : std::move(calibrations);
  facts_.as_shot_neutral = neutral(options, light, sensor_, current_, context);
  constexpr const char* daylight = "D55";
  facts_.iso = saturation_speed(sensor_, mode, options.analog_gain, illuminant(daylight));
  if (light.lens) facts_.lens = *light.lens;
  if (options.f_number) facts_.lens.f_number = *options.f_number;
  facts_.date_time = options.date_time;
  facts_.provenance = fmt::format("petzval {} sense: {}; {}", version(), sensor_.name, light.provenance);
}

PhotoCurrent PreparedExposure::current(const SpectralImage& light) const {
  return photo_current(light, sensor_, current_options(options_));
}

RawImage PreparedExposure::raw(std::span<const PhotoCurrent> currents, std::uint64_t seed,
                               int first_frame) const {
  RawImage raw = captured(options_, sensor_, currents, seconds_, seed, first_frame);
  raw.calibrations = facts_.calibrations;
  raw.as_shot_neutral = facts_.as_shot_neutral;
  raw.iso = facts_.iso;
  raw.lens = facts_.lens;
  raw.date_time = facts_.date_time;
  raw.provenance = facts_.provenance;
  return raw;
}

Exposure Exposure::parse(std::string_view text) {
  if (text == "auto") return automatic();
  const bool value_given = text.starts_with(by_value);
  const std::optional<double> value = value_given ? parse_number(text.substr(by_value.size())) : time_s(text);
  if (!value || (!value_given && *value < 0))
    throw InputError(
        fmt::format("`exposure` {}: auto, a time (0.01, 10ms, 1/100) or an exposure value (ev:12) would be "
                    "right",
                    quotable(text)));
  return value_given ? of_value(*value) : seconds(*value);
}

RawImage expose(const SpectralImage& light, const Sensor& sensor, const ExposeOptions& options,
                const Context& context) {
  sensor.require_electronics();
  return result_within(context, [&](const ProgressCallback&) {
    const PreparedExposure exposure(light, sensor, options, context);
    return exposure.raw(std::span(&exposure.first_current(), 1), context.seed);
  });
}

}  // namespace petzval
