// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/image/picture_inset.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr int least_factor = 2, most_factor = 64, most_insets = 16;
/// Pixels between a picture and its insets, and the width of a frame about an inset.
constexpr int gap = 8, rim = 2;
/// Insets beside a small picture are still large enough to look at.
constexpr int least_tile = 128;

struct NamedPlace {
  const char* name;
  double x, y;
};

constexpr std::array<NamedPlace, 9> named_places = {{{"centre", 0.5, 0.5},
                                                     {"top", 0.5, 0},
                                                     {"bottom", 0.5, 1},
                                                     {"left", 0, 0.5},
                                                     {"right", 1, 0.5},
                                                     {"top-left", 0, 0},
                                                     {"top-right", 1, 0},
                                                     {"bottom-left", 0, 1},
                                                     {"bottom-right", 1, 1}}};

[[noreturn]] void refuse_inset(const std::string& text) {
  throw InputError(
      fmt::format("inset {}: a place in pixels such as 310,20, or centre, top-right, bottom and the "
                  "like, with ,FACTOR behind it (2 to 64), would be right",
                  quotable(text)));
}

int factor_of(const std::string& part, const std::string& text) {
  const auto factor = parse_integer(part);
  if (!factor || *factor < least_factor || *factor > most_factor) refuse_inset(text);
  return *factor;
}

}  // namespace

PictureInset PictureInset::parse(const std::string& text) {
  const std::vector<std::string> parts = split_at(text, ',');
  PictureInset inset;
  for (const NamedPlace& place : named_places)
    if (parts[0] == place.name) {
      if (parts.size() > 2) refuse_inset(text);
      inset = {place.x, place.y, inset.factor, true};
      if (parts.size() == 2) inset.factor = factor_of(parts[1], text);
      return inset;
    }
  if (parts.size() < 2 || parts.size() > 3) refuse_inset(text);
  const auto column = parse_number(parts[0]), row = parse_number(parts[1]);
  if (!column || !row) refuse_inset(text);
  inset.column = *column;
  inset.row = *row;
  if (parts.size() == 3) inset.factor = factor_of(parts[2], text);
  return inset;
}

InsetSheet::InsetSheet(int picture_columns, int picture_rows, std::span<const PictureInset> insets)
    : picture_columns_(picture_columns),
      picture_rows_(picture_rows),
      columns_(picture_columns),
      rows_(picture_rows) {
  if (insets.size() > most_insets)
    throw InputError(fmt::format("{} insets; {} at most would be right", insets.size(), most_insets));
  if (insets.empty()) return;
  const int per_column = std::clamp(static_cast<int>(insets.size()), 2, 4);
  const int tile = std::max(least_tile, (picture_rows - (per_column - 1) * gap) / per_column);
  for (const PictureInset& inset : insets) {
    if (inset.factor < least_factor || inset.factor > most_factor)
      throw InputError(fmt::format("an inset of {} times; {} to {} would be right", inset.factor,
                                   least_factor, most_factor));
    const double x = inset.of_frame ? inset.column * picture_columns : inset.column;
    const double y = inset.of_frame ? inset.row * picture_rows : inset.row;
    if (!(x >= 0 && x <= picture_columns && y >= 0 && y <= picture_rows))
      throw InputError(
          fmt::format("an inset at {:g},{:g} of a picture of {} x {} pixels; a place within it would "
                      "be right",
                      x, y, picture_columns, picture_rows));
    const int side = std::clamp((tile - 2 * rim) / inset.factor, 1, std::min(picture_columns, picture_rows));
    const auto inwards = [side](double middle, int size) {
      return std::clamp(static_cast<int>(std::lround(middle - side / 2.0)), 0, size - side);
    };
    const int place = static_cast<int>(tiles_.size());
    tiles_.push_back({{inwards(x, picture_columns), inwards(y, picture_rows), side},
                      picture_columns + gap + place / per_column * (tile + gap) + rim,
                      place % per_column * (tile + gap) + rim,
                      inset.factor});
  }
  for (const Tile& each : tiles_) {
    const int drawn = each.square.side * each.factor + rim;
    columns_ = std::max(columns_, each.left + drawn);
    rows_ = std::max(rows_, each.top + drawn);
  }
}

InsetSheet::Source InsetSheet::at(int column, int row) const {
  using Kind = Source::Kind;
  if (column < picture_columns_ && row < picture_rows_) {
    for (const Tile& tile : tiles_) {
      // The frame in the picture stands about what the inset shows.
      const int x = column - tile.square.left, y = row - tile.square.top, side = tile.square.side;
      const bool near = x >= -1 && y >= -1 && x <= side && y <= side;
      if (near && (x == -1 || y == -1 || x == side || y == side)) return {Kind::frame, column, row};
    }
    return {Kind::picture, column, row};
  }
  for (const Tile& tile : tiles_) {
    const int x = column - tile.left, y = row - tile.top, drawn = tile.square.side * tile.factor;
    if (x < -rim || y < -rim || x >= drawn + rim || y >= drawn + rim) continue;
    if (x < 0 || y < 0 || x >= drawn || y >= drawn) return {Kind::frame, 0, 0};
    return {Kind::picture, tile.square.left + x / tile.factor, tile.square.top + y / tile.factor};
  }
  return {};
}

}  // namespace petzval
