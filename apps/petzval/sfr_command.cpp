// SPDX-License-Identifier: BSD-3-Clause
// petzval sfr: spatial frequency response from slanted edges.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/staged_files.h>
#include <petzval/base/whole_file.h>
#include <petzval/measure/sfr/measure_picture.h>
#include <petzval/report/sfr_page.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>

#include "output_option.h"
#include "picture_list.h"
#include "plot_output.h"
#include "sfr_output.h"
#include "target_optics.h"

namespace petzval::app {

namespace {

struct SfrCommand {
  std::vector<std::string> pictures;
  bool demosaic = false;
  std::string chart, channel = "luminance", bayer, transfer = "stated", method = "exact";
  std::string csv, plot, profile, annotate, map, over_height, report;
  std::vector<std::string> rois, against;
  std::string chart_size, focus_along;
  std::optional<double> pitch_um, chart_tilt_deg;
  int edge_order = 0;
};

PixelBox box_of(const std::string& text) {
  int numbers[4] = {};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int i = 0; i < 4; ++i) {
    const auto [next, error] = std::from_chars(at, end, numbers[i]);
    if (error != std::errc() || (i < 3 ? next == end || *next != ',' : next != end))
      throw InputError(fmt::format("--roi {}: X,Y,WIDTH,HEIGHT in whole pixels are right", text));
    at = next + 1;
  }
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

void check_outputs(const SfrCommand& command, bool single) {
  if (!command.chart.empty() && !command.rois.empty())
    throw InputError("give either --roi, for edges at known places, or --chart auto, to find them");
  for (const auto& [path, extensions, what] :
       {std::tuple{command.csv, std::vector<std::string>{".csv"}, "a table"},
        {command.annotate, {".svg"}, "an annotated picture"}})
    if (!path.empty()) require_extension(path, extensions, what);
  if (!command.plot.empty()) require_drawing(command.plot, "a plot");
  if (!command.profile.empty()) require_drawing(command.profile, "a profile", {".csv"});
  if (!command.map.empty()) require_drawing(command.map, "a map");
  if (!command.over_height.empty()) require_drawing(command.over_height, "a plot");
  if (!command.report.empty()) require_extension(command.report, {".html", ".htm"}, "a report");
  if (!command.against.empty() && command.plot.empty())
    throw InputError("--against draws into --plot; give both");
  for (const auto& [path, option] : {std::pair{command.annotate, "--annotate"},
                                     {command.map, "--map"},
                                     {command.over_height, "--over-height"},
                                     {command.report, "--report"}})
    if (!path.empty() && !single)
      throw InputError(fmt::format("{} shows one picture; name one file, not several or a folder", option));
}

PictureTransfer transfer_of(const SfrCommand& command) {
  return command.transfer == "srgb"     ? PictureTransfer::srgb
         : command.transfer == "linear" ? PictureTransfer::linear
                                        : PictureTransfer::stated;
}

/// How code values became light, for files that have them.
std::string light_of(const PicturePlanes& picture, bool asked) {
  if (picture.bits == 0 || !picture.bayer.empty()) return "";
  return fmt::format("{}, {}", picture.srgb ? "sRGB" : "linear",
                     picture.assumed ? "assumed"
                     : asked         ? "as asked"
                                     : "as the file says");
}

struct MeasuredPicture {
  SfrReport report;
  Plane luminance;
};

MeasuredPicture measured(const SfrCommand& command, const SfrRequest& request, const std::string& path,
                         const Shared& shared) {
  const PictureTransfer transfer = transfer_of(command);
  const PicturePlanes picture = read_picture_planes(path, transfer, command.demosaic);
  SfrReport report{path,
                   light_of(picture, transfer != PictureTransfer::stated),
                   picture.columns,
                   picture.rows,
                   command.pitch_um,
                   measure_sfr(picture, request, path, context_of(shared)),
                   request.chart_mm};
  if (picture.assumed && picture.bits == 16)
    note(shared, fmt::format("{}: numbers of 16 bits that say nothing of themselves are taken for sRGB; "
                             "--transfer linear is right if they are linear in light, --transfer srgb says "
                             "that they are not",
                             path));
  return {std::move(report),
          command.annotate.empty() && command.report.empty() ? Plane{} : picture.luminance()};
}

/// Map, profile and report of one picture.
void write_frame(const SfrCommand& command, const SfrReport& report, const Plane& seen, StagedFiles& files) {
  if (command.map.empty() && command.over_height.empty() && command.report.empty()) return;
  const SfrPage page{std::filesystem::path(report.image).filename().string(),
                     report.columns,
                     report.rows,
                     report.pitch_um,
                     report.edges,
                     command.report.empty() ? std::string() : annotated_edges_svg(report.edges, seen)};
  if (!command.map.empty()) write_drawing(files.stage(command.map), sharpness_map_svg(page), command.map);
  if (!command.over_height.empty())
    write_drawing(files.stage(command.over_height), sharpness_profile_svg(page), command.over_height);
  if (!command.report.empty()) write_whole_file(files.stage(command.report), sfr_page_html(page));
}

void run(const SfrCommand& command, const Shared& shared) {
  const std::vector<std::string> paths = pictures_in(command.pictures, measurable_extensions());
  SfrReports reports;
  if (!command.focus_along.empty()) reports.focus = {command.focus_along[0], command.chart_tilt_deg};
  reports.single = command.pictures.size() == 1 && paths == command.pictures;
  check_outputs(command, reports.single);
  std::vector<NamedCurve> others;
  for (const std::string& path : command.against) others.push_back(read_sfr_table(path));
  SfrRequest request{{}, command.channel, command.bayer, command.edge_order, command.method == "iso"};
  if (!command.chart_size.empty()) {
    const auto [width, height] = pair_of(command.chart_size, 'x', "--chart-size");
    request.chart_mm = std::array{width, height};
  }
  for (const std::string& text : command.rois) request.rois.push_back(box_of(text));
  Plane seen;
  for (const std::string& path : paths) {
    try {
      MeasuredPicture picture = measured(command, request, path, shared);
      reports.pictures.push_back(std::move(picture.report));
      seen = std::move(picture.luminance);
    } catch (const InputError& error) {
      if (reports.single) throw;
      reports.failed.emplace_back(path, error.what());
    }
  }
  for (const auto& [path, reason] : reports.failed) note(shared, "left out: " + reason);
  if (reports.pictures.empty())
    throw InputError(fmt::format("none of the {} pictures could be measured; the first: {}", paths.size(),
                                 reports.failed.front().second));
  StagedFiles files;
  if (!command.csv.empty()) write_sfr_csv(files.stage(command.csv), reports);
  if (!command.plot.empty())
    write_drawing(files.stage(command.plot), sfr_plot_svg(reports, others), command.plot);
  if (is_drawing_name(command.profile))
    write_drawing(files.stage(command.profile), profile_plot_svg(reports), command.profile);
  if (command.profile.ends_with(".csv")) write_profile_csv(files.stage(command.profile), reports);
  if (!command.annotate.empty())
    write_whole_file(files.stage(command.annotate),
                     annotated_edges_svg(reports.pictures.front().edges, seen));
  write_frame(command, reports.pictures.front(), seen, files);
  files.commit();
  print_sfr(reports, shared);
}

}  // namespace

void add_sfr_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<SfrCommand>();
  CLI::App* command =
      add_command(app, shared, "sfr", "Spatial frequency response from slanted edges in a picture",
                  "petzval sfr edges.png --chart auto --csv sfr.csv --plot sfr.svg", true,
                  [=, &shared] { run(*options, shared); });
  command
      ->add_option(
          "image", options->pictures,
          "Pictures, or folders of them: .png, .jpg, .tif, .npy, .exr, .dng or a camera's raw files (.nef, "
          ".cr2, .arw, ...); several make one table")
      ->required();
  command->add_option("--roi", options->rois, "X,Y,WIDTH,HEIGHT around one edge [pixels] (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command
      ->add_option("--chart", options->chart,
                   "auto (the default without --roi): every straight edge that stands out")
      ->check(CLI::IsMember({"auto"}));
  command->add_option(
      "--chart-size", options->chart_size,
      "The picture shows a chart of target --size WxHmm: places on it and cycles/mm there [mm]");
  CLI::Option* along =
      command
          ->add_option(
              "--focus-along", options->focus_along,
              "x or y: the chart is tilted, and sharpest where along this axis? In mm with --chart-size, "
              "else in pixels; by the edges across it")
          ->check(CLI::IsMember({"x", "y"}));
  command
      ->add_option("--chart-tilt", options->chart_tilt_deg,
                   "How far it is tilted [degrees]: the place in depth, too, from the middle of the chart")
      ->needs(along)
      ->check(CLI::Range(1.0, 89.0));
  command->add_option("--channel", options->channel, "luminance, red, green, blue or all")
      ->check(CLI::IsMember({"luminance", "red", "green", "blue", "all"}))
      ->capture_default_str();
  command->add_option("--bayer", options->bayer,
                      "The picture is a mosaic, rggb and so on: each colour for itself");
  command->add_flag("--demosaic", options->demosaic,
                    "Of a raw file, measure the demosaiced picture, not each colour for itself");
  command
      ->add_option("--transfer", options->transfer,
                   "Code values are: stated (as the file says; else sRGB), srgb or linear")
      ->check(CLI::IsMember({"stated", "srgb", "linear"}))
      ->capture_default_str();
  command
      ->add_option(
          "--edge-order", options->edge_order,
          "0: bent as far as the pixels show; 1: straight; up to 5: bent by a polynomial of that order")
      ->check(CLI::Range(0, 5))
      ->capture_default_str();
  command
      ->add_option("--method", options->method,
                   "exact, or iso: as common slanted-edge tools compute, for comparison")
      ->check(CLI::IsMember({"exact", "iso"}))
      ->capture_default_str();
  command->add_option("--pixel-pitch", options->pitch_um, "Pixel pitch [um], for results in lp/mm")
      ->check(positive_number());
  command->add_option("--csv", options->csv, "Write the SFR table: .csv")->check(output_file());
  command->add_option("--plot", options->plot, "Draw the SFRs: .svg, .png or .pdf")->check(output_file());
  command
      ->add_option(
          "--against", options->against,
          "Draw another SFR into --plot: a .csv with columns frequency_cpp and sfr, of --csv or of target "
          "--exact-sfr; its first edge (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command
      ->add_option("--profile", options->profile,
                   "Write edge and line spread: .csv, or draw the edge spread: .svg")
      ->check(output_file());
  command
      ->add_option("--map", options->map,
                   "Draw MTF50 over the frame, meridional and sagittal: .svg, .png or .pdf")
      ->check(output_file());
  command
      ->add_option("--over-height", options->over_height,
                   "Draw MTF50 over the image height, meridional and sagittal: .svg, .png or .pdf")
      ->check(output_file());
  command
      ->add_option("--report", options->report,
                   "Write a page with map, profile, lateral colour and all edges: .html")
      ->check(output_file());
  command
      ->add_option("--annotate", options->annotate, "Draw the picture with its edges and their MTF50: .svg")
      ->check(output_file());
}

}  // namespace petzval::app
