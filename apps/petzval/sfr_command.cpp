// SPDX-License-Identifier: BSD-3-Clause
// petzval sfr: spatial frequency response from slanted edges.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/staged_files.h>
#include <petzval/measure/sfr/picture_planes.h>

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

/// One channel to measure: a plane and the pixels of it that count.
struct Channel {
  std::string name;
  Plane plane;
  std::vector<PixelLattice> lattices{{}};
};

std::vector<Channel> bayer_channels(const SfrCommand& command, const PicturePlanes& picture) {
  std::string pattern = command.bayer;
  std::transform(pattern.begin(), pattern.end(), pattern.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (pattern != "rggb" && pattern != "bggr" && pattern != "grbg" && pattern != "gbrg")
    throw InputError(fmt::format("--bayer {}: rggb, bggr, grbg or gbrg is right", command.bayer));
  if (picture.planes.size() != 1)
    throw InputError(command.image, "a mosaic has one plane; this picture has several");
  std::vector<Channel> channels;
  for (const auto& [letter, name] : {std::pair{'r', "red"}, {'g', "green"}, {'b', "blue"}}) {
    if (command.channel != "all" && command.channel != "luminance" && command.channel != name) continue;
    Channel channel{name, picture.planes[0], {}};
    for (int i = 0; i < 4; ++i)
      if (pattern[static_cast<std::size_t>(i)] == letter) channel.lattices.push_back({2, i % 2, i / 2});
    channels.push_back(std::move(channel));
  }
  return channels;
}

std::vector<Channel> channels_of(const SfrCommand& command, const PicturePlanes& picture) {
  if (!command.bayer.empty()) return bayer_channels(command, picture);
  if (command.channel == "luminance") return {{"", picture.luminance()}};
  if (!picture.rgb && command.channel != "all")
    throw InputError(
        command.image,
        fmt::format("--channel {} of a picture that is not RGB; leave it out, or take --channel all",
                    command.channel));
  std::vector<Channel> channels;
  const std::vector<std::string> names{"red", "green", "blue"};
  for (std::size_t c = 0; c < picture.planes.size(); ++c) {
    const std::string name = picture.rgb ? names[c] : fmt::format("band {}", c + 1);
    if (command.channel == "all" || command.channel == name) channels.push_back({name, picture.planes[c]});
  }
  return channels;
}

PixelBox box_around(const std::vector<EdgeSample>& samples) {
  double left = HUGE_VAL, top = HUGE_VAL, right = 0, bottom = 0;
  for (const EdgeSample& s : samples)
    left = std::min(left, s.x), right = std::max(right, s.x), top = std::min(top, s.y),
    bottom = std::max(bottom, s.y);
  const int x = static_cast<int>(left), y = static_cast<int>(top);
  return {x, y, static_cast<int>(right) - x + 1, static_cast<int>(bottom) - y + 1};
}

class Measurement {
 public:
  Measurement(const SfrCommand& command, const PicturePlanes& picture, const std::vector<Channel>& channels,
              const Shared& shared)
      : command_(command), channels_(channels), shared_(shared), guide_(picture.luminance()) {
    options_.edge_order = command.edge_order;
    options_.clip_low = picture.clip_low, options_.clip_high = picture.clip_high;
    options_.code_levels = picture.code_levels;
    if (!command.bayer.empty()) guide_ = smoothed(guide_);
    try {
      found_ = find_edges(guide_);
    } catch (const InputError&) {
      if (command.rois.empty()) throw;  // with an ROI the surroundings are not needed
    }
  }

  std::vector<MeasuredEdge> run() const {
    struct Job {
      std::optional<PixelBox> box;
      const FoundEdge* edge;
    };
    std::vector<Job> jobs;
    for (const std::string& text : command_.rois) jobs.push_back({box_of(text), nullptr});
    if (command_.rois.empty())
      for (const FoundEdge& edge : found_.edges) jobs.push_back({std::nullopt, &edge});
    std::vector<std::vector<MeasuredEdge>> results(jobs.size());
    std::vector<std::string> faults(jobs.size());
    parallel_for(jobs.size(), [&](std::size_t i) {
      try {
        results[i] = jobs[i].box ? in_box(*jobs[i].box) : along(*jobs[i].edge);
      } catch (const InputError& error) {
        // Of many found edges some may be unfit; an ROI that was asked for may not.
        if (jobs[i].box)
          throw InputError(command_.image, fmt::format("--roi {}: {}", command_.rois[i], error.what()));
        faults[i] = error.what();
      }
    });
    std::vector<MeasuredEdge> edges;
    for (auto& result : results) std::move(result.begin(), result.end(), std::back_inserter(edges));
    if (edges.empty()) throw InputError(command_.image, faults.empty() ? "no edge" : faults.front());
    for (std::size_t i = 0; i < jobs.size(); ++i)
      if (!faults[i].empty())
        note(shared_, fmt::format("{}: the edge from {:.0f},{:.0f} to {:.0f},{:.0f} is left out: {}",
                                  command_.image, jobs[i].edge->from.x, jobs[i].edge->from.y,
                                  jobs[i].edge->to.x, jobs[i].edge->to.y, faults[i]));
    return edges;
  }

 private:
  /// A mosaic's pixels averaged by fours, so that contours do not follow its colours.
  static Plane smoothed(const Plane& plane) {
    Plane result = plane;
    for (int r = 0; r + 1 < plane.rows; ++r)
      for (int c = 0; c + 1 < plane.columns; ++c)
        result.values[static_cast<std::size_t>(r) * static_cast<std::size_t>(plane.columns) +
                      static_cast<std::size_t>(c)] =
            (plane.at(c, r) + plane.at(c + 1, r) + plane.at(c, r + 1) + plane.at(c + 1, r + 1)) / 4;
    return result;
  }

  EdgeMeasurement measure(const Channel& channel, std::vector<EdgeSample> samples,
                          const FoundEdge* edge) const {
    SfrOptions options = options_;
    if (edge != nullptr) {
      options.start = edge->line();
      options.missing_target = [=](double x, double y) { return missing_target_at(*edge, x, y); };
    }
    return measure_edge(std::move(samples), channel.lattices.front().step, options);
  }

  static std::vector<EdgeSample> merged(
      const Channel& channel, const std::function<std::vector<EdgeSample>(const PixelLattice&)>& of) {
    std::vector<EdgeSample> samples;
    for (const PixelLattice& lattice : channel.lattices) {
      const std::vector<EdgeSample> some = of(lattice);
      samples.insert(samples.end(), some.begin(), some.end());
    }
    return samples;
  }

  std::vector<MeasuredEdge> in_box(const PixelBox& box) const {
    std::vector<MeasuredEdge> edges;
    for (const Channel& channel : channels_) {
      const auto samples = merged(
          channel, [&](const PixelLattice& lattice) { return samples_in(channel.plane, box, lattice); });
      MeasuredEdge edge{channel.name, box, measure(channel, samples, nullptr), {}, {}};
      if (const FoundEdge* known = edge_along(found_, edge.exact.line))
        edge.exact = measure(channel, samples, known);
      if (command_.method == "iso") edge.iso = iso_esfr(channel.plane, box);
      edges.push_back(std::move(edge));
    }
    compare_channels(edges);
    return edges;
  }

  std::vector<MeasuredEdge> along(const FoundEdge& found) const {
    std::vector<MeasuredEdge> edges;
    for (const Channel& channel : channels_) {
      const auto samples = merged(
          channel, [&](const PixelLattice& lattice) { return samples_about(channel.plane, found, lattice); });
      if (samples.size() < 64) throw InputError("an edge with fewer than 64 pixels about it");
      MeasuredEdge edge{channel.name, box_around(samples), measure(channel, samples, &found), {}, {}};
      if (command_.method == "iso") edge.iso = iso_esfr(channel.plane, edge.roi);
      edges.push_back(std::move(edge));
    }
    compare_channels(edges);
    return edges;
  }

  /// Where the other colours' edges lie, from green's.
  static void compare_channels(std::vector<MeasuredEdge>& edges) {
    const auto green =
        std::find_if(edges.begin(), edges.end(), [](const MeasuredEdge& e) { return e.channel == "green"; });
    if (green == edges.end() || edges.size() < 2) return;
    const EdgeLine line = green->exact.line;
    const double middle = green->exact.middle_px;
    for (MeasuredEdge& edge : edges) {
      const EdgeLine& other = edge.exact.line;
      edge.lateral_offset_px =
          line.distance(other.centre_x + edge.exact.middle_px * std::cos(other.normal_rad),
                        other.centre_y + edge.exact.middle_px * std::sin(other.normal_rad)) -
          middle;
    }
  }

  const SfrCommand& command_;
  const std::vector<Channel>& channels_;
  const Shared& shared_;
  Plane guide_;
  SfrOptions options_;
  FoundEdges found_;
};

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
  const std::vector<Channel> channels = channels_of(command, picture);
  SfrReport report{command.image, picture.columns, picture.rows, command.pitch_um,
                   Measurement(command, picture, channels, shared).run()};
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
