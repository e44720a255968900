// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/target/crossings.h>
#include <petzval/target/formats/polygon_file.h>
#include <petzval/target/visible_regions.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace petzval {

namespace {

constexpr std::size_t most_corners = 10'000'000;

/// Words of a text, with the line that they stand on.
class Words {
 public:
  Words(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  bool next() {
    while (at_ < text_.size() &&
           (std::isspace(static_cast<unsigned char>(text_[at_])) || text_[at_] == '#' || text_[at_] == ',')) {
      if (text_[at_] == '#')
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
      if (at_ < text_.size() && text_[at_] == '\n') ++line_;
      if (at_ < text_.size()) ++at_;
    }
    const std::size_t from = at_;
    while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_])) && text_[at_] != '#' &&
           text_[at_] != ',')
      ++at_;
    word_ = text_.substr(from, at_ - from);
    return !word_.empty();
  }
  std::string_view word() const { return word_; }
  int line() const { return line_; }

  double number(const char* what) {
    if (!next()) fail(fmt::format("the file ends where {} should stand", what));
    double value = 0;
    const auto [end, error] = std::from_chars(word_.data(), word_.data() + word_.size(), value);
    if (error != std::errc() || end != word_.data() + word_.size() || !std::isfinite(value))
      fail(fmt::format("'{}' where {} should stand", printable(), what));
    return value;
  }
  /// The current word as a number of corners.
  std::size_t corner_count() const {
    long long count = 0;
    const auto [end, error] = std::from_chars(word_.data(), word_.data() + word_.size(), count);
    if (error != std::errc() || end != word_.data() + word_.size())
      fail(fmt::format("'{}' where the number of corners, 'level', 'ground', 'rule' or 'hole' should stand",
                       printable()));
    if (count < 3) fail(fmt::format("a polygon of {} corners; at least three are right", count));
    if (static_cast<unsigned long long>(count) > most_corners)
      fail(fmt::format("a polygon of {} corners; up to {} are right", count, most_corners));
    return static_cast<std::size_t>(count);
  }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_, line_, what); }

 private:
  std::string printable() const {
    std::string text;
    for (const char c : word_.substr(0, 40)) text += std::isprint(static_cast<unsigned char>(c)) ? c : '?';
    return text;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::string_view word_;
};

Contour read_corners(Words& words, std::size_t count) {
  Contour contour;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = words.number("the x of a corner");
    const Vertex v{x, words.number("the y of a corner")};
    if (contour.empty() || !(v == contour.back())) contour.push_back(v);
  }
  while (contour.size() > 1 && contour.front() == contour.back()) contour.pop_back();
  return contour;
}

std::optional<FillRule> read_rule(Words& words) {
  if (!words.next()) words.fail("the file ends where nonzero, evenodd or simple should stand");
  if (words.word() == "nonzero") return FillRule::nonzero;
  if (words.word() == "evenodd") return FillRule::evenodd;
  if (words.word() != "simple") words.fail("a rule other than nonzero, evenodd and simple");
  return std::nullopt;
}

}  // namespace

TargetScene parse_polygons(const std::string& text, const std::string& name) {
  TargetScene scene;
  scene.source = name;
  Words words(text, scene.source);
  double level = 0;
  std::optional<FillRule> rule;
  // A polygon is complete when something else begins.
  const auto resolve = [&] {
    if (!rule || scene.polygons.empty() || scene.polygons.back().contours.empty()) return;
    const Polygon polygon = scene.polygons.back();
    if (!find_crossing(polygon)) return;
    scene.polygons.pop_back();
    for (std::vector<Contour>& part : simple_parts(polygon.contours, *rule))
      scene.polygons.push_back({std::move(part), polygon.level, polygon.line});
  };
  std::size_t corners = 0;
  while (words.next()) {
    const int line = words.line();
    const bool hole = words.word() == "hole";
    if (words.word() == "level") {
      level = words.number("a level");
    } else if (words.word() == "ground") {
      scene.ground = words.number("the level of the ground");
    } else if (words.word() == "rule") {
      resolve();
      rule = read_rule(words);
    } else {
      if (!hole) resolve();
      if (hole && scene.polygons.empty()) words.fail("a hole before any polygon");
      if (hole && !words.next())
        words.fail("the file ends where the number of a hole's corners should stand");
      const std::size_t count = words.corner_count();
      if ((corners += count) > most_corners) words.fail(fmt::format("more than {} corners", most_corners));
      Contour contour = read_corners(words, count);
      if (hole)
        scene.polygons.back().contours.push_back(std::move(contour));
      else
        scene.polygons.push_back({{std::move(contour)}, level, line});
    }
  }
  resolve();
  if (scene.polygons.empty())
    throw InputError(name,
                     "no polygon: a file of polygons holds numbers of corners, each followed by its corners");
  return scene;
}

TargetScene read_polygon_file(const std::string& path) {
  return parse_polygons(read_whole_file(path, std::size_t{1} << 30), path);
}

}  // namespace petzval
