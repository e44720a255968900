// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/level_contours.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

double halfway_level(const Plane& plane) {
  const auto [low, high] = std::minmax_element(plane.values.begin(), plane.values.end());
  constexpr int bins = 1024;
  const double from = *low, width = (*high - from) / bins;
  if (!(width > 0)) return from;
  std::array<double, bins> count{}, sum{};
  for (const double value : plane.values) {
    const auto bin =
        static_cast<std::size_t>(std::clamp(static_cast<int>((value - from) / width), 0, bins - 1));
    count[bin] += 1, sum[bin] += value;
  }
  double all = 0, total = 0;
  for (int i = 0; i < bins; ++i)
    all += count[static_cast<std::size_t>(i)], total += sum[static_cast<std::size_t>(i)];
  double below = 0, below_sum = 0, best = -1, level = from;
  for (int i = 0; i + 1 < bins; ++i) {
    below += count[static_cast<std::size_t>(i)], below_sum += sum[static_cast<std::size_t>(i)];
    if (below == 0 || below == all) continue;
    const double dark = below_sum / below, bright = (total - below_sum) / (all - below);
    const double between = below * (all - below) * (bright - dark) * (bright - dark);
    if (between > best) best = between, level = 0.5 * (dark + bright);
  }
  return level;
}

namespace {

/// Walks contours over the cells between four pixel centres. A side of a cell is named by the pixel at its
/// upper or left end and whether it runs right (0) or down (1).
class Marcher {
 public:
  Marcher(const Plane& plane, double level) : plane_(plane), level_(level) {
    const auto pixels = plane.values.size();
    used_.assign(2 * pixels, false);
  }

  std::vector<LevelContour> run(std::size_t least_points) {
    std::vector<LevelContour> contours;
    const auto keep = [&](LevelContour contour) {
      if (contour.points.size() >= least_points) contours.push_back(std::move(contour));
    };
    // Those that come in over the rim first, so that what remains is closed.
    for (int column = 0; column + 1 < plane_.columns; ++column) {
      keep(walk(column, 0, Side::top, false));
      keep(walk(column, plane_.rows - 2, Side::bottom, false));
    }
    for (int row = 0; row + 1 < plane_.rows; ++row) {
      keep(walk(0, row, Side::left, false));
      keep(walk(plane_.columns - 2, row, Side::right, false));
    }
    for (int row = 0; row + 1 < plane_.rows; ++row)
      for (int column = 0; column + 1 < plane_.columns; ++column) keep(walk(column, row, Side::top, true));
    return contours;
  }

 private:
  enum class Side { top, right, bottom, left };

  bool bright(int column, int row) const { return plane_.at(column, row) > level_; }
  std::size_t side_index(int column, int row, Side side) const {
    if (side == Side::bottom) ++row;
    if (side == Side::right) ++column;
    const bool down = side == Side::left || side == Side::right;
    return 2 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(plane_.columns) +
                static_cast<std::size_t>(column)) +
           (down ? 1 : 0);
  }
  /// Going round the cell clockwise in the picture: the corners that each side runs from and to.
  static std::array<int, 4> ends(Side side) {
    switch (side) {
      case Side::top:
        return {0, 0, 1, 0};
      case Side::right:
        return {1, 0, 1, 1};
      case Side::bottom:
        return {1, 1, 0, 1};
      default:
        return {0, 1, 0, 0};
    }
  }
  /// A contour enters a cell where the clockwise walk goes from bright to dark, and leaves where from dark to
  /// bright.
  bool enters(int column, int row, Side side) const {
    const auto e = ends(side);
    return bright(column + e[0], row + e[1]) && !bright(column + e[2], row + e[3]);
  }
  bool leaves(int column, int row, Side side) const {
    const auto e = ends(side);
    return !bright(column + e[0], row + e[1]) && bright(column + e[2], row + e[3]);
  }
  ContourPoint crossing(int column, int row, Side side) const {
    const auto e = ends(side);
    const int c0 = column + e[0], r0 = row + e[1], c1 = column + e[2], r1 = row + e[3];
    const double v0 = plane_.at(c0, r0), v1 = plane_.at(c1, r1), t = (level_ - v0) / (v1 - v0);
    return {c0 + 0.5 + t * (c1 - c0), r0 + 0.5 + t * (r1 - r0)};
  }
  /// Where the contour that enters through `from` leaves: the next such side, clockwise or, at a saddle with
  /// a bright middle, counter-clockwise.
  Side exit(int column, int row, Side from) const {
    const double middle = (plane_.at(column, row) + plane_.at(column + 1, row) + plane_.at(column, row + 1) +
                           plane_.at(column + 1, row + 1)) /
                          4;
    const int turn = middle > level_ ? 1 : 3;
    for (int i = 1; i < 4; ++i) {
      const Side side = static_cast<Side>((static_cast<int>(from) + i * turn) % 4);
      if (leaves(column, row, side)) return side;
    }
    return from;
  }

  LevelContour walk(int column, int row, Side side, bool closed) {
    LevelContour contour;
    contour.closed = closed;
    while (enters(column, row, side) && !used_[side_index(column, row, side)]) {
      used_[side_index(column, row, side)] = true;
      contour.points.push_back(crossing(column, row, side));
      const Side out = exit(column, row, side);
      const bool inside = out == Side::top      ? row > 0
                          : out == Side::bottom ? row + 2 < plane_.rows
                          : out == Side::left   ? column > 0
                                                : column + 2 < plane_.columns;
      if (!inside) {
        contour.points.push_back(crossing(column, row, out));
        contour.closed = false;
        break;
      }
      if (out == Side::top) --row, side = Side::bottom;
      if (out == Side::bottom) ++row, side = Side::top;
      if (out == Side::left) --column, side = Side::right;
      if (out == Side::right) ++column, side = Side::left;
    }
    return contour;
  }

  const Plane& plane_;
  double level_;
  std::vector<bool> used_;
};

}  // namespace

std::vector<LevelContour> level_contours(const Plane& plane, double level, std::size_t least_points) {
  if (plane.columns < 2 || plane.rows < 2) return {};
  return Marcher(plane, level).run(least_points);
}

}  // namespace petzval
