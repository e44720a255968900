// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/formats/json_setting.h>
#include <petzval/sensor/sensor.h>
#include <petzval/sensor/sensor_reader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>

namespace petzval {

namespace {

constexpr std::size_t max_file_bytes = 1 << 20;

template <typename Number>
std::optional<Number> whole_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// "768x576@6.25", or nothing if the text is not of that form.
std::optional<SensorGeometry> parse_geometry(std::string_view text) {
  const std::size_t cross = text.find('x');
  const std::size_t at = text.find('@');
  if (cross == std::string_view::npos || at == std::string_view::npos || at < cross) return std::nullopt;
  const auto columns = whole_number<int>(text.substr(0, cross));
  const auto rows = whole_number<int>(text.substr(cross + 1, at - cross - 1));
  const auto pitch_um = whole_number<double>(text.substr(at + 1));
  if (!columns || !rows || !pitch_um) return std::nullopt;
  return SensorGeometry{*columns, *rows, *pitch_um};
}

}  // namespace

double SensorGeometry::half_diagonal_mm() const {
  return std::hypot(width_mm(), height_mm()) / 2;
}

std::vector<std::string> SensorElectronics::channel_names() const {
  std::vector<std::string> names;
  for (const SensorChannel& channel : channels) names.push_back(channel.name);
  return names;
}

double SensorElectronics::dark_current_at(double temperature_c) const {
  return dark_current_e_per_s * std::exp2((temperature_c - dark_temperature_c) / dark_doubling_c);
}

double SensorElectronics::saturation_e(const GainMode& mode, double analog_gain) const {
  return std::min(mode.full_well_e, (white_level_dn - black_level_dn) / (mode.dn_per_e * analog_gain));
}

const GainMode& SensorElectronics::gain_mode(const std::string& name) const {
  if (name.empty()) return gain_modes.front();
  std::vector<std::string> names;
  for (const GainMode& mode : gain_modes) {
    if (mode.name == name) return mode;
    names.push_back(mode.name);
  }
  throw InputError(
      fmt::format("the sensor has no conversion gain \"{}\"; it has {}", name, fmt::join(names, ", ")));
}

const SensorElectronics& Sensor::require_electronics() const {
  if (!electronics)
    throw InputError(
        fmt::format("sensor {}: only its pixels are known, not how it turns light into numbers; a "
                    "sensor with \"channels\", \"gain_modes\" and \"adc\" would be right (docs/SENSOR.md)",
                    name));
  return *electronics;
}

namespace {

/// The file of a sensor: its text and its path.
std::pair<std::string, std::string> sensor_file(const std::string& text) {
  if (text.find('@') != std::string::npos && !std::filesystem::exists(text))
    throw InputError(
        fmt::format("sensor {}: a geometry is written 768x576@6.25 (columns x rows @ pitch in µm)", text));
  std::string path;
  try {
    path = find_data_file("sensors", ".json", text, "sensor");
  } catch (const InputError& error) {
    ErrorParts parts = error.parts();
    if (!parts.remedy.empty())
      parts.remedy += "; 2448x2048@3.45 (columns x rows @ pitch in µm) is an ideal one";
    throw InputError(std::move(parts));
  }
  return {read_whole_file(path, max_file_bytes), path};
}

Sensor sensor_of_geometry(const std::string& text, const SensorGeometry& geometry) {
  if (const std::string wrong = complaint_about(geometry); !wrong.empty())
    throw InputError(fmt::format("sensor {}: {}", text, wrong));
  return {text, "given as columns x rows @ pitch", geometry, {}, {}};
}

/// What a file of the sensor would hold.
JsonDocument document_of(const std::string& text) {
  const auto geometry = parse_geometry(text);
  if (!geometry) {
    const auto [json, path] = sensor_file(text);
    return {json, path};
  }
  const Sensor sensor = sensor_of_geometry(text, *geometry);
  const nlohmann::json json = {{"format", "petzval-sensor/1"}, {"name", sensor.name},
                               {"source", sensor.source},      {"columns", geometry->columns},
                               {"rows", geometry->rows},       {"pitch_um", geometry->pitch_um}};
  return {json.dump(), text};
}

}  // namespace

Sensor read_sensor(const std::string& text) {
  if (const auto geometry = parse_geometry(text)) return sensor_of_geometry(text, *geometry);
  const auto [json, path] = sensor_file(text);
  return parse_sensor(json, path);
}

Sensor read_sensor(const std::string& text, const std::vector<std::string>& settings) {
  if (settings.empty()) return read_sensor(text);
  JsonDocument document = document_of(text);
  for (const std::string& assignment : settings) {
    const std::string origin = fmt::format("sensor {} with {}", text, assignment);
    try {
      const JsonSetting setting = parse_json_setting(assignment, "gain_modes[0].read_noise_e");
      nlohmann::json root = document.root(), *at = &root;
      std::string path;
      for (const JsonStep& step : setting.steps) {
        at = &follow_json_step(*at, step, path);
        path = step.index ? item_path(path, *step.index) : member_path(path, step.key);
      }
      *at = setting.value;
      document.replace(std::move(root), setting.path, origin);
    } catch (const InputError& error) {
      throw InputError(origin, error.what());
    }
  }
  return parse_sensor(document);
}

}  // namespace petzval
