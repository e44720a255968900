// SPDX-License-Identifier: BSD-3-Clause
// petzval sfr: spatial frequency response from slanted edges.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/staged_files.h>
#include <petzval/measure/sfr/measure_picture.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include "output_option.h"
#include "sfr_output.h"

namespace petzval::app {

namespace {

struct SfrCommand {
  std::string image, chart, channel = "luminance", bayer, transfer = "stated", method = "exact";
  std::string csv, plot, profile, annotate;
  std::vector<std::string> rois, against;
  std::optional<double> pitch_um;
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

void run(const SfrCommand& command, const Shared& shared) {
  if (!command.chart.empty() && !command.rois.empty())
    throw InputError("give either --roi, for edges at known places, or --chart auto, to find them");
  for (const auto& [path, extensions, what] :
       {std::tuple{command.csv, std::vector<std::string>{".csv"}, "a table"},
        {command.plot, {".svg"}, "a plot"},
        {command.profile, {".csv", ".svg"}, "a profile"},
        {command.annotate, {".svg"}, "an annotated picture"}})
    if (!path.empty()) require_extension(path, extensions, what);
  if (!command.against.empty() && command.plot.empty())
    throw InputError("--against draws into --plot FILE.svg; give both");
  std::vector<NamedCurve> others;
  for (const std::string& path : command.against) others.push_back(read_sfr_table(path));
  const PictureTransfer transfer = command.transfer == "srgb"     ? PictureTransfer::srgb
                                   : command.transfer == "linear" ? PictureTransfer::linear
                                                                  : PictureTransfer::stated;
  const PicturePlanes picture = read_picture_planes(command.image, transfer);
  SfrRequest request{{}, command.channel, command.bayer, command.edge_order, command.method == "iso"};
  for (const std::string& text : command.rois) request.rois.push_back(box_of(text));
  SfrReport report{command.image, picture.columns, picture.rows, command.pitch_um,
                   measure_sfr(picture, request, command.image, context_of(shared))};
  StagedFiles files;
  if (!command.csv.empty()) write_sfr_csv(files.stage(command.csv), report);
  if (!command.plot.empty()) write_sfr_plot(files.stage(command.plot), report, others);
  if (command.profile.ends_with(".svg")) write_profile_plot(files.stage(command.profile), report);
  if (command.profile.ends_with(".csv")) write_profile_csv(files.stage(command.profile), report);
  if (!command.annotate.empty()) write_annotated(files.stage(command.annotate), report, picture.luminance());
  files.commit();
  print_sfr(report, shared);
}

}  // namespace

void add_sfr_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<SfrCommand>();
  CLI::App* command =
      add_command(app, shared, "sfr", "Spatial frequency response from slanted edges in a picture",
                  "petzval sfr edges.png --chart auto --csv sfr.csv --plot sfr.svg", true,
                  [=, &shared] { run(*options, shared); });
  command->add_option("image", options->image, "Picture: .png, .tif, .npy or .exr")->required();
  command->add_option("--roi", options->rois, "X,Y,WIDTH,HEIGHT around one edge [pixels] (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command
      ->add_option("--chart", options->chart,
                   "auto (the default without --roi): every straight edge that stands out")
      ->check(CLI::IsMember({"auto"}));
  command->add_option("--channel", options->channel, "luminance, red, green, blue or all")
      ->check(CLI::IsMember({"luminance", "red", "green", "blue", "all"}))
      ->capture_default_str();
  command->add_option("--bayer", options->bayer,
                      "The picture is a mosaic, rggb and so on: each colour for itself");
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
  command->add_option("--plot", options->plot, "Draw the SFRs: .svg")->check(output_file());
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
      ->add_option("--annotate", options->annotate, "Draw the picture with its edges and their MTF50: .svg")
      ->check(output_file());
}

}  // namespace petzval::app
