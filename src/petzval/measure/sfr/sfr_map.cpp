// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/measure/sfr/sfr_map.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace petzval {

namespace {

using nlohmann::json;

constexpr std::size_t largest_map = std::size_t{256} << 20, most_edges = 100'000;
constexpr int largest_side = 1'000'000;
/// Of an edge's contrast at MTF50 by its frequency: ln 2, of a Gaussian; it turns a stated deviation of the
/// frequency into one of the contrast.
constexpr double usual_fall = 0.693;

struct StatedCurve {
  std::vector<double> frequencies, contrast, deviation;

  double at(const std::vector<double>& values, double frequency) const {
    const auto above = std::upper_bound(frequencies.begin(), frequencies.end(), frequency);
    const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
        above - frequencies.begin(), 1, static_cast<std::ptrdiff_t>(frequencies.size()) - 1));
    const double share = (frequency - frequencies[i - 1]) / (frequencies[i] - frequencies[i - 1]);
    return values[i - 1] + share * (values[i] - values[i - 1]);
  }
  /// Where the contrast falls below a level for the first time.
  std::optional<double> frequency_of(double level) const {
    for (std::size_t i = 1; i < contrast.size(); ++i)
      if (contrast[i] < level && contrast[i - 1] >= level)
        return frequencies[i - 1] + (contrast[i - 1] - level) / (contrast[i - 1] - contrast[i]) *
                                        (frequencies[i] - frequencies[i - 1]);
    return {};
  }
};

/// Contrast at three levels where their correlations are known, else at MTF50 alone, for neighbours on a
/// curve say the same twice.
void take_levels(const StatedCurve& curve, const std::optional<std::array<double, 3>>& correlations,
                 MapEdge& edge) {
  std::vector<double> at;
  for (const double level : {0.8, 0.5, 0.2})
    if (const auto frequency = curve.frequency_of(level)) at.push_back(*frequency);
  const bool all = at.size() == 3 && correlations;
  if (!all) at = {edge.mtf50_cpp};
  for (const double f : at) {
    edge.frequencies_cpp.push_back(f);
    edge.contrast.push_back(curve.at(curve.contrast, f));
    edge.deviation.push_back(curve.at(curve.deviation, f));
  }
  if (!all) return;
  const auto [a, b, c] = *correlations;
  edge.correlation = {1, a, b, a, 1, c, b, c, 1};
}

[[noreturn]] void refuse_map(const std::string& file, const std::string& what) {
  throw InputError(file, what);
}

/// The members of one edge, asked by name.
class EdgeReader {
 public:
  EdgeReader(const json& edge, const std::string& file, std::size_t index)
      : edge_(edge), file_(file), name_(fmt::format("edge {}", index + 1)) {
    if (!edge.is_object()) refuse_map(file_, name_ + " is no object; the JSON of petzval sfr would be right");
  }

  double number(const json& in, const char* key, std::optional<double> otherwise = {}) const {
    const auto at = in.find(key);
    if (at == in.end() && otherwise) return *otherwise;
    if (at == in.end()) refuse_map(file_, fmt::format("{} has no {}; {}", name_, key, wanted));
    if (!at->is_number() || !std::isfinite(at->get<double>()))
      refuse_map(file_, fmt::format("{}: {} is no number; {}", name_, key, wanted));
    return at->get<double>();
  }
  std::optional<std::vector<double>> numbers(const char* key) const {
    const auto at = edge_.find(key);
    if (at == edge_.end()) return {};
    std::vector<double> values;
    for (const json& each : at->is_array() ? *at : json::array({nullptr})) {
      if (!each.is_number())
        refuse_map(file_, fmt::format("{}: {} is no list of numbers; {}", name_, key, wanted));
      values.push_back(each.get<double>());
    }
    return values;
  }
  const json& line() const {
    const auto at = edge_.find("line");
    if (at == edge_.end() || !at->is_object())
      refuse_map(file_, fmt::format("{} has no line with its place; {}", name_, wanted));
    return *at;
  }
  std::optional<StatedCurve> curve() const {
    const auto f = numbers("frequencies_cpp"), sfr = numbers("sfr"), deviation = numbers("sfr_deviation");
    if (!f || !sfr || !deviation) return {};
    if (f->size() != sfr->size() || f->size() != deviation->size() || f->size() < 2)
      refuse_map(file_,
                 fmt::format("{}: frequencies_cpp, sfr and sfr_deviation are not as long as each other; {}",
                             name_, wanted));
    if (!strictly_rising(*f))
      refuse_map(file_, name_ + ": frequencies_cpp do not rise; rising ones would be right");
    return StatedCurve{*f, *sfr, *deviation};
  }
  std::optional<std::array<double, 3>> correlations() const {
    const auto values = numbers("level_correlations");
    if (!values) return {};
    if (values->size() != 3 || !std::ranges::all_of(*values, [](double r) { return std::abs(r) <= 1; }))
      refuse_map(file_, fmt::format("{}: level_correlations has to hold three numbers from -1 to 1", name_));
    return std::array{(*values)[0], (*values)[1], (*values)[2]};
  }
  /// Nothing where the MTF50 is not known.
  std::optional<MapEdge> read() const {
    if (const auto at = edge_.find("mtf50_cpp"); at == edge_.end() || at->is_null()) return {};
    MapEdge edge;
    edge.mtf50_cpp = number(edge_, "mtf50_cpp");
    if (!(edge.mtf50_cpp > 0)) refuse_map(file_, name_ + ": mtf50_cpp is not positive");
    const json& line = this->line();
    edge.x_px = number(line, "x_px"), edge.y_px = number(line, "y_px");
    edge.normal_rad = radians(number(line, "normal_deg"));
    edge.half_length_px = number(line, "half_length_px", 0.0);
    if (const auto channel = edge_.find("channel"); channel != edge_.end() && channel->is_string())
      edge.channel = channel->get<std::string>();
    if (const auto curve = this->curve()) {
      take_levels(*curve, correlations(), edge);
    } else {
      const double deviation = number(edge_, "mtf50_deviation_cpp");
      edge.frequencies_cpp = {edge.mtf50_cpp}, edge.contrast = {0.5};
      edge.deviation = {usual_fall * deviation / edge.mtf50_cpp};
    }
    for (std::size_t i = 0; i < edge.contrast.size(); ++i) {
      if (!std::isfinite(edge.frequencies_cpp[i] + edge.contrast[i] + edge.deviation[i]))
        refuse_map(file_, fmt::format("{}: its curve is of no contrast; {}", name_, wanted));
      if (edge.deviation[i] < 0) refuse_map(file_, name_ + ": a deviation is negative");
    }
    return edge;
  }

