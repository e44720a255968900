// SPDX-License-Identifier: BSD-3-Clause
#include "clip_option.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/simulate/vibration.h>

#include <cmath>

#include "command.h"

namespace petzval::app {

namespace {

constexpr const char* event_group = "The event camera";

/// "0.2,0", or the first alone. \throws InputError for anything else.
std::array<double, 2> sideways(const std::string& text) {
  std::array<double, 2> numbers{};
  const std::vector<std::string> words = split_at(text, ',');
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::optional<double> number = parse_number(trimmed(words[i]));
    if (i >= numbers.size() || !number || !std::isfinite(*number))
      throw InputError(fmt::format("--move {}: metres a second to the right and up, as 0.2,0, would be right",
                                   quotable(text)));
    numbers[i] = *number;
  }
  return numbers;
}

}  // namespace

void ClipChoice::add_to(CLI::App& command) {
  command.add_option("--frames", given.frames, "Frames of the clip")->check(whole_number())->required();
  command.add_option("--fps", given.fps, "Frames a second")->check(positive_number())->capture_default_str();
  command.add_option("--pan", pan_deg_per_s, "The camera turns to the right [degrees a second]")
      ->check(finite_number());
  command.add_option("--pitch", pitch_deg_per_s, "The camera turns up [degrees a second]")
      ->check(finite_number());
  command
      .add_option_function<std::string>(
          "--move", [this](const std::string& text) { move_m_per_s = sideways(text); },
          "RIGHT,UP: the scene moves [metres a second]; one at a finite --scene-distance")
      ->type_name("RIGHT,UP");
  command.add_option("--path", path,
                     "A .csv of the way: columns t_s, and any of pan_deg, pitch_deg, right_m, up_m");
  command.add_option(
      "--vibration", vibration,
      "The camera shakes too: 0.02@1-20 (degrees rms of pan and of pitch, flat from 1 to 20 Hz), or a "
      ".csv of spectral densities, columns frequency_hz, pan_deg2_per_hz, pitch_deg2_per_hz");
  command
      .add_option("--shutter", shutter,
                  "rolling (with --row-time), global, or as the sensor says (global where it does not)")
      ->check(CLI::IsMember({"sensor", "global", "rolling"}))
      ->capture_default_str();
  command.add_option("--row-time", row_time_us, "From one row of a rolling shutter to the next [us]")
      ->check(positive_number());
  command
      .add_option(
          "--flicker", flicker,
          "Of all light: none, mains:50:0.4 (Hz of the mains, depth) or pwm:1000:0.25 (Hz, duty); :PHASE "
          "in periods may follow")
      ->capture_default_str();
  command
      .add_option("--motion-step", given.step_px,
                  "Light is worked out anew when the picture has moved by so much [pixels]")
      ->check(positive_number())
      ->capture_default_str();
  command
      .add_option("--instants", given.instants,
                  "At which a scene in three dimensions (.pbrt) is rendered in the time of an exposure")
      ->check(whole_number())
      ->capture_default_str();
  const std::string before = command.option_defaults()->get_group();
  command.option_defaults()->group(event_group);
  command.add_flag("--events", events, "Write events.txt too, what an event camera with these pixels tells");
  command
      .add_option("--event-threshold", event_thresholds,
                  "ON,OFF or one for both: change of the logarithm of the light; default: 0.2")
      ->delimiter(',')
      ->expected(1, 2);
  command
      .add_option("--event-mismatch", event_camera.threshold_mismatch,
                  "rms of the thresholds, relative, over pixels")
      ->check(number_not_negative());
  command
      .add_option("--event-latency", event_camera.time_constant_s, "Time constant of the photoreceptor [s]")
      ->check(number_not_negative());
  command.add_option("--event-refractory", event_camera.refractory_s, "Rest of a pixel after an event [s]")
      ->check(number_not_negative())
      ->capture_default_str();
  command.add_option("--event-noise", event_camera.noise_per_s, "Events of noise a second and pixel")
      ->check(number_not_negative());
  command.option_defaults()->group(before);
}

Shutter ClipChoice::chosen_shutter(const Sensor& sensor) const {
  Shutter chosen = sensor.require_electronics().shutter;
  if (shutter == "global") chosen = {};
  if (shutter == "rolling") chosen.kind = Shutter::Kind::rolling;
  const bool rolls = chosen.kind == Shutter::Kind::rolling;
  if (row_time_us && !rolls)
    throw InputError("--row-time is for a rolling shutter; --shutter rolling would be right with it");
  if (row_time_us) chosen.row_time_s = *row_time_us * 1e-6;
  if (rolls && !(chosen.row_time_s > 0))
    throw InputError(fmt::format("sensor {} has no row time; --row-time 20 [us] would be right, for example",
                                 sensor.name));
  return chosen;
}

ClipOptions ClipChoice::options(const Sensor& sensor, std::uint64_t seed) const {
  ClipOptions options = given;
  options.shutter = chosen_shutter(sensor);
  options.flicker = LampFlicker::parse(flicker);
  const SceneAim per_second{pan_deg_per_s, pitch_deg_per_s, move_m_per_s[0], move_m_per_s[1]};
  if (!path.empty() && !per_second.is_straight())
    throw InputError("--path says all that moves; without --pan, --pitch and --move it would be right");
  options.validate();
  const double lasts_s = options.duration_s() + options.shutter->row_delay_s(sensor.geometry.rows);
  options.motion = path.empty() ? MotionPath::steady(per_second, lasts_s) : MotionPath::read(path);
  if (!vibration.empty())
    options.motion = VibrationSpectrum::parse(vibration).shaken(options.motion, lasts_s, seed);
  return options;
}

EventCameraOptions ClipChoice::event_options(const CLI::App& command, const Sensor& sensor,
                                             std::uint64_t seed) const {
  if (!events)
    for (const CLI::Option* option : command.get_options())
      if (option->get_group() == event_group && option->count() > 0)
        throw InputError(fmt::format("{} has no effect without --events", option->get_name()));
  EventCameraOptions options = event_camera;
  if (!event_thresholds.empty()) {
    options.threshold_on = event_thresholds.front();
    options.threshold_off = event_thresholds.back();
  }
  options.seed = seed;
  options.serial = sensor.electronics->serial;
  if (sensor.electronics->dark_current_e_per_s > 0)
    options.dark_e_per_s = sensor.electronics->dark_current_e_per_s;
  options.validate();
  return options;
}

}  // namespace petzval::app
