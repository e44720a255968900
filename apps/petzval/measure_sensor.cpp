// SPDX-License-Identifier: BSD-3-Clause
// petzval measure sensor, noise: gain, full well, noise and non-uniformities by photon transfer.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/illuminants.h>
#include <petzval/measure/photon_transfer.h>
#include <petzval/sensor/exposure.h>
#include <petzval/sensor/formats/dng.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "measure_command.h"

namespace petzval::app {

namespace {

using nlohmann::ordered_json;

struct SensorCommand {
  std::string sensor, conversion_gain, channel;
  double gain = 1;
  MeasureOutputs outputs;
};

struct NoiseCommand {
  std::vector<std::string> raws;
  std::string channel;
  MeasureOutputs outputs;
};

double snr(const TransferPoint& point, const TransferPoint& dark) {
  return (point.mean_dn - dark.mean_dn) / std::sqrt(point.temporal_variance_dn2);
}

Table table_of(const PhotonTransfer& transfer) {
  Table table{{{"exposure", "s", 5},
               {"mean", "DN", 2},
               {"signal", "e", 1},
               {"temporal variance", "DN2", 3},
               {"SNR", "dB", 2}},
              {}};
  for (const TransferPoint& point : transfer.points) {
    const double signal = (point.mean_dn - transfer.points[0].mean_dn) / transfer.dn_per_e;
    table.rows.push_back({point.exposure_s, point.mean_dn, signal, point.temporal_variance_dn2,
                          20 * std::log10(snr(point, transfer.points[0]))});
  }
  return table;
}

Plot plot_of(const PhotonTransfer& transfer, const std::string& title) {
  Plot plot;
  plot.title = title;
  plot.x = {"mean above dark", "DN", PlotScale::linear, {}, {}};
  plot.y = {"temporal variance above dark", "DN²", PlotScale::linear, {}, {}};
  std::vector<double> x, y, line;
  const TransferPoint& dark = transfer.points[0];
  for (const TransferPoint& point : transfer.points) {
    x.push_back(point.mean_dn - dark.mean_dn);
    y.push_back(point.temporal_variance_dn2 - dark.temporal_variance_dn2);
    line.push_back(transfer.dn_per_e * x.back());
  }
  plot.scatter("measured", x, y);
  plot.line(fmt::format("{:.4g} DN per electron", transfer.dn_per_e), x, line).stroke = PlotStroke::dashed;
  return plot;
}

ordered_json rows_of(const PhotonTransfer& transfer) {
  ordered_json rows = ordered_json::array();
  for (const TransferPoint& point : transfer.points) {
    const double ratio = snr(point, transfer.points[0]);
    rows.push_back({{"exposure_s", point.exposure_s},
                    {"mean_dn", point.mean_dn},
                    {"signal_e", (point.mean_dn - transfer.points[0].mean_dn) / transfer.dn_per_e},
                    {"temporal_variance_dn2", point.temporal_variance_dn2},
                    {"snr_db", ratio > 0 ? ordered_json(20 * std::log10(ratio)) : ordered_json(nullptr)}});
  }
  return rows;
}

ordered_json figures(const PhotonTransfer& transfer) {
  return {{"dn_per_e", transfer.dn_per_e},
          {"dark_noise_e", transfer.dark_noise_e},
          {"quantisation_limited", transfer.quantisation_limited},
          {"saturation_e", transfer.saturation_e},
          {"full_signal_e",
           transfer.full_signal_e ? ordered_json(*transfer.full_signal_e) : ordered_json(nullptr)},
          {"dynamic_range_db", transfer.dynamic_range_db},
          {"snr_max_db", transfer.snr_max_db}};
}

/// A noise, or below what it stays where the steps of the converter hide it.
std::string noise_text(double noise_e, bool quantisation_limited) {
  return quantisation_limited ? fmt::format("below {:.2f} e, hidden by the steps of the converter", noise_e)
                              : fmt::format("{:.3f} e", noise_e);
}

void print_figures(const PhotonTransfer& transfer) {
  fmt::print("  system gain     {:.5g} DN per electron\n", transfer.dn_per_e);
  fmt::print("  dark noise      {}\n", noise_text(transfer.dark_noise_e, transfer.quantisation_limited));
  fmt::print(
      "  saturation      {:.0f} e{}\n", transfer.saturation_e,
      transfer.full_signal_e ? fmt::format(", all pixels full at {:.0f} e", *transfer.full_signal_e) : "");
  fmt::print("  dynamic range   {:.1f} dB, {:.1f} stops\n", transfer.dynamic_range_db,
             transfer.dynamic_range_db / (20 * std::log10(2)));
  fmt::print("  greatest SNR    {:.1f} dB\n", transfer.snr_max_db);
}

void measure_sensor(const SensorCommand& command, const Shared& shared) {
  command.outputs.check();
  const Sensor sensor = read_sensor(command.sensor);
  const SensorElectronics& electronics = sensor.require_electronics();
  CaptureOptions options;
  options.gain_mode = command.conversion_gain;
  options.analog_gain = command.gain;
  options.seed = shared.seed;
  const int channel = channel_index(electronics.channel_names(), command.channel);
  const SensorTest test = test_sensor(sensor, options, channel);
  const GainMode& mode = electronics.gain_mode(command.conversion_gain);
  const double daylight_speed = saturation_speed(sensor, mode, command.gain, illuminant("D55"));
  const double tungsten_speed = saturation_speed(sensor, mode, command.gain, illuminant("3200K"));
  const auto by_noise = [&](double snr) {
    return noise_speed(sensor, mode, command.gain, illuminant("D55"), snr);
  };
  constexpr double excellent = 40, acceptable = 10;
  const std::optional<double> speed_40 = by_noise(excellent), speed_10 = by_noise(acceptable);
  command.outputs.write(table_of(test.transfer), plot_of(test.transfer, sensor.name + ": photon transfer"));
  if (shared.json) {
    ordered_json json = figures(test.transfer);
    json["dsnu_e"] = test.uniformity.dsnu_e;
    json["dsnu_quantisation_limited"] = test.uniformity.dsnu_quantisation_limited;
    json["prnu_percent"] = test.uniformity.prnu_percent;
    json["grey_signal_e"] = test.grey.signal_e;
    json["grey_total_snr"] = test.grey.total_snr;
    json["grey_temporal_snr"] = test.grey.temporal_snr;
    json["grey_fixed_pattern_snr"] = test.grey.fixed_pattern_snr;
    json["iso_dynamic_range_db"] = test.grey.dynamic_range_db;
    json["iso_saturation_daylight"] = daylight_speed;
    json["iso_saturation_tungsten"] = tungsten_speed;
    json["iso_noise_40_daylight"] = speed_40 ? ordered_json(*speed_40) : ordered_json(nullptr);
    json["iso_noise_10_daylight"] = speed_10 ? ordered_json(*speed_10) : ordered_json(nullptr);
    json["rows"] = rows_of(test.transfer);
    return fmt::print("{}\n", json.dump(2));
  }
  fmt::print("{}, channel {}, conversion gain {}, analog gain {:g}\n", sensor.name,
             electronics.channels[static_cast<std::size_t>(channel)].name, mode.name, command.gain);
  print_figures(test.transfer);
  fmt::print("  DSNU            {}\n",
             noise_text(test.uniformity.dsnu_e, test.uniformity.dsnu_quantisation_limited));
  fmt::print("  PRNU            {:.3f} %\n", test.uniformity.prnu_percent);
  fmt::print(
      "  ISO 15739       S/N {:.1f} of a grey of {:.0f} e, temporal {:.1f}, fixed pattern {:.1f}; range "
      "{:.1f} dB\n",
      test.grey.total_snr, test.grey.signal_e, test.grey.temporal_snr, test.grey.fixed_pattern_snr,
      test.grey.dynamic_range_db);
  fmt::print("  ISO speed       {:.0f} in daylight (D55), {:.0f} in tungsten light (3200 K), by saturation\n",
             daylight_speed, tungsten_speed);
  const auto said = [](std::optional<double> speed) {
    return speed ? fmt::format("{:.0f}", *speed) : "none";
  };
  fmt::print("                  {} in daylight for a pixel's S/N of 40, {} for 10\n", said(speed_40),
             said(speed_10));
}

void measure_noise(const NoiseCommand& command, const Shared& shared) {
  command.outputs.check();
  if (command.raws.size() % 2 != 0)
    throw InputError("the exposures must come in pairs: two dark ones, then two of each light");
  std::vector<TransferPoint> points;
  for (std::size_t i = 0; i + 1 < command.raws.size(); i += 2) {
    const RawImage first = read_dng(command.raws[i]), second = read_dng(command.raws[i + 1]);
    points.push_back(transfer_point(first, second, channel_index(first.channels, command.channel)));
  }
  const PhotonTransfer transfer = photon_transfer(points);
  command.outputs.write(table_of(transfer), plot_of(transfer, "Photon transfer"));
  if (shared.json) {
    ordered_json json = figures(transfer);
    json["rows"] = rows_of(transfer);
    return fmt::print("{}\n", json.dump(2));
  }
  fmt::print("{} levels of light\n", transfer.points.size() - 1);
  print_figures(transfer);
}

}  // namespace

int channel_index(const std::vector<std::string>& names, const std::string& wanted) {
  if (wanted.empty()) {
    // Green where there is one: it has the most pixels.
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == "green") return static_cast<int>(i);
    return 0;
  }
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == wanted) return static_cast<int>(i);
  throw InputError(fmt::format("no channel \"{}\"; there are {}", wanted, fmt::join(names, ", ")));
}

