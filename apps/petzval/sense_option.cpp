// SPDX-License-Identifier: BSD-3-Clause
#include "sense_option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/colour/illuminants.h>

#include "command.h"

namespace petzval::app {

void SenseChoice::add_to(CLI::App& command, bool after_light, bool of_clip) {
  command
      .add_option(
          "--exposure", exposure,
          "auto, a time (0.01, 10ms, 1/100), or an exposure value at ISO 100 (ev:12)" +
              std::string(after_light && !of_clip ? "; of a .png of the light: as on a sensor of ISO 100"
                                                  : ""))
      ->capture_default_str();
  command
      .add_option("--metering", metering,
                  "Automatic exposure: highlights (99 % of the pixels stay below 80 % of saturation) or "
                  "average (the mean "
                  "comes to 12.7 %)")
      ->check(CLI::IsMember({"highlights", "average"}))
      ->capture_default_str();
  constexpr double most_ev = 40;  // as data sets have it
  command.add_option("--exposure-compensation", given.compensation_ev, "More light by this many stops [EV]")
      ->check(finite_number())
      ->check(CLI::Range(-most_ev, most_ev))
      ->capture_default_str();
  if (!after_light)
    command.add_option("--f-number", given.f_number, "For exposure values; default: the lens's, where known");
  command.add_option("--conversion-gain", given.gain_mode,
                     "Of a sensor with several: its name, or dual: one exposure is read at all of them and "
                     "merged; default: the first");
  command.add_option("--gain", given.analog_gain, "Analog gain")->capture_default_str();
  command.add_option("--temperature", given.temperature_c,
                     "Of the sensor [degrees C]; default: that of its dark current");
  command.add_option("--serial", given.serial, "Another copy of the sensor, with other fixed patterns");
  if (!of_clip)
    command.add_option("--frames", given.frames, "Average this many exposures")->capture_default_str();
  command
      .add_option("--bracket", given.bracket_ev, "Merge exposures that differ by these stops: -2,0,2 [EV]")
      ->delimiter(',');
  command
      .add_option("--without", without, fmt::format("Switch off: {}", fmt::join(noise_source_names(), ", ")))
      ->delimiter(',');
  if (!after_light)
    command.add_option("--illuminant", illuminant,
                       "Light of the scene, for white balance; default: as the irradiance says");
  command.add_option("--exit-pupil", given.exit_pupil_mm,
                     "From the sensor, negative in front of it [mm]; for microlenses");
  command.add_option(
      "--date-time", date_time,
      fmt::format("When the exposure{} began, for raw files and EXIF: \"2026-11-26 10:00:00\"; "
                  "default: no date",
                  of_clip ? " of the first frame" : ""));
}

ExposeOptions SenseChoice::options() const {
  ExposeOptions options = given;
  options.exposure = Exposure::parse(exposure);
  options.metering = metering == "average" ? Metering::Rule::average : Metering::Rule::highlights;
  if (!illuminant.empty()) options.illuminant = petzval::illuminant(illuminant);
  if (!date_time.empty()) options.date_time = parse_date_time(date_time);
  for (const std::string& name : without) options.without.insert(noise_source(name));
  return options;
}

}  // namespace petzval::app
