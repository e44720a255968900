// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/live/bench_sensor.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// By how much a number of the file grows with k.
void scale_setting(std::vector<std::string>& settings, const std::string& path, double value, double factor) {
  if (value != 0) settings.push_back(fmt::format("{}={:.10g}", path, value * factor));
}

void scale_electronics(std::vector<std::string>& settings, const SensorElectronics& electronics, int k) {
  const double side = k, area = side * side;
  for (std::size_t i = 0; i < electronics.gain_modes.size(); ++i) {
    const GainMode& mode = electronics.gain_modes[i];
    const auto path = [&](const char* key) { return fmt::format("gain_modes[{}].{}", i, key); };
    scale_setting(settings, path("full_well_e"), mode.full_well_e, area);
    scale_setting(settings, path("dn_per_e"), mode.dn_per_e, 1 / area);
    scale_setting(settings, path("read_noise_e"), mode.read_noise_e, side);
    scale_setting(settings, path("adc_noise_dn"), mode.adc_noise_dn, 1 / side);
  }
  scale_setting(settings, "dark.current_e_per_s", electronics.dark_current_e_per_s, area);
  scale_setting(settings, "dsnu_e", electronics.dsnu_e, side);
  constexpr double percent = 100;
  scale_setting(settings, "prnu_percent", electronics.prnu * percent, 1 / side);
  scale_setting(settings, "column_pattern_e", electronics.column_pattern_e, side * std::sqrt(side));
  scale_setting(settings, "row_noise_e", electronics.row_noise_e, side * std::sqrt(side));
}

}  // namespace

BinnedSensor binned_sensor(const std::string& name, int most_columns) {
  const Sensor whole = read_sensor(name);
  const int k = std::max(1, (whole.geometry.columns + most_columns - 1) / most_columns);
  if (k == 1) return {whole, {}, 1, whole.geometry.columns, whole.geometry.rows};
  // Even numbers, so that the mosaic ends as it begins.
  const auto pixels = [k](int count) { return std::max(2, count / k / 2 * 2); };
  std::vector<std::string> settings{fmt::format("columns={}", pixels(whole.geometry.columns)),
                                    fmt::format("rows={}", pixels(whole.geometry.rows)),
                                    fmt::format("pitch_um={:.10g}", whole.geometry.pitch_um * k)};
  if (whole.electronics) scale_electronics(settings, *whole.electronics, k);
  return {read_sensor(name, settings), settings, k, whole.geometry.columns, whole.geometry.rows};
}

int columns_for_pixels(const std::string& name, double most_pixels) {
  const SensorGeometry geometry = read_sensor(name).geometry;
  const double pixels = static_cast<double>(geometry.columns) * static_cast<double>(geometry.rows);
  const int k = std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / most_pixels))));
  return (geometry.columns + k - 1) / k;
}

std::string usual_sensor(double image_height_mm) {
  std::string best;
  double best_misfit = INFINITY, best_pixels = 0;
  constexpr double alike = 0.03;  // then fewer pixels will do
  for (const std::string& name : bundled_names("sensors", ".json")) {
    const Sensor sensor = read_sensor(name);
    if (!sensor.electronics || sensor.electronics->channels.size() != 3) continue;
    const double ratio = sensor.geometry.half_diagonal_mm() / image_height_mm;
    constexpr double rim = 1.1;      // fields are often given a little short of the corner
    constexpr double penalty = 3.0;  // a dark corner is worse than a small picture
    const double misfit = ratio > rim ? penalty * std::log(ratio) : std::abs(std::log(ratio));
    const double pixels = double(sensor.geometry.columns) * double(sensor.geometry.rows);
    const bool better =
        misfit < best_misfit - alike || (misfit < best_misfit + alike && pixels < best_pixels);
    if (better) best_misfit = misfit, best_pixels = pixels, best = name;
  }
  return best;
}

}  // namespace petzval