void add_measure_sensor(CLI::App& measure, Shared& shared) {
  auto options = std::make_shared<SensorCommand>();
  CLI::App* command =
      add_command(measure, shared, "sensor",
                  "Test a sensor as EMVA 1288, ISO 12232 and 15739 do: gain, noise, range, speed",
                  "petzval measure sensor third-inch-1280x960 --plot transfer.svg", true,
                  [options, &shared] { measure_sensor(*options, shared); });
  command->add_option("sensor", options->sensor, "A sensor file or the name of a bundled one")->required();
  command->add_option("--conversion-gain", options->conversion_gain,
                      "Of a sensor with several: its name; default: the first");
  command->add_option("--gain", options->gain, "Analog gain")->capture_default_str();
  command->add_option("--channel", options->channel, "Default: green, or the first");
  options->outputs.add_to(*command);
}

void add_measure_noise(CLI::App& measure, Shared& shared) {
  auto options = std::make_shared<NoiseCommand>();
  CLI::App* command =
      add_command(measure, shared, "noise", "Gain, noise and range from pairs of raw files of uniform light",
                  "petzval measure noise dark1.dng dark2.dng dim1.dng dim2.dng bright1.dng bright2.dng", true,
                  [options, &shared] { measure_noise(*options, shared); });
  command->add_option("raws", options->raws, "RAW.dng, in pairs of the same light: the dark pair first")
      ->required();
  command->add_option("--channel", options->channel, "Default: green, or the first");
  options->outputs.add_to(*command);
}

}  // namespace petzval::app
