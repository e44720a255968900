// SPDX-License-Identifier: BSD-3-Clause
#include "shot_option.h"

#include "command.h"
#include "inset_option.h"

#include <fmt/format.h>
#include <petzval/base/error.h>

#include <algorithm>

namespace petzval::app {

namespace {

constexpr const char *exposing = "Exposure of the sensor", *developing = "Development of the picture";

/// Of the group "Exposure of the sensor" also for pictures of the light.
bool exposes_light(const CLI::Option& option) {
  return option.get_name() == "--exposure" || option.get_name() == "--exposure-compensation";
}

/// The first option of a group that was given, or nothing. \param light  also exposed by such options.
std::string given_option(const CLI::App& command, const char* group, bool light = false) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_group() == group && option->count() > 0 && !(light && exposes_light(*option)))
      return option->get_name();
  return "";
}

/// Options that `add` adds stand under a heading of their own in the help.
template <typename Add>
void add_group(CLI::App& command, const char* group, const Add& add) {
  const std::string before = command.option_defaults()->get_group();
  command.option_defaults()->group(group);
  add();
  command.option_defaults()->group(before);
}

std::string why_not_exposed(const std::optional<Sensor>& sensor) {
  if (sensor && sensor->electronics) return "no raw file (-o shot.dng) and no developed picture is asked for";
  return fmt::format(
      "{} photons; --sensor third-inch-1280x960 does, as all but the frames of petzval sensor "
      "list",
      sensor ? "--sensor " + sensor->name + " is a frame of pixels and does not count"
             : "without --sensor nothing counts");
}

}  // namespace

void ShotChoice::add_to(CLI::App& command) {
  command
      .add_option("--picture", picture,
                  "What a picture shows: what the sensor makes of the light (developed), or the light itself "
                  "(irradiance); auto: developed, if the sensor turns light into numbers")
      ->check(CLI::IsMember({"auto", "developed", "irradiance"}))
      ->capture_default_str();
  command.add_option("--bits", bits, "Of the picture: 8 or 16")
      ->check(CLI::IsMember({8, 16}))
      ->capture_default_str();
  add_inset_option(command, insets);
  add_group(command, exposing, [&] { sense.add_to(command, true); });
  add_group(command, developing, [&] { develop.add_to(command, true); });
}

void ShotChoice::add_display_to(CLI::App& command) {
  shows_light_ = true;
  command
      .add_option("--white", white,
                  "Illuminance that a .png of the light shows as white [lx]: the same in several pictures; "
                  "default: what 99.5 % of the pixels that show no lamp stay below")
      ->check(positive_number());
  command
      .add_option("--display", display,
                  "How a .png of the light shows it: linear, gamma (the square root), or log (three decades "
                  "evenly), for "
                  "stars and lamps")
      ->check(CLI::IsMember({"linear", "gamma", "log"}))
      ->capture_default_str();
}

OutputOptions ShotChoice::options() const {
  OutputOptions options;
  options.picture = picture == "developed"    ? OutputOptions::Shows::developed
                    : picture == "irradiance" ? OutputOptions::Shows::irradiance
                                              : OutputOptions::Shows::automatic;
  options.bits = bits;
  options.shown.insets = parsed_insets(insets);
  if (white) {
    options.shown.exposure = PictureOptions::Exposure::fixed;
    options.shown.white_level = *white;
  }
  options.shown.display = display == "gamma" ? PictureOptions::Display::gamma
                          : display == "log" ? PictureOptions::Display::log
                                             : PictureOptions::Display::linear;
  options.expose = sense.options();
  options.development = develop.development();
  options.step_files = develop.step_files();
  return options;
}

void ShotChoice::refuse_unused(const CLI::App& command, bool developed, bool insettable) const {
  if (const std::string option = given_option(command, developing); !developed && !option.empty())
    throw InputError(fmt::format("{} has no effect: no developed picture is asked for", option));
  if (!insets.empty() && !insettable)
    throw InputError("--inset has no effect: no picture of light (.png, .tif) is asked for");
}

OutputOptions ShotChoice::checked(const std::optional<Sensor>& sensor,
                                  const std::vector<std::string>& outputs, const CLI::App& command) const {
  OutputOptions options = this->options();
  check_outputs(outputs, sensor, options);
  const bool raw = std::ranges::any_of(outputs, is_raw_name);
  const bool developed = develops(options, sensor) && std::ranges::any_of(outputs, is_picture_name);
  const bool light =
      shows_light_ && !develops(options, sensor) && std::ranges::any_of(outputs, is_picture_name);
  if (light && white && command.get_option("--exposure")->count() > 0)
    throw InputError("--white and --exposure both say what is white; one of them would be right");
  if (const std::string option = given_option(command, exposing, light);
      !raw && !developed && !option.empty())
    throw InputError(fmt::format("{} has no effect: {}", option, why_not_exposed(sensor)));
  refuse_unused(command, developed, std::ranges::any_of(outputs, is_picture_name));
  for (const char* option : {"--white", "--display"})
    if (const CLI::Option* given = command.get_option_no_throw(option);
        shows_light_ && given->count() > 0 && develops(options, sensor))
      throw InputError(fmt::format(
          "{} is for pictures of the light, and those of a --sensor that turns light into numbers are "
          "developed; --brightness or --picture irradiance would be right",
          option));
  return options;
}

}  // namespace petzval::app
