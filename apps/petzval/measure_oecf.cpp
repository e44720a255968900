// SPDX-License-Identifier: BSD-3-Clause
// petzval measure oecf: what a camera makes of the greys of a chart, and their noise.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/colour/illuminants.h>
#include <petzval/measure/oecf.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/simulate/outputs.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "measure_command.h"

namespace petzval::app {

namespace {

using nlohmann::ordered_json;

struct OecfCommand {
  std::vector<std::string> pictures;
  std::string patches, channel, light = "D65";
  MeasureOutputs outputs;
};

Oecf measured(const OecfCommand& command) {
  const bool raw = is_raw_name(command.pictures.front());
  for (const std::string& path : command.pictures)
    if (is_raw_name(path) != raw)
      throw InputError(path, "raw files and pictures are not exposures of one kind");
  if (!raw && !command.channel.empty())
    throw InputError("--channel is for raw files; the noise of pictures is that of all their channels");
  if (raw && command.patches.empty())
    throw InputError("a chart is found in developed pictures; --patches says where it is in raw files");
  const std::vector<GreyPatch> patches =
      command.patches.empty() ? colorchecker_greys(command.pictures.front(), illuminant(command.light))
                              : read_grey_patches(command.patches);
  if (!raw) {
    std::vector<ComparablePicture> pictures;
    for (const std::string& path : command.pictures) pictures.push_back(read_comparable_picture(path));
    return measure_oecf(pictures, patches);
  }
  std::vector<RawImage> raws;
  for (const std::string& path : command.pictures) raws.push_back(read_dng(path));
  return measure_oecf(raws, channel_index(raws.front().channels, command.channel), patches);
}

std::vector<std::string> level_names(const Oecf& oecf) {
  std::vector<std::string> names;
  for (const std::string& channel : oecf.channels) names.push_back(channel + "_level");
  return names;
}

Table table_of(const Oecf& oecf) {
  Table table{{{"exposure", "", 6}, {"log10 exposure", "", 4}}, {}};
  for (const std::string& name : level_names(oecf)) table.columns.push_back({name, "", 5});
  for (const char* name : {"incremental gain", "temporal noise", "fixed-pattern noise"})
    table.columns.push_back({name, "", 6});
  for (const char* name : {"total SNR", "temporal SNR", "fixed-pattern SNR"})
    table.columns.push_back({name, "", 3});
  for (const OecfPoint& point : oecf.points) {
    table.rows.push_back({point.patch.exposure, std::log10(point.patch.exposure)});
    auto& row = table.rows.back();
    for (const double value : point.levels) row.push_back(value);
    for (const double value : {point.incremental_gain, point.noise.temporal, point.noise.fixed_pattern,
                               point.total_snr(), point.temporal_snr(), point.fixed_pattern_snr()})
      row.push_back(value);
  }
  return table;
}

Plot plot_of(const Oecf& oecf) {
  Plot plot;
  plot.title = "Opto-electronic conversion function";
  plot.x = {"log₁₀ of the exposure", "", PlotScale::linear, {}, {}};
  plot.y = {"level", "", PlotScale::linear, {}, {}};
  for (std::size_t c = 0; c < oecf.channels.size(); ++c) {
    std::vector<double> x, y;
    for (const OecfPoint& point : oecf.points)
      if (point.patch.exposure > 0)
        x.push_back(std::log10(point.patch.exposure)), y.push_back(point.levels[c]);
    plot.line(oecf.channels[c], x, y);
  }
  return plot;
}

ordered_json json_of(const Oecf& oecf) {
  ordered_json rows = ordered_json::array();
  const std::vector<std::string> names = level_names(oecf);
  for (const OecfPoint& point : oecf.points) {
    ordered_json row = {{"x_px", point.patch.x},
                        {"y_px", point.patch.y},
                        {"width_px", point.patch.width},
                        {"height_px", point.patch.height},
                        {"exposure", point.patch.exposure}};
    for (std::size_t c = 0; c < names.size(); ++c) row[names[c]] = point.levels[c];
    row["incremental_gain"] = point.incremental_gain;
    row["temporal_noise"] = point.noise.temporal;
    row["fixed_pattern_noise"] = point.noise.fixed_pattern;
    row["total_snr"] = point.total_snr();
    row["temporal_snr"] = point.temporal_snr();
    row["fixed_pattern_snr"] = point.fixed_pattern_snr();
    row["clipped"] = point.clipped;
    rows.push_back(row);
  }
  return {{"white_level", oecf.white},
          {"saturation_exposure", oecf.saturation_exposure},
          {"saturates", oecf.saturates},
          {"least_exposure", oecf.least_exposure},
          {"dynamic_range_db", 20 * std::log10(oecf.dynamic_range())},
          {"rows", rows}};
}

void measure_oecf_of(const OecfCommand& command, const Shared& shared) {
  command.outputs.check();
  const Oecf oecf = measured(command);
  command.outputs.write(table_of(oecf), plot_of(oecf));
  if (shared.json) return fmt::print("{}\n", json_of(oecf).dump(2));
  fmt::print("{:>10}  {:<{}}{:>10}{:>12}{:>12}{:>8}\n", "exposure",
             fmt::format("{}", fmt::join(oecf.channels, ", ")), 10 * oecf.channels.size(), "gain", "temporal",
             "fixed", "S/N");
  for (const OecfPoint& point : oecf.points) {
    fmt::print("{:>10.4g}", point.patch.exposure);
    for (const double level : point.levels) fmt::print("{:>10.5g}", level);
    if (point.clipped)
      fmt::print("    clipped\n");
    else
      fmt::print("{:>12.4g}{:>12.3g}{:>12.3g}{:>8.1f}\n", point.incremental_gain, point.noise.temporal,
                 point.noise.fixed_pattern, point.total_snr());
  }
  const double range = oecf.dynamic_range();
  fmt::print("dynamic range {}{:.1f} dB, {:.1f} stops: {:.4g} over {:.3g}\n", oecf.saturates ? "" : "above ",
             20 * std::log10(range), std::log2(range), oecf.saturation_exposure, oecf.least_exposure);
}

}  // namespace

void add_measure_oecf(CLI::App& measure, Shared& shared) {
  auto options = std::make_shared<OecfCommand>();
  CLI::App* command =
      add_command(measure, shared, "oecf", "Levels and noise of a chart's greys as ISO 14524 and 15739 ask",
                  "petzval measure oecf first.png second.png --csv oecf.csv", true,
                  [options, &shared] { measure_oecf_of(*options, shared); });
  command
      ->add_option("pictures", options->pictures,
                   "Exposures of one chart, two at least: RAW.dng, or .png, .tif")
      ->required();
  command->add_option(
      "--patches", options->patches,
      "Where greys are: .csv of x_px,y_px,width_px,height_px,exposure; default: the greys of a "
      "ColorChecker that is found");
  command->add_option("--light", options->light, "That a ColorChecker was seen under")->capture_default_str();
  command->add_option("--channel", options->channel, "Of raw files; default: green, or the first");
  options->outputs.add_to(*command);
}

}  // namespace petzval::app
