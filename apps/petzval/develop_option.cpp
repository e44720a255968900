// SPDX-License-Identifier: BSD-3-Clause
#include "develop_option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/isp/display_picture.h>
#include <petzval/sensor/formats/dng.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "command.h"
#include "output_option.h"

namespace petzval::app {

void DevelopChoice::add_to(CLI::App& command, bool after_light) {
  command
      .add_option("--white-balance", white_balance,
                  "as-shot, grey-world, a light (D65, A, 3200K, a file), or the channels' response to white: "
                  "0.5,1,0.7")
      ->capture_default_str();
  if (!after_light)
    command.add_option(
        "--sensor", sensor,
        "With a light for white balance: fit the colour matrix to this sensor under this very light");
  command
      .add_option("--matrix", matrix,
                  "Colour matrix: auto (from the raw file), or none, to see the channels as they are")
      ->check(CLI::IsMember({"auto", "none"}))
      ->capture_default_str();
  std::vector<std::string> methods{"auto"};
  for (const DemosaicMethod& method : demosaic_methods()) methods.push_back(method.name);
  command.add_option("--demosaic", demosaic, fmt::format("{}", fmt::join(methods, ", ")))
      ->check(CLI::IsMember(methods))
      ->capture_default_str();
  command.add_option("--flat", flat, "A raw file of a uniform surface, to correct the shading by");
  command.add_flag("--keep-defects", keep_defects, "Leave hot and dead pixels as they are");
  command
      .add_option("--denoise", given.denoise_strength,
                  "Strength in units of the noise of the raw file; 1 is right for it, 0: off")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command.add_option("--sharpen", given.sharpen_amount, "Amount of unsharp masking (0.5); 0: off")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command.add_option("--sharpen-radius", given.sharpen_sigma_px, "Of the mask [pixels]")
      ->capture_default_str();
  command
      .add_option(
          "--brightness", brightness,
          "Brighter by this many stops [EV], or auto: what 99 % of the picture do not exceed is white")
      ->check([](const std::string& text) {
        const std::optional<double> stops = parse_number(text);
        constexpr double most_ev = 30;
        if (text == "auto" || (stops && std::abs(*stops) <= most_ev)) return std::string();
        return fmt::format("{}: auto, or a number from -30 to 30 would be right", text);
      })
      ->capture_default_str();
  command.add_option("--tone", tone, "none (white is cut) or soft (highlights roll off)")
      ->check(CLI::IsMember({"none", "soft"}))
      ->capture_default_str();
  command
      .add_option(
          "--space", space,
          "srgb, display-p3, or rec2100-pq: a .png of 16 bits for displays of high dynamic range, white "
          "at 203 cd/m2, highlights beyond it kept")
      ->check(CLI::IsMember({"srgb", "display-p3", "rec2100-pq"}))
      ->capture_default_str();
  command
      .add_option("--step", steps,
                  fmt::format("NAME=FILE: write a step too: {}", fmt::join(develop_step_names(), ", ")))
      ->check(output_entry());
}

Development DevelopChoice::development() const {
  Development development;
  if (!flat.empty()) development.flat = read_dng(flat);
  development.white_balance = WhiteBalance::parse(white_balance);
  if (!sensor.empty()) development.white_balance.sensor = read_sensor(sensor);
  DevelopOptions& options = development.options = given;
  options.defects = !keep_defects;
  options.automatic_exposure = brightness == "auto";
  if (!options.automatic_exposure) options.exposure_ev = *parse_number(brightness);
  if (demosaic != "auto") options.demosaic = demosaic;
  options.colours = matrix == "auto";
  options.tone = tone == "soft" ? ToneCurve::soft : ToneCurve::none;
  options.space = display_space(space);
  return development;
}

std::vector<std::pair<std::string, std::string>> DevelopChoice::step_files() const {
  std::vector<std::pair<std::string, std::string>> files;
  for (const std::string& text : steps) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const auto& names = develop_step_names();
    if (equals == std::string::npos || std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(
          fmt::format("--step {}: NAME=FILE would be right, NAME one of {}", text, fmt::join(names, ", ")));
    files.emplace_back(name, text.substr(equals + 1));
    require_extension(files.back().second, display_picture_extensions(), "a step");
  }
  return files;
}

}  // namespace petzval::app
