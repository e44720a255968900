// SPDX-License-Identifier: BSD-3-Clause
// petzval measure matrix, shading, colour, scielab.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/staged_files.h>
#include <petzval/colour/illuminants.h>
#include <petzval/image/formats/npy.h>
#include <petzval/measure/chart_scielab.h>
#include <petzval/measure/colour_chart.h>
#include <petzval/measure/scielab.h>
#include <petzval/sensor/colour_calibration.h>
#include <petzval/sensor/formats/dng.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "measure_command.h"
#include "output_option.h"

namespace petzval::app {

namespace {

using nlohmann::ordered_json;

struct ColourCommand {
  std::string picture, light = "D65";
  std::vector<double> corners;
  bool keep_exposure = false;
  std::optional<double> distance_mm;  ///< with S-CIELAB
  double pitch_um = 250;
  MeasureOutputs outputs;
};

struct ScielabCommand {
  std::string a, b, map;
  double distance_mm = 500, pitch_um = 250;
};

struct MatrixCommand {
  std::string sensor;
  std::vector<std::string> lights = {"D65", "D50", "A"};
  MeasureOutputs outputs;
};

struct ShadingCommand {
  std::string raw;
  int cells = 9;
  MeasureOutputs outputs;
};

// ---- colour

/// \param scielab  of each patch, or nothing.
Table table_of(const ChartDifference& difference, const std::vector<double>& scielab) {
  Table table{{{"patch", "", 0},
               {"x", "px", 1},
               {"y", "px", 1},
               {"L* seen", "", 2},
               {"a* seen", "", 2},
               {"b* seen", "", 2},
               {"L* wanted", "", 2},
               {"a* wanted", "", 2},
               {"b* wanted", "", 2},
               {"DE*ab", "", 2},
               {"DE2000", "", 2}},
              {}};
  for (const PatchDifference& patch : difference.patches)
    table.rows.push_back({patch.name, patch.x, patch.y, patch.seen.l, patch.seen.a, patch.seen.b,
                          patch.wanted.l, patch.wanted.a, patch.wanted.b, patch.delta_e_ab,
                          patch.delta_e_2000});
  if (scielab.empty()) return table;
  table.columns.push_back({"S-CIELAB", "", 2});
  for (std::size_t i = 0; i < table.rows.size(); ++i) table.rows[i].push_back(scielab[i]);
  return table;
}

/// Where the colours lie and where they should.
Plot plot_of(const ChartDifference& difference) {
  Plot plot;
  plot.title = fmt::format("ColorChecker: mean ΔE2000 {:.2f}", difference.mean_delta_e_2000);
  plot.x = {"a*", "", PlotScale::linear, {}, {}};
  plot.y = {"b*", "", PlotScale::linear, {}, {}};
  plot.equal_aspect = true;
  std::vector<double> wx, wy, sx, sy;
  for (const PatchDifference& patch : difference.patches) {
    wx.push_back(patch.wanted.a), wy.push_back(patch.wanted.b);
    sx.push_back(patch.seen.a), sy.push_back(patch.seen.b);
  }
  plot.scatter("chart", wx, wy);
  plot.scatter("picture", sx, sy);
  plot.series.back().marker = PlotMarker::cross;
  return plot;
}

void measure_colour(const ColourCommand& command, const Shared& shared) {
  command.outputs.check();
  const ViewedPicture picture = read_viewed_picture(command.picture);
  const Spectrum light = illuminant(command.light);
  ChartCorners corners;
  if (command.corners.empty()) {
    corners = find_chart(picture, light);
  } else {
    if (command.corners.size() != 8)
      throw InputError(
          fmt::format("--corners has {} numbers; 8 would be right: x,y of the centres of dark skin, bluish "
                      "green, black and white",
                      command.corners.size()));
    for (std::size_t i = 0; i < 8; ++i) corners.xy[i / 2][i % 2] = command.corners[i];
  }
  const ChartDifference difference = compare_chart(picture, corners, light, !command.keep_exposure);
  std::vector<double> seen;
  if (command.distance_mm)
    seen = chart_scielab(picture, corners, difference, light,
                         pixels_per_degree(*command.distance_mm, command.pitch_um));
  const double mean_seen = std::accumulate(seen.begin(), seen.end(), 0.0) /
                           static_cast<double>(std::max<std::size_t>(1, seen.size()));
  command.outputs.write(table_of(difference, seen), plot_of(difference));
  if (shared.json) {
    ordered_json rows = ordered_json::array();
    for (const PatchDifference& patch : difference.patches)
      rows.push_back({{"patch", patch.name},
                      {"x_px", patch.x},
                      {"y_px", patch.y},
                      {"l_seen", patch.seen.l},
                      {"a_seen", patch.seen.a},
                      {"b_seen", patch.seen.b},
                      {"l_wanted", patch.wanted.l},
                      {"a_wanted", patch.wanted.a},
                      {"b_wanted", patch.wanted.b},
                      {"delta_e_ab", patch.delta_e_ab},
                      {"delta_e_2000", patch.delta_e_2000}});
    for (std::size_t i = 0; i < seen.size(); ++i) rows[i]["scielab"] = seen[i];
    ordered_json json = {{"mean_delta_e_ab", difference.mean_delta_e_ab},
                         {"mean_delta_e_2000", difference.mean_delta_e_2000},
                         {"max_delta_e_2000", difference.max_delta_e_2000},
                         {"exposure", difference.exposure},
                         {"found", command.corners.empty()},
                         {"rows", rows}};
    if (!seen.empty()) json["mean_scielab"] = mean_seen;
    return fmt::print("{}\n", json.dump(2));
  }
  fmt::print("{:<16}{:>8}{:>8}{:>9}{:>9}{}\n", "patch", "x [px]", "y [px]", "DE*ab", "DE2000",
             seen.empty() ? "" : "  S-CIELAB");
  for (std::size_t i = 0; i < difference.patches.size(); ++i) {
    const PatchDifference& patch = difference.patches[i];
    fmt::print("{:<16}{:>8.1f}{:>8.1f}{:>9.2f}{:>9.2f}{}\n", patch.name, patch.x, patch.y, patch.delta_e_ab,
               patch.delta_e_2000, seen.empty() ? "" : fmt::format("{:>10.2f}", seen[i]));
  }
  if (!seen.empty())
    fmt::print("mean S-CIELAB {:.2f}, from {:g} mm at {:g} um a pixel of the display\n", mean_seen,
               *command.distance_mm, command.pitch_um);
  fmt::print("mean DE*ab {:.2f}, mean DE2000 {:.2f}, max DE2000 {:.2f}, luminance times {:.4g}\n",
             difference.mean_delta_e_ab, difference.mean_delta_e_2000, difference.max_delta_e_2000,
             difference.exposure);
}

// ---- S-CIELAB

void measure_scielab(const ScielabCommand& command, const Shared& shared) {
  const double per_degree = pixels_per_degree(command.distance_mm, command.pitch_um);
  const ScielabDifference difference =
      scielab(read_viewed_picture(command.a), read_viewed_picture(command.b), per_degree);
  if (!command.map.empty()) {
    require_extension(command.map, {".npy"}, "the map of differences");
    const std::size_t shape[] = {static_cast<std::size_t>(difference.rows),
                                 static_cast<std::size_t>(difference.columns)};
    write_npy(command.map, shape, difference.delta_e);
  }
  if (shared.json) {
    const ordered_json row = {{"mean", difference.mean},
                              {"percentile_95", difference.percentile_95},
                              {"max", difference.max},
                              {"pixels_per_degree", per_degree}};
    return fmt::print("{}\n", ordered_json{{"rows", ordered_json::array({row})}}.dump(2));
  }
  fmt::print("S-CIELAB at {:.1f} pixels a degree: mean DE {:.3f}, 95 % below {:.3f}, max {:.3f}\n",
             per_degree, difference.mean, difference.percentile_95, difference.max);
}

// ---- colour matrix

void measure_matrix(const MatrixCommand& command, const Shared& shared) {
  command.outputs.check();
  const Sensor sensor = read_sensor(command.sensor);
  Table table{{{"light", "", 0}, {"mean DE2000", "", 3}, {"max DE2000", "", 3}}, {}};
  ordered_json rows = ordered_json::array();
  for (const std::string& light : command.lights) {
    const ColourFit fit = fit_colour(sensor, illuminant(light));
    table.rows.push_back({light, fit.mean_delta_e_2000, fit.max_delta_e_2000});
    rows.push_back({{"light", light},
                    {"mean_delta_e_2000", fit.mean_delta_e_2000},
                    {"max_delta_e_2000", fit.max_delta_e_2000},
                    {"noise_delta_e_ab", fit.noise_delta_e_ab},
                    {"neutral", fit.neutral},
                    {"xyz_from_camera", fit.xyz_from_camera}});
  }
  command.outputs.write(table, {});
  if (shared.json) return fmt::print("{}\n", ordered_json{{"rows", rows}}.dump(2));
  fmt::print("{}: the 24 patches of a ColorChecker through the best matrix for each light\n", sensor.name);
  for (const auto& row : rows)
    fmt::print("  {:<8} mean DE2000 {:.2f}, max {:.2f}\n", row["light"].get<std::string>(),
               row["mean_delta_e_2000"].get<double>(), row["max_delta_e_2000"].get<double>());
}

// ---- shading

/// Mean of a channel in a grid of cells, over that of the middle cell.
Table shading_table(const RawImage& raw, int cells) {
  Table table{{{"channel", "", 0}, {"row", "", 0}, {"column", "", 0}, {"relative level", "", 4}}, {}};
  for (std::size_t channel = 0; channel < raw.channels.size(); ++channel) {
    const auto count = static_cast<std::size_t>(cells);
    std::vector<double> sums(count * count), counts(count * count);
    for (int row = 0; row < raw.rows; ++row)
      for (int column = 0; column < raw.columns; ++column) {
        if (raw.mosaic.channel(row, column) != static_cast<int>(channel)) continue;
        const std::size_t cell =
            static_cast<std::size_t>(row) * count / static_cast<std::size_t>(raw.rows) * count +
            static_cast<std::size_t>(column) * count / static_cast<std::size_t>(raw.columns);
        sums[cell] += raw.pixel(row, column) - raw.black_level;
        counts[cell] += 1;
      }
    const std::size_t middle = count / 2 * count + count / 2;
    if (!(counts[middle] > 0 && sums[middle] > 0))
      throw InputError("the middle of the raw image is black, or too small for so many cells");
    for (std::size_t cell = 0; cell < sums.size(); ++cell)
      if (counts[cell] > 0)
        table.rows.push_back({raw.channels[channel], static_cast<double>(cell / count),
                              static_cast<double>(cell % count),
                              sums[cell] / counts[cell] / (sums[middle] / counts[middle])});
  }
  return table;
}

void measure_shading(const ShadingCommand& command, const Shared& shared) {
  command.outputs.check();
  const RawImage raw = read_dng(command.raw);
  const Table table = shading_table(raw, command.cells);
  command.outputs.write(table, {});
  if (shared.json) {
    ordered_json rows = ordered_json::array();
    for (const auto& row : table.rows)
      rows.push_back({{"channel", std::get<std::string>(row[0])},
                      {"row", std::get<double>(row[1])},
                      {"column", std::get<double>(row[2])},
                      {"relative_level", std::get<double>(row[3])}});
    return fmt::print("{}\n", ordered_json{{"rows", rows}}.dump(2));
  }
  fmt::print("level in {0} x {0} cells over that of the middle one\n", command.cells);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (std::get<double>(table.rows[i][1]) == 0 && std::get<double>(table.rows[i][2]) == 0)
      fmt::print("{}\n", std::get<std::string>(table.rows[i][0]));
    fmt::print("{:>8.4f}{}", std::get<double>(table.rows[i][3]),
               std::get<double>(table.rows[i][2]) == command.cells - 1 ? "\n" : "");
  }
}

}  // namespace

