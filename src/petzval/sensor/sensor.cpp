// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/sensor/sensor.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

namespace petzval {

using nlohmann::json;

namespace {

// Far beyond any sensor built, and small enough that columns × rows cannot overflow.
constexpr int max_side = 1 << 17;
constexpr double max_pitch_um = 1000;
constexpr std::size_t max_file_bytes = 1 << 20;
constexpr std::array known_keys = {"format", "name", "source", "columns", "rows", "pitch_um"};

template <typename Number>
std::optional<Number> whole_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// What is wrong with the geometry, or nothing.
std::string complaint(const SensorGeometry& geometry) {
  for (int side : {geometry.columns, geometry.rows})
    if (side < 1 || side > max_side)
      return fmt::format("{} pixels on a side; 1 to {} would be right", side, max_side);
  if (!(geometry.pitch_um > 0 && geometry.pitch_um <= max_pitch_um))
    return fmt::format("a pitch of {} µm; above 0 and up to {} would be right", geometry.pitch_um,
                       max_pitch_um);
  return "";
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

int line_at(std::string_view text, std::size_t byte) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + std::min(byte, text.size()), '\n'));
}

/// One sensor file: the parsed document with the text it came from, for line numbers.
class SensorDocument {
 public:
  explicit SensorDocument(const std::string& path)
      : path_(path), text_(read_whole_file(path, max_file_bytes)) {
    try {
      document_ = json::parse(text_);
    } catch (const json::parse_error& error) {
      throw InputError(path_, line_at(text_, error.byte),
                       "is not JSON here; a sensor file is one JSON object");
    }
    if (!document_.is_object()) throw InputError(path_, 1, "is not a JSON object");
    for (const auto& [key, value] : document_.items())
      if (std::find(known_keys.begin(), known_keys.end(), key) == known_keys.end())
        fail(key, fmt::format("unknown key \"{}\"; known are {}", key, fmt::join(known_keys, ", ")));
  }

  std::string string(const char* key) const {
    const json& value = at(key);
    if (!value.is_string()) fail(key, fmt::format("\"{}\" must be a string", key));
    return value.get<std::string>();
  }
  int whole(const char* key) const {
    const json& value = at(key);
    if (!value.is_number_integer() || value.get<double>() > max_side || value.get<double>() < 1)
      fail(key, fmt::format("\"{}\" must be a whole number from 1 to {}", key, max_side));
    return value.get<int>();
  }
  double number(const char* key) const {
    const json& value = at(key);
    if (!value.is_number()) fail(key, fmt::format("\"{}\" must be a number", key));
    return value.get<double>();
  }
  [[noreturn]] void fail(const std::string& key, const std::string& message) const {
    throw InputError(path_, line_at(text_, text_.find(json(key).dump())), message);
  }

 private:
  const json& at(const char* key) const {
    const auto found = document_.find(key);
    if (found == document_.end()) throw InputError(path_, 1, fmt::format("the key \"{}\" is missing", key));
    return *found;
  }

  std::string path_, text_;
  json document_;
};

Sensor read_sensor_file(const std::string& path) {
  const SensorDocument document(path);
  if (const std::string format = document.string("format"); format != "petzval-sensor/1")
    document.fail("format", fmt::format("format \"{}\"; \"petzval-sensor/1\" would be right", format));
  Sensor sensor{document.string("name"),
                document.string("source"),
                {document.whole("columns"), document.whole("rows"), document.number("pitch_um")}};
  if (const std::string wrong = complaint(sensor.geometry); !wrong.empty()) document.fail("pitch_um", wrong);
  return sensor;
}

}  // namespace

double SensorGeometry::half_diagonal_mm() const {
  return std::hypot(width_mm(), height_mm()) / 2;
}

Sensor read_sensor(const std::string& text) {
  if (const auto geometry = parse_geometry(text)) {
    if (const std::string wrong = complaint(*geometry); !wrong.empty())
      throw InputError(fmt::format("sensor {}: {}", text, wrong));
    return {text, "given as columns x rows @ pitch", *geometry};
  }
  if (text.find('@') != std::string::npos && !std::filesystem::exists(text))
    throw InputError(
        fmt::format("sensor {}: a geometry is written 768x576@6.25 (columns x rows @ pitch in µm)", text));
  return read_sensor_file(find_data_file("sensors", ".json", text, "sensor"));
}

}  // namespace petzval