 private:
  static constexpr const char* wanted = "the JSON of petzval sfr would be right";
  static bool strictly_rising(const std::vector<double>& values) {
    return std::ranges::adjacent_find(values, std::ranges::greater_equal{}) == values.end();
  }

  const json& edge_;
  const std::string& file_;
  std::string name_;
};

SfrMap map_of(const json& picture, const std::string& file) {
  const auto edges = picture.find("edges");
  if (!picture.is_object() || edges == picture.end() || !edges->is_array())
    refuse_map(file, "has no list of edges; the JSON of petzval sfr would be right");
  if (edges->size() > most_edges) refuse_map(file, fmt::format("has more than {} edges", most_edges));
  SfrMap map;
  if (const auto name = picture.find("image"); name != picture.end() && name->is_string())
    map.picture = name->get<std::string>();
  for (const auto& [key, side] : {std::pair{"columns", &map.columns}, {"rows", &map.rows}}) {
    const auto at = picture.find(key);
    if (at == picture.end() || !at->is_number_integer() || at->get<double>() < 1 ||
        at->get<double>() > largest_side)
      refuse_map(file,
                 fmt::format("does not say how many {} the picture has; a whole number would be right", key));
    *side = at->get<int>();
  }
  for (std::size_t i = 0; i < edges->size(); ++i)
    if (std::optional<MapEdge> edge = EdgeReader((*edges)[i], file, i).read())
      map.edges.push_back(std::move(*edge));
  if (map.edges.empty()) refuse_map(file, "has no edge whose MTF50 is known");
  return map;
}

}  // namespace

SfrMap sfr_map(std::span<const MeasuredEdge> edges, int columns, int rows, const std::string& picture) {
  SfrMap map{picture, columns, rows, {}};
  for (const MeasuredEdge& measured : edges) {
    if (measured.iso || !std::isfinite(measured.mtf50())) continue;
    const EdgeMeasurement& of = measured.exact;
    MapEdge edge{of.line.centre_x,
                 of.line.centre_y,
                 of.line.normal_rad,
                 of.line.half_length,
                 measured.channel,
                 measured.mtf50(),
                 {},
                 {},
                 {},
                 {}};
    take_levels({of.frequencies_cpp, of.sfr, of.sfr_deviation}, of.level_correlations, edge);
    map.edges.push_back(std::move(edge));
  }
  return map;
}

std::vector<SfrMap> parse_sfr_maps(const std::string& text, const std::string& name) {
  const json root = json::parse(text, nullptr, false);
  if (!root.is_object()) refuse_map(name, "is no JSON object; the JSON of petzval sfr would be right");
  const auto pictures = root.find("pictures");
  if (pictures == root.end()) return {map_of(root, name)};
  if (!pictures->is_array() || pictures->empty()) refuse_map(name, "has an empty list of pictures");
  std::vector<SfrMap> maps;
  for (const json& picture : *pictures) maps.push_back(map_of(picture, name));
  return maps;
}

std::vector<SfrMap> read_sfr_maps(const std::string& path) {
  return parse_sfr_maps(read_whole_file(path, largest_map), path);
}

}  // namespace petzval
