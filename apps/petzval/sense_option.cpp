// SPDX-License-Identifier: BSD-3-Clause
#include "sense_option.h"

#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/colour/illuminants.h>
#include <petzval/sensor/colour_calibration.h>
#include <petzval/sensor/exposure.h>

#include <algorithm>
#include <cmath>

namespace petzval::app {

namespace {

double exposure_s(const SenseChoice& choice, const SpectralImage& image, const PhotoCurrent& current,
                  double saturation_e) {
  if (choice.exposure == "auto") {
    const Metering metering{
        choice.metering == "average" ? Metering::Rule::average : Metering::Rule::highlights,
        choice.compensation_ev};
    return metered_exposure_s(current, saturation_e, metering);
  }
  const bool by_ev = choice.exposure.starts_with("ev:");
  const auto value = parse_number(std::string_view(choice.exposure).substr(by_ev ? 3 : 0));
  if (!value || (!by_ev && *value < 0))
    throw InputError(fmt::format(
        "--exposure {}: auto, seconds (0.01) or an exposure value (ev:12) would be right", choice.exposure));
  if (!by_ev) return *value * std::exp2(choice.compensation_ev);
  const double n = choice.f_number.value_or(image.lens ? image.lens->f_number : 0);
  if (!(n > 0))
    throw InputError("an exposure value needs an f-number, and the irradiance has none; give --f-number");
  return exposure_of_ev_s(*value, n) * std::exp2(choice.compensation_ev);
}

/// White balance of the light of the scene, as asked, as the image says, or as if the scene were grey on
/// average.
std::vector<double> neutral(const SenseChoice& choice, const SpectralImage& image, const Sensor& sensor,
                            const PhotoCurrent& current, const Shared& shared) {
  if (sensor.electronics->channels.size() == 1) return {};
  if (!choice.illuminant.empty()) return neutral_of(sensor, illuminant(choice.illuminant));
  if (image.illuminant) return neutral_of(sensor, *image.illuminant);
  std::vector<double> means = channel_means(current, *sensor.electronics);
  const double most = *std::max_element(means.begin(), means.end());
  for (double& mean : means) {
    if (!(mean > 0)) return {};
    mean /= most;
  }
  note(
      shared,
      "the light of the scene is not known: white balance as if the scene were grey on average (--illuminant "
      "D65 says otherwise)");
  return means;
}

}  // namespace

void SenseChoice::add_to(CLI::App& command, bool after_image) {
  command.add_option("--exposure", exposure, "auto, seconds, or an exposure value at ISO 100 (ev:12)")
      ->capture_default_str();
  command
      .add_option("--metering", metering,
                  "Automatic exposure: highlights (99 % of the pixels stay below 80 % of saturation) or "
                  "average (the mean "
                  "comes to 12.7 %)")
      ->check(CLI::IsMember({"highlights", "average"}))
      ->capture_default_str();
  command.add_option("--exposure-compensation", compensation_ev, "More light by this many stops [EV]")
      ->capture_default_str();
  if (!after_image)
    command.add_option("--f-number", f_number, "For exposure values; default: the lens's, where known");
  command.add_option("--conversion-gain", conversion_gain,
                     "Of a sensor with several: its name; default: the first");
  command.add_option("--gain", gain, "Analog gain")->capture_default_str();
  command.add_option("--temperature", temperature_c,
                     "Of the sensor [degrees C]; default: that of its dark current");
  command.add_option("--serial", serial, "Another copy of the sensor, with other fixed patterns");
  command.add_option("--frames", frames, "Average this many exposures")->capture_default_str();
  command.add_option("--bracket", bracket_ev, "Merge exposures that differ by these stops: -2,0,2 [EV]")
      ->delimiter(',');
  command
      .add_option("--without", without, fmt::format("Switch off: {}", fmt::join(noise_source_names(), ", ")))
      ->delimiter(',');
  if (!after_image)
    command.add_option("--illuminant", illuminant,
                       "Light of the scene, for white balance; default: as the irradiance says");
  command.add_option("--exit-pupil", exit_pupil_mm,
                     "From the sensor, negative in front of it [mm]; for microlenses");
}

RawImage SenseChoice::expose(const SpectralImage& image, const Sensor& described,
                             const Shared& shared) const {
  described.require_electronics();
  Sensor sensor = described;
  SensorElectronics& electronics = *sensor.electronics;
  CaptureOptions options{conversion_gain, gain, temperature_c, shared.seed, serial, {}, frames};
  for (const std::string& name : without) options.without.insert(noise_source(name));
  // White balance and colours are then those of a sensor without it.
  if (!options.has(NoiseSource::crosstalk)) electronics.crosstalk = SensorElectronics().crosstalk;
  const GainMode& mode = electronics.gain_mode(conversion_gain);
  const PhotoCurrent current = photo_current(
      image, sensor,
      {options.has(NoiseSource::crosstalk), options.has(NoiseSource::microlens), exit_pupil_mm});
  const double seconds = exposure_s(*this, image, current, electronics.saturation_e(mode, gain));

  RawImage raw;
  if (bracket_ev.empty()) {
    raw = capture(current, sensor, seconds, options);
  } else {
    std::vector<RawImage> exposures;
    for (const double ev : bracket_ev) {
      exposures.push_back(capture(current, sensor, seconds * std::exp2(ev), options));
      ++options.seed;  // noise of its own
    }
    raw = merge_bracket(exposures);
  }
  raw.calibrations = standard_calibrations(sensor);
  raw.as_shot_neutral = neutral(*this, image, sensor, current, shared);
  constexpr const char* daylight = "D55";
  raw.iso = saturation_speed(sensor, mode, gain, petzval::illuminant(daylight));
  if (image.lens) raw.lens = *image.lens;
  if (f_number) raw.lens.f_number = *f_number;
  raw.provenance = fmt::format("petzval {} sense: {}; {}", version(), sensor.name, image.provenance);
  return raw;
}

}  // namespace petzval::app
