// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/whole_file.h>
#include <petzval/simulate/motion_path.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace petzval {

namespace {

constexpr std::array<std::pair<std::string_view, double SceneAim::*>, 4> ways{
    {{"pan_deg", &SceneAim::pan_deg},
     {"pitch_deg", &SceneAim::pitch_deg},
     {"right_m", &SceneAim::right_m},
     {"up_m", &SceneAim::up_m}}};

/// Of a column's name; null for the time.
std::optional<double SceneAim::*> column_of(const std::string& name) {
  if (name == "t_s") return nullptr;
  for (const auto& [word, member] : ways)
    if (word == name) return member;
  return std::nullopt;
}

constexpr std::size_t most_bytes = std::size_t{1} << 26;

}  // namespace

MotionPath::MotionPath(std::vector<Key> keys) : keys_(std::move(keys)) {
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    bool finite = std::isfinite(keys_[i].t_s);
    for (const auto& [name, way] : ways) finite = finite && std::isfinite(keys_[i].aim.*way);
    if (!finite) throw InputError("a path of motion must be of finite numbers");
    if (i > 0 && !(keys_[i].t_s > keys_[i - 1].t_s))
      throw InputError(fmt::format("the times of a path must increase; {:g} s follows {:g} s", keys_[i].t_s,
                                   keys_[i - 1].t_s));
  }
}

MotionPath MotionPath::steady(const SceneAim& per_second, double duration_s) {
  if (per_second.is_straight()) return {};
  SceneAim end;
  for (const auto& [name, way] : ways) end.*way = per_second.*way * duration_s;
  return MotionPath({{0, {}}, {duration_s, end}});
}

MotionPath MotionPath::read(const std::string& path) {
  std::vector<double SceneAim::*> columns;
  std::vector<Key> keys;
  for (const TextLine& line : text_lines(read_whole_file(path, most_bytes))) {
    if (trimmed(line.text).empty()) continue;
    const std::vector<std::string> cells = split_at(line.text, ',');
    if (columns.empty()) {
      for (const std::string& cell : cells) {
        const auto column = column_of(trimmed(cell));
        if (!column)
          throw InputError(
              path, line.number,
              fmt::format("a column \"{}\"; t_s, pan_deg, pitch_deg, right_m and up_m would be right",
                          quotable(cell)));
        columns.push_back(*column);
      }
      if (std::ranges::count(columns, nullptr) != 1)
        throw InputError(path, line.number, "one column of times, t_s, must be there");
      continue;
    }
    if (cells.size() != columns.size())
      throw InputError(path, line.number,
                       fmt::format("has {} numbers for {} columns", cells.size(), columns.size()));
    Key key;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::optional<double> value = parse_number(trimmed(cells[i]));
      if (!value)
        throw InputError(path, line.number, fmt::format("\"{}\" is not a number", quotable(cells[i])));
      (columns[i] == nullptr ? key.t_s : key.aim.*columns[i]) = *value;
    }
    if (!keys.empty() && !(key.t_s > keys.back().t_s))
      throw InputError(path, line.number,
                       fmt::format("times must increase; {:g} s follows {:g} s", key.t_s, keys.back().t_s));
    keys.push_back(key);
  }
  if (keys.empty()) throw InputError(path, "holds no instants; lines of t_s,pan_deg would be right");
  return MotionPath(std::move(keys));
}

bool MotionPath::is_rest() const {
  return std::ranges::all_of(keys_, [&](const Key& key) { return key.aim == keys_.front().aim; });
}

SceneAim MotionPath::at(double t_s) const {
  if (keys_.empty()) return {};
  if (t_s <= keys_.front().t_s) return keys_.front().aim;
  if (t_s >= keys_.back().t_s) return keys_.back().aim;
  const auto after = std::ranges::upper_bound(keys_, t_s, {}, &Key::t_s);
  const Key &a = *(after - 1), &b = *after;
  const double share = (t_s - a.t_s) / (b.t_s - a.t_s);
  SceneAim aim;
  for (const auto& [name, way] : ways) aim.*way = std::lerp(a.aim.*way, b.aim.*way, share);
  return aim;
}

}  // namespace petzval
