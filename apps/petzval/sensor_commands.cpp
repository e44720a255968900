// SPDX-License-Identifier: BSD-3-Clause
// petzval sensor: the sensors known by name, and what they are.
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/units.h>
#include <petzval/sensor/sensor.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "command.h"
#include "field_option.h"
#include "sensor_option.h"

namespace petzval::app {

namespace {

using nlohmann::ordered_json;

struct Peak {
  double efficiency = 0, wavelength_nm = 0;
};

Peak peak_of(const Spectrum& efficiency) {
  const auto highest = std::ranges::max_element(efficiency.values());
  return {*highest,
          efficiency.wavelengths_nm()[static_cast<std::size_t>(highest - efficiency.values().begin())]};
}

double nyquist_cpmm(const Sensor& sensor) {
  return 1 / (2 * sensor.geometry.pitch_um * mm_per_um);
}

ordered_json channels_json(const SensorElectronics& electronics) {
  ordered_json rows = ordered_json::array();
  for (const SensorChannel& channel : electronics.channels) {
    const Peak peak = peak_of(channel.quantum_efficiency);
    rows.push_back({{"channel", channel.name},
                    {"peak_quantum_efficiency", peak.efficiency},
                    {"peak_wavelength_nm", peak.wavelength_nm},
                    {"from_nm", channel.quantum_efficiency.front_nm()},
                    {"to_nm", channel.quantum_efficiency.back_nm()}});
  }
  return rows;
}

/// Full well or white level, whichever comes first, over the noise in the dark.
double dynamic_range_db(const SensorElectronics& electronics, const GainMode& mode) {
  const double adc_e = mode.adc_noise_dn / mode.dn_per_e, step_e = 1 / (mode.dn_per_e * std::sqrt(12.0));
  const double dark_e = std::hypot(mode.read_noise_e, adc_e, step_e);
  return 20 * std::log10(electronics.saturation_e(mode, 1) / dark_e);
}

ordered_json gains_json(const SensorElectronics& electronics) {
  ordered_json rows = ordered_json::array();
  for (const GainMode& mode : electronics.gain_modes)
    rows.push_back({{"gain_mode", mode.name},
                    {"dn_per_e", mode.dn_per_e},
                    {"saturation_e", electronics.saturation_e(mode, 1)},
                    {"read_noise_e", mode.read_noise_e},
                    {"dynamic_range_db", number_or_null(dynamic_range_db(electronics, mode))}});
  return rows;
}

ordered_json facts(const Sensor& sensor) {
  const SensorGeometry& frame = sensor.geometry;
  ordered_json json = {{"sensor", sensor.name},
                       {"source", sensor.source},
                       {"columns", frame.columns},
                       {"rows_of_pixels", frame.rows},
                       {"pitch_um", frame.pitch_um},
                       {"width_mm", frame.width_mm()},
                       {"height_mm", frame.height_mm()},
                       {"diagonal_mm", 2 * frame.half_diagonal_mm()},
                       {"nyquist_cycles_per_mm", nyquist_cpmm(sensor)},
                       {"counts_photons", sensor.electronics.has_value()}};
  if (!sensor.electronics) return json;
  const SensorElectronics& electronics = *sensor.electronics;
  json["mosaic"] = mosaic_text(electronics.mosaic, electronics.channel_names());
  json["bits"] = electronics.bits;
  json["dark_current_e_per_s"] = electronics.dark_current_e_per_s;
  json["dark_temperature_c"] = electronics.dark_temperature_c;
  json["rows"] = channels_json(electronics);
  json["gain_modes"] = gains_json(electronics);
  return json;
}

void print_facts(const Sensor& sensor) {
  const SensorGeometry& frame = sensor.geometry;
  fmt::print("{}\n", sensor.name);
  if (!sensor.source.empty()) fmt::print("{}\n", sensor.source);
  fmt::print("  pixels         {} x {} of {:g} um\n", frame.columns, frame.rows, frame.pitch_um);
  fmt::print("  size           {:.4g} x {:.4g} mm, diagonal {:.4g} mm\n", frame.width_mm(), frame.height_mm(),
             2 * frame.half_diagonal_mm());
  fmt::print("  Nyquist        {:.4g} cycles/mm\n", nyquist_cpmm(sensor));
  if (!sensor.electronics) return fmt::print("  a frame of pixels; it counts no photons\n");
  const SensorElectronics& electronics = *sensor.electronics;
  fmt::print("  mosaic         {}, {} bits\n", mosaic_text(electronics.mosaic, electronics.channel_names()),
             electronics.bits);
  for (const SensorChannel& channel : electronics.channels) {
    const Peak peak = peak_of(channel.quantum_efficiency);
    fmt::print("  {:<14} quantum efficiency to {:.1f} % at {:g} nm, known from {:g} to {:g} nm\n",
               channel.name, 100 * peak.efficiency, peak.wavelength_nm, channel.quantum_efficiency.front_nm(),
               channel.quantum_efficiency.back_nm());
  }
  for (const GainMode& mode : electronics.gain_modes)
    fmt::print("  gain {:<9} {:.4g} DN per electron, saturation {:.0f} e, read noise {:.3g} e, {:.1f} dB\n",
               mode.name, mode.dn_per_e, electronics.saturation_e(mode, 1), mode.read_noise_e,
               dynamic_range_db(electronics, mode));
  fmt::print("  dark current   {:.3g} e/s at {:g} °C\n", electronics.dark_current_e_per_s,
             electronics.dark_temperature_c);
}

void list(const Shared& shared) {
  ordered_json rows = ordered_json::array();
  std::string text = fmt::format("{:<22} {:>11} {:>10} {:>14} {:>10}  {}\n", "name", "pixels", "pitch [um]",
                                 "size [mm]", "mosaic", "sensor");
  for (const std::string& name : bundled_names("sensors", ".json")) {
    const Sensor sensor = read_sensor(name);
    const SensorGeometry& frame = sensor.geometry;
    ordered_json row = facts(sensor);
    const std::size_t channels = sensor.electronics ? sensor.electronics->channels.size() : 0;
    text += fmt::format("{:<22} {:>11} {:>10g} {:>14} {:>10}  {}\n", name,
                        fmt::format("{} x {}", frame.columns, frame.rows), frame.pitch_um,
                        fmt::format("{:.2f} x {:.2f}", frame.width_mm(), frame.height_mm()),
                        channels == 0   ? "frame"
                        : channels == 1 ? "mono"
                                        : fmt::format("{} colours", channels),
                        sensor.name);
    row["name"] = name;
    rows.push_back(std::move(row));
  }
  if (shared.json) return print_json({{"rows", rows}});
  fmt::print("{}", text);
}

}  // namespace

void add_sensor_commands(CLI::App& app, Shared& shared) {
  CLI::App* sensor = app.add_subcommand("sensor", "Sensors known by name, and what a sensor file says");
  sensor->require_subcommand(1);
  add_command(*sensor, shared, "list", "The bundled sensors", "petzval sensor list", true,
              [&shared] { list(shared); });
  struct Info {
    std::string sensor;
    std::vector<std::string> settings;
  };
  auto options = std::make_shared<Info>();
  CLI::App* info = add_command(*sensor, shared, "info", "Pixels, quantum efficiency, noise and source",
                               "petzval sensor info icx625-mono", true, [options, &shared] {
                                 const Sensor read = read_sensor(options->sensor, options->settings);
                                 if (shared.json) return print_json(facts(read));
                                 print_facts(read);
                               });
  info->add_option("sensor", options->sensor, "A sensor file or the name of a bundled one, or 768x576@6.25")
      ->required();
  add_sensor_settings(*info, options->settings);
}

}  // namespace petzval::app
