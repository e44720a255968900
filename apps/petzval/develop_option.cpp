// SPDX-License-Identifier: BSD-3-Clause
#include "develop_option.h"
#include "output_option.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/illuminants.h>
#include <petzval/isp/display_picture.h>
#include <petzval/sensor/colour_calibration.h>
#include <petzval/sensor/formats/dng.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

namespace petzval::app {

namespace {

/// "0.5,1,0.7", or nothing.
std::optional<std::vector<double>> list_of_numbers(std::string_view text) {
  std::vector<double> values;
  while (!text.empty()) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return {};
    values.push_back(value);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.empty()) break;
    if (text[0] != ',') return {};
    text.remove_prefix(1);
  }
  return values;
}

bool is_light(const std::string& white_balance) {
  return white_balance != "as-shot" && white_balance != "grey-world" && !list_of_numbers(white_balance);
}

/// The matrix of the light, fitted to the very sensor.
CameraMatrix fitted_matrix(const Sensor& sensor, const Spectrum& light) {
  CameraMatrix matrix;
  matrix.pcs_from_balanced = calibration(sensor, light, 0, 0).pcs_from_balanced;
  const Xyz white = Observer::cie_1931().xyz(light);
  matrix.temperature_k = correlated_temperature_k(chromaticity(white));
  return matrix;
}

void set_white(DevelopOptions& options, const DevelopChoice& choice, const RawImage& raw) {
  if (choice.white_balance == "grey-world") {
    options.grey_world = true;
  } else if (const auto numbers = list_of_numbers(choice.white_balance)) {
    options.neutral = *numbers;
  } else if (is_light(choice.white_balance)) {
    const Spectrum light = illuminant(choice.white_balance);
    if (choice.sensor.empty()) {
      options.neutral = neutral_of_white(raw, Observer::cie_1931().xyz(light));
      return;
    }
    const Sensor sensor = read_sensor(choice.sensor);
    options.neutral = neutral_of(sensor, light);
    options.matrix = fitted_matrix(sensor, light);
  }
}

std::map<std::string, std::string> step_files(const std::vector<std::string>& steps) {
  std::map<std::string, std::string> files;
  for (const std::string& text : steps) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const auto& names = develop_step_names();
    if (equals == std::string::npos || std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(
          fmt::format("--step {}: NAME=FILE would be right, NAME one of {}", text, fmt::join(names, ", ")));
    files[name] = text.substr(equals + 1);
    require_extension(files[name], display_picture_extensions(), "a step");
  }
  return files;
}

}  // namespace

void DevelopChoice::add_to(CLI::App& command, bool after_image) {
  command
      .add_option("--white-balance", white_balance,
                  "as-shot, grey-world, a light (D65, A, 3200K, a file), or the channels' response to white: "
                  "0.5,1,0.7")
      ->capture_default_str();
  if (!after_image)
    command.add_option(
        "--sensor", sensor,
        "With a light for white balance: fit the colour matrix to this sensor under this very light");
  command
      .add_option("--matrix", matrix,
                  "Colour matrix: auto (from the raw file), or none, to see the channels as they are")
      ->check(CLI::IsMember({"auto", "none"}))
      ->capture_default_str();
  command.add_option("--demosaic", demosaic, "auto, bilinear, malvar, gradient or general")
      ->check(CLI::IsMember({"auto", "bilinear", "malvar", "gradient", "general"}))
      ->capture_default_str();
  command.add_option("--flat", flat, "A raw file of a uniform surface, to correct the shading by");
  command.add_flag("--keep-defects", keep_defects, "Leave hot and dead pixels as they are");
  command.add_option("--denoise", denoise, "Strength in units of the noise (1 to 3); 0: off")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command.add_option("--sharpen", sharpen, "Amount of unsharp masking (0.5); 0: off")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command.add_option("--sharpen-radius", sharpen_radius_px, "Of the mask [pixels]")->capture_default_str();
  command.add_option("--brightness", brightness_ev, "Brighter by this many stops [EV]")
      ->check(CLI::Range(-30.0, 30.0))
      ->capture_default_str();
  command.add_option("--tone", tone, "none (white is cut) or soft (highlights roll off)")
      ->check(CLI::IsMember({"none", "soft"}))
      ->capture_default_str();
  command.add_option("--space", space, "srgb or display-p3")
      ->check(CLI::IsMember({"srgb", "display-p3"}))
      ->capture_default_str();
  command
      .add_option("--step", steps,
                  fmt::format("NAME=FILE: write a step too: {}", fmt::join(develop_step_names(), ", ")))
      ->check(output_entry());
}

Planes DevelopChoice::develop(const RawImage& raw, DevelopReport& report,
                              const std::function<std::string(const std::string&)>& stage) const {
  DevelopOptions options;
  std::optional<RawImage> flat_field;
  if (!flat.empty()) options.flat = &flat_field.emplace(read_dng(flat));
  options.defects = !keep_defects;
  if (demosaic != "auto") options.demosaic = demosaic_method(demosaic);
  options.colours = matrix == "auto";
  options.denoise_strength = denoise;
  options.sharpen_amount = sharpen;
  options.sharpen_sigma_px = sharpen_radius_px;
  options.exposure_ev = brightness_ev;
  options.tone = tone == "soft" ? ToneCurve::soft : ToneCurve::none;
  options.space = display_space(space);
  if (!sensor.empty() && !is_light(white_balance))
    throw InputError("--sensor needs a light to fit the colour matrix to: --white-balance D65, for example");
  if (raw.channels.size() > 1) set_white(options, *this, raw);

  const std::map<std::string, std::string> files = step_files(steps);
  const DevelopStep write_step = [&](const std::string& name, const Planes& planes) {
    const auto file = files.find(name);
    if (file != files.end())
      write_display_picture(stage(file->second), planes, options.space, 16,
                            fmt::format("step {} of development", name));
  };
  return petzval::develop(raw, options, &report, files.empty() ? DevelopStep() : write_step);
}

}  // namespace petzval::app
