// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/measure/sfr/chart_mapping.h>
#include <petzval/measure/sfr/find_edges.h>
#include <petzval/measure/sfr/measure_picture.h>
#include <petzval/measure/sfr/missing_target.h>
#include <petzval/measure/sfr/rounded_blocks.h>
#include <petzval/measure/sfr/stated_deviations.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

namespace petzval {

namespace {

/// One channel to measure: a plane and the pixels of it that count.
struct Channel {
  std::string name;
  Plane plane;
  std::vector<PixelLattice> lattices{{}};
};

/// Of the mosaic: as asked for, else as the picture says; empty for full planes.
const std::string& pattern_of(const SfrRequest& request, const PicturePlanes& picture) {
  return request.bayer.empty() ? picture.bayer : request.bayer;
}

std::vector<Channel> bayer_channels(const SfrRequest& request, const PicturePlanes& picture,
                                    const std::string& name) {
  std::string pattern = pattern_of(request, picture);
  std::transform(pattern.begin(), pattern.end(), pattern.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (pattern != "rggb" && pattern != "bggr" && pattern != "grbg" && pattern != "gbrg")
    throw InputError(fmt::format("`bayer` {}: rggb, bggr, grbg or gbrg is right", request.bayer));
  if (picture.planes.size() != 1) throw InputError(name, "a mosaic has one plane; this picture has several");
  std::vector<Channel> channels;
  for (const auto& [letter, colour] : {std::pair{'r', "red"}, {'g', "green"}, {'b', "blue"}}) {
    if (request.channel != "all" && request.channel != "luminance" && request.channel != colour) continue;
    Channel channel{colour, picture.planes[0], {}};
    for (int i = 0; i < 4; ++i)
      if (pattern[static_cast<std::size_t>(i)] == letter) channel.lattices.push_back({2, i % 2, i / 2});
    channels.push_back(std::move(channel));
  }
  return channels;
}

std::vector<Channel> channels_of(const SfrRequest& request, const PicturePlanes& picture,
                                 const std::string& name) {
  if (!pattern_of(request, picture).empty()) return bayer_channels(request, picture, name);
  if (request.channel == "luminance") return {{"", picture.luminance()}};
  if (!picture.rgb && request.channel != "all")
    throw InputError(name,
                     fmt::format("`channel` {} of a picture that is not RGB; luminance or all would be right",
                                 request.channel));
  std::vector<Channel> channels;
  const std::vector<std::string> names{"red", "green", "blue"};
  for (std::size_t c = 0; c < picture.planes.size(); ++c) {
    const std::string band = picture.rgb ? names[c] : fmt::format("band {}", c + 1);
    if (request.channel == "all" || request.channel == band) channels.push_back({band, picture.planes[c]});
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

/// The upright box about the middle of a found edge's samples that holds none but them, and the edge well
/// inside: that of their bounds would hold other edges, too, where the edge is turned by more than a few
/// degrees.
PixelBox box_within(const FoundEdge& edge, const Plane& plane) {
  const EdgeLine line = edge.line();
  const double along = 0.5 * (edge.sampled_from + edge.sampled_to),
               half = 0.5 * (edge.sampled_to - edge.sampled_from);
  const double reach = std::min(edge.reach_dark_px, edge.reach_bright_px);
  // The direction of the edge is its normal turned by -90 degrees (FoundEdge::line).
  const double c = std::cos(line.normal_rad), s = std::sin(line.normal_rad);
  const double middle_x = line.centre_x + along * s, middle_y = line.centre_y - along * c;
  const double cosine = std::max(std::abs(c), std::abs(s)), sine = std::min(std::abs(c), std::abs(s));
  // Half sizes along and across the edge's nearer axis; the edge leaves the axis by `down` times its tangent.
  constexpr double margin_px = 6, wide_px = 40;
  double best_down = 0, best_across = 0;
  for (int i = 20; i <= 100; ++i) {
    const double down = 0.01 * i * half;
    const double across =
        std::min({(reach - down * sine) / cosine, (half - down * cosine) / std::max(1e-6, sine), wide_px});
    if (across > down * sine / cosine + margin_px && down * across > best_down * best_across)
      best_down = down, best_across = across;
  }
  const bool upright = std::abs(c) > std::abs(s);
  const double half_width = upright ? best_across : best_down,
               half_height = upright ? best_down : best_across;
  const int left = std::max(0, static_cast<int>(std::ceil(middle_x - half_width))),
            top = std::max(0, static_cast<int>(std::ceil(middle_y - half_height)));
  return {left, top, std::min(plane.columns, static_cast<int>(middle_x + half_width)) - left,
          std::min(plane.rows, static_cast<int>(middle_y + half_height)) - top};
}

/// Edges that could not be measured for the same reason.
struct LeftOut {
  std::string reason;  ///< in the first edge's words
  bool all_alike = true;
  std::vector<const FoundEdge*> edges;
};

/// Reasons that differ in their numbers only are one.
std::string without_numbers(const std::string& reason) {
  std::string rest;
  std::ranges::copy_if(reason, std::back_inserter(rest),
                       [](unsigned char c) { return !std::isdigit(c) && c != '.' && c != '-' && c != '+'; });
  return rest;
}

void add_left_out(std::vector<LeftOut>& all, const std::string& reason, const FoundEdge& edge) {
  const auto same = std::ranges::find_if(all, [kind = without_numbers(reason)](const LeftOut& some) {
    return without_numbers(some.reason) == kind;
  });
  LeftOut& some = same == all.end() ? all.emplace_back() : *same;
  if (some.edges.empty()) some.reason = reason;
  some.all_alike = some.all_alike && some.reason == reason;
  some.edges.push_back(&edge);
}

/// A photograph may have hundreds: the first few places say where to look.
std::string note_of(const LeftOut& some) {
  constexpr std::size_t most_places = 3;
  std::string places;
  for (std::size_t i = 0; i < std::min(most_places, some.edges.size()); ++i)
    places += fmt::format("{}{:.0f},{:.0f} to {:.0f},{:.0f}", i == 0 ? "" : "; ", some.edges[i]->from.x,
                          some.edges[i]->from.y, some.edges[i]->to.x, some.edges[i]->to.y);
  if (some.edges.size() == 1) return fmt::format("the edge from {} is left out: {}", places, some.reason);
  if (some.edges.size() > most_places) places += fmt::format("; {} more", some.edges.size() - most_places);
  return fmt::format("{} edges are left out (from {}): {}{}", some.edges.size(), places,
                     some.all_alike ? "" : "of the first, ", some.reason);
}

class Measurement {
 public:
  Measurement(const SfrRequest& request, const PicturePlanes& picture, const std::vector<Channel>& channels,
              const std::string& name)
      : request_(request), name_(name), channels_(channels), guide_(picture.luminance()) {
    options_.edge_order = request.edge_order;
    options_.clip_low = picture.clip_low, options_.clip_high = picture.clip_high;
    options_.code_levels = picture.code_levels;
    if (!picture.coefficient_steps.empty() && pattern_of(request, picture).empty())
      for (const Channel& channel : channels)
        blocks_.emplace_back(channel.plane, picture.coefficient_steps, picture.code_levels);
    if (!pattern_of(request, picture).empty()) guide_ = smoothed(guide_);
    try {
      found_ = find_edges(guide_);
    } catch (const InputError&) {
      if (request.rois.empty()) throw;  // with an ROI the surroundings are not needed
    }
  }

  std::vector<MeasuredEdge> run(const Context& context, const ProgressCallback& progress) const {
    struct Job {
      std::optional<PixelBox> box;
      const FoundEdge* edge;
    };
    std::vector<Job> jobs;
    for (const PixelBox& box : request_.rois) jobs.push_back({box, nullptr});
    if (request_.rois.empty())
      for (const FoundEdge& edge : found_.edges) jobs.push_back({std::nullopt, &edge});
    std::vector<std::vector<MeasuredEdge>> results(jobs.size());
    std::vector<std::string> faults(jobs.size());
    std::atomic<std::size_t> done = 0;
    parallel_for(jobs.size(), [&](std::size_t i) {
      try {
        results[i] = jobs[i].box ? in_box(*jobs[i].box) : along(*jobs[i].edge);
      } catch (const InputError& error) {
        // Of many found edges some may be unfit; an ROI that was asked for may not.
        if (jobs[i].box)
          throw InputError(name_, fmt::format("`roi` {},{},{},{}: {}", jobs[i].box->x, jobs[i].box->y,
                                              jobs[i].box->width, jobs[i].box->height, error.what()));
        faults[i] = error.what();
      }
      if (progress) progress(static_cast<double>(++done) / static_cast<double>(jobs.size()), "edges");
    });
    std::vector<MeasuredEdge> edges;
    for (auto& result : results) std::move(result.begin(), result.end(), std::back_inserter(edges));
    if (edges.empty()) throw InputError(name_, faults.empty() ? "no edge" : faults.front());
    for (const Channel& channel : channels_) {
      std::vector<EdgeMeasurement*> of_channel;
      for (MeasuredEdge& edge : edges)
        if (edge.channel == channel.name) of_channel.push_back(&edge.exact);
      state_deviations(of_channel);
    }
    if (request_.chart_mm) place_on_chart(edges);
    std::vector<LeftOut> left_out;
    for (std::size_t i = 0; i < jobs.size(); ++i)
      if (!faults[i].empty()) add_left_out(left_out, faults[i], *jobs[i].edge);
    for (const LeftOut& some : left_out) send_note(context, fmt::format("{}: {}", name_, note_of(some)));
    return edges;
  }

 private:
  void place_on_chart(std::vector<MeasuredEdge>& edges) const try {
    const ChartMapping frame(guide_, (*request_.chart_mm)[0], (*request_.chart_mm)[1]);
    for (MeasuredEdge& edge : edges) {
      const EdgeLine& line = edge.exact.line;
      const auto [x, y] = frame.on_chart(line.centre_x, line.centre_y);
      edge.on_chart = {x, y, frame.per_mm(line)};
    }
  } catch (const InputError& error) {
    throw InputError(name_, error.what());
  }

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

  EdgeMeasurement measure(const Channel& channel, const std::vector<EdgeSample>& samples,
                          const FoundEdge* edge, bool sampled) const {
    SfrOptions options = options_;
    if (!blocks_.empty()) options.blocks = &blocks_[static_cast<std::size_t>(&channel - channels_.data())];
    if (edge != nullptr) {
      options.start = edge->line();
      if (sampled) {
        options.least_radius_px = EdgeSearchOptions().least_radius_px();
        options.places = static_cast<double>(channel.plane.values.size());
      }
      if (edge->corner_at_from) options.corners.push_back(edge->from);
      if (edge->corner_at_to) options.corners.push_back(edge->to);
      options.missing_target =
          sampled ? MissingTarget::where_sampled(*edge) : MissingTarget::everywhere(*edge);
    }
    return measure_edge(samples, channel.lattices.front().step, options);
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
      MeasuredEdge edge{channel.name, box, measure(channel, samples, nullptr, false), {}, {}};
      if (const FoundEdge* known = edge_along(found_, edge.exact.line))
        edge.exact = measure(channel, samples, known, false);
      if (request_.iso) edge.iso = iso_esfr(channel.plane, box);
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
      MeasuredEdge edge{channel.name, box_around(samples), measure(channel, samples, &found, true), {}, {}};
      if (request_.iso) edge.iso = iso_esfr(channel.plane, box_within(found, channel.plane));
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

  const SfrRequest& request_;
  const std::string& name_;
  const std::vector<Channel>& channels_;
  Plane guide_;
  SfrOptions options_;
  std::vector<RoundedBlocks> blocks_;  ///< of each channel of a JPEG
  FoundEdges found_;
};

}  // namespace

std::vector<MeasuredEdge> measure_sfr(const PicturePlanes& picture, const SfrRequest& request,
                                      const std::string& name, const Context& context) {
  return result_within(context, [&](const ProgressCallback& progress) {
    const std::vector<Channel> channels = channels_of(request, picture, name);
    return Measurement(request, picture, channels, name).run(context, progress);
  });
}

}  // namespace petzval