void add_measure_matrix(CLI::App& measure, Shared& shared) {
  auto options = std::make_shared<MatrixCommand>();
  CLI::App* command =
      add_command(measure, shared, "matrix", "How well a matrix can make colours of a sensor's channels",
                  "petzval measure matrix full-frame-24mp --lights D65,A", true,
                  [options, &shared] { measure_matrix(*options, shared); });
  command->add_option("sensor", options->sensor, "A sensor file or the name of a bundled one")->required();
  command->add_option("--lights", options->lights, "Illuminants")->delimiter(',')->capture_default_str();
  options->outputs.add_to(*command, false);
}

void add_measure_shading(CLI::App& measure, Shared& shared) {
  auto options = std::make_shared<ShadingCommand>();
  CLI::App* command =
      add_command(measure, shared, "shading", "How the level falls off over a raw file of a uniform surface",
                  "petzval measure shading raw.dng --cells 5", true,
                  [options, &shared] { measure_shading(*options, shared); });
  command->add_option("raw", options->raw, "RAW.dng")->required();
  command->add_option("--cells", options->cells, "Along each side")
      ->check(CLI::Range(1, 101))
      ->capture_default_str();
  options->outputs.add_to(*command, false);
}

void add_measure_colour(CLI::App& measure, Shared& shared) {
  auto options = std::make_shared<ColourCommand>();
  CLI::App* command =
      add_command(measure, shared, "colour", "Colour differences of a ColorChecker in a picture",
                  "petzval measure colour chart.png --light D65", true,
                  [options, &shared] { measure_colour(*options, shared); });
  command->add_option("picture", options->picture, "A picture with a ColorChecker: .png, .tif")->required();
  command->add_option("--light", options->light, "That the chart was seen under")->capture_default_str();
  command
      ->add_option("--corners", options->corners,
                   "Centres of dark skin, bluish green, black, white: x,y,x,y,x,y,x,y [px]; default: found")
      ->delimiter(',');
  command->add_flag("--keep-exposure", options->keep_exposure,
                    "Do not match the luminance of the greys first");
  CLI::Option* distance =
      command
          ->add_option(
              "--distance", options->distance_mm,
              "S-CIELAB of each patch too, noise included, for an eye at this distance from the display [mm]")
          ->check(positive_number());
  command->add_option("--pixel-pitch", options->pitch_um, "Of the display [um]")
      ->check(positive_number())
      ->needs(distance)
      ->capture_default_str();
  options->outputs.add_to(*command);
}

void add_measure_scielab(CLI::App& measure, Shared& shared) {
  auto options = std::make_shared<ScielabCommand>();
  CLI::App* command = add_command(measure, shared, "scielab",
                                  "Difference of two pictures as an eye at a distance sees it (S-CIELAB)",
                                  "petzval measure scielab a.png b.png --distance 600 --pixel-pitch 250",
                                  true, [options, &shared] { measure_scielab(*options, shared); });
  command->add_option("a", options->a, "A picture: .png, .tif")->required();
  command->add_option("b", options->b, "Another of its size")->required();
  command->add_option("--distance", options->distance_mm, "Of the eye from the display [mm]")
      ->check(positive_number())
      ->capture_default_str();
  command->add_option("--pixel-pitch", options->pitch_um, "Of the display [um]")
      ->check(positive_number())
      ->capture_default_str();
  command->add_option("--map", options->map, "Write the difference of each pixel as .npy")
      ->check(output_file());
}

}  // namespace petzval::app
