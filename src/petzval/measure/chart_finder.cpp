// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/display.h>
#include <petzval/measure/colour_chart.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace petzval {

namespace {

/// The picture made small: noise and fine detail are of no interest here.
struct SmallPicture {
  int columns = 0, rows = 0;
  double scale = 1;  ///< pixels of the picture to one of these
  std::vector<Xyz> xyz;
  std::vector<Lab> lab;
  std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

/// What brings an underexposed picture to where differences of colour have their usual size; else 1.
double brightening(const std::vector<Xyz>& colours) {
  constexpr double share = 0.99, dark = 0.3;
  std::vector<double> luminance;
  for (const Xyz& colour : colours) luminance.push_back(colour.y);
  if (luminance.empty()) return 1;
  const auto bright = luminance.begin() + static_cast<std::ptrdiff_t>(share * (luminance.size() - 1.0));
  std::ranges::nth_element(luminance, bright);
  return *bright > 0 && *bright < dark ? 1 / *bright : 1;
}

/// \param most_columns  that it has, or rows.
SmallPicture small_picture(const ViewedPicture& picture, int most_columns) {
  const int step = std::max(1, (std::max(picture.columns, picture.rows) + most_columns - 1) / most_columns);
  SmallPicture small;
  small.columns = picture.columns / step;
  small.rows = picture.rows / step;
  small.scale = step;
  for (int row = 0; row < small.rows; ++row)
    for (int column = 0; column < small.columns; ++column) {
      Xyz sum;
      for (int r = 0; r < step; ++r)
        for (int c = 0; c < step; ++c) sum = sum + picture.at(row * step + r, column * step + c);
      small.xyz.push_back((1.0 / (step * step)) * sum);
    }
  const double brighter = brightening(small.xyz);
  for (Xyz& colour : small.xyz) {
    colour = brighter * colour;
    small.lab.push_back(cielab(colour, display_white()));
  }
  return small;
}

struct Spot {
  double x, y, side;
  Xyz colour;
};

/// Connected regions of nearly one colour, as high as wide, that fill their bounding box.
std::vector<Spot> even_spots(const SmallPicture& small) {
  constexpr double even = 4;  // ΔE between neighbours
  constexpr std::size_t least_pixels = 9;
  std::vector<char> seen(small.lab.size());
  std::vector<Spot> spots;
  for (std::size_t start = 0; start < small.lab.size(); ++start) {
    if (seen[start]) continue;
    std::vector<std::size_t> region{start};
    seen[start] = 1;
    const auto columns = static_cast<std::size_t>(small.columns);
    std::size_t left = start % columns, right = left, top = start / columns, bottom = top;
    Xyz sum;
    for (std::size_t i = 0; i < region.size(); ++i) {
      const std::size_t here = region[i], r = here / columns, c = here % columns;
      left = std::min(left, c), right = std::max(right, c), top = std::min(top, r),
      bottom = std::max(bottom, r);
      sum = sum + small.xyz[here];
      const auto visit = [&](std::size_t there) {
        if (seen[there] || delta_e_ab(small.lab[there], small.lab[here]) > even ||
            delta_e_ab(small.lab[there], small.lab[start]) > 4 * even)
          return;
        seen[there] = 1;
        region.push_back(there);
      };
      if (c > 0) visit(here - 1);
      if (c + 1 < columns) visit(here + 1);
      if (r > 0) visit(here - columns);
      if (r + 1 < static_cast<std::size_t>(small.rows)) visit(here + columns);
    }
    const double width = static_cast<double>(right - left + 1),
                 height = static_cast<double>(bottom - top + 1);
    const bool square = std::max(width, height) < 1.7 * std::min(width, height);
    const bool full = static_cast<double>(region.size()) > 0.6 * width * height;
    const bool small_enough = width < 0.25 * small.columns && height < 0.35 * small.rows;
    if (region.size() < least_pixels || !square || !full || !small_enough) continue;
    spots.push_back({static_cast<double>(left + right + 1) / 2, static_cast<double>(top + bottom + 1) / 2,
                     std::sqrt(width * height), (1.0 / static_cast<double>(region.size())) * sum});
  }
  return spots;
}

/// Place of patch (row, column): origin + column · across + row · down.
struct Grid {
  double x = 0, y = 0, across_x = 0, across_y = 0, down_x = 0, down_y = 0;
  std::array<double, 2> at(double row, double column) const {
    return {x + column * across_x + row * down_x, y + column * across_y + row * down_y};
  }
};

/// Mean ΔE*ab of the colours under a grid; nothing if it leaves the picture. Luminance is matched on the
/// greys.
std::optional<double> difference(const SmallPicture& small, const Grid& grid,
                                 const std::vector<Xyz>& wanted) {
  std::vector<Xyz> seen;
  for (int row = 0; row < chart_rows; ++row)
    for (int column = 0; column < chart_columns; ++column) {
      const auto at = grid.at(row, column);
      if (!(at[0] >= 0 && at[1] >= 0 && at[0] < small.columns && at[1] < small.rows)) return {};
      seen.push_back(small.xyz[small.at(static_cast<int>(at[1]), static_cast<int>(at[0]))]);
    }
  double sw = 0, ss = 0;
  for (std::size_t i = 18; i < seen.size(); ++i) sw += seen[i].y * wanted[i].y, ss += seen[i].y * seen[i].y;
  if (!(ss > 0)) return {};
  double sum = 0;
  for (std::size_t i = 0; i < seen.size(); ++i)
    sum += delta_e_ab(cielab((sw / ss) * seen[i], display_white()), cielab(wanted[i], display_white()));
  return sum / static_cast<double>(seen.size());
}

/// Least squares of the grid over the spots that lie on it: each coordinate by itself, three unknowns.
Grid refined(const Grid& grid, const std::vector<Spot>& spots) {
  double m[3][3] = {}, bx[3] = {}, by[3] = {};
  const double pitch = std::hypot(grid.across_x, grid.across_y);
  int found = 0;
  for (int row = 0; row < chart_rows; ++row)
    for (int column = 0; column < chart_columns; ++column) {
      const auto at = grid.at(row, column);
      const Spot* nearest = nullptr;
      for (const Spot& spot : spots)
        if (std::hypot(spot.x - at[0], spot.y - at[1]) < 0.3 * pitch) nearest = &spot;
      if (!nearest) continue;
      const double basis[] = {1, static_cast<double>(column), static_cast<double>(row)};
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) m[i][k] += basis[i] * basis[k];
        bx[i] += basis[i] * nearest->x;
        by[i] += basis[i] * nearest->y;
      }
      ++found;
    }
  const double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                     m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                     m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  if (found < 6 || std::abs(det) < 1e-9) return grid;
  const auto solve = [&](const double(&b)[3], int unknown) {
    double a[3][3];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) a[i][k] = k == unknown ? b[i] : m[i][k];
    return (a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
            a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
            a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0])) /
           det;
  };
  return {solve(bx, 0), solve(by, 0), solve(bx, 1), solve(by, 1), solve(bx, 2), solve(by, 2)};
}

struct FoundChart {
  ChartCorners corners;
  double difference = 1e300;  ///< mean ΔE*ab of its patches
};

/// What looks most like a chart, if anything does.
FoundChart chart_in(const SmallPicture& small, const std::vector<Xyz>& wanted) {
  std::vector<Spot> spots = even_spots(small);
  constexpr std::size_t most_spots = 300;
  if (spots.size() > most_spots) spots.resize(most_spots);
  double best = 1e300;
  Grid best_grid;
  for (const Spot& a : spots)
    for (const Spot& b : spots) {
      const double across_x = b.x - a.x, across_y = b.y - a.y, pitch = std::hypot(across_x, across_y),
                   side = (a.side + b.side) / 2;
      if (&a == &b || pitch < side || pitch > 1.8 * side || std::abs(a.side - b.side) > 0.4 * side) continue;
      for (int row = 0; row < chart_rows; ++row)
        for (int column = 0; column + 1 < chart_columns; ++column) {
          // Rows run to the right of columns: down is across, turned by a right angle.
          Grid grid{0, 0, across_x, across_y, -across_y, across_x};
          grid.x = a.x - column * grid.across_x - row * grid.down_x;
          grid.y = a.y - column * grid.across_y - row * grid.down_y;
          const auto how_far = difference(small, grid, wanted);
          if (how_far && *how_far < best) best = *how_far, best_grid = grid;
        }
    }
  FoundChart found{{}, best};
  const Grid grid = refined(refined(best_grid, spots), spots);
  const double places[4][2] = {
      {0, 0}, {0, chart_columns - 1}, {chart_rows - 1, chart_columns - 1}, {chart_rows - 1, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto at = grid.at(places[i][0], places[i][1]);
    found.corners.xy[i] = {at[0] * small.scale, at[1] * small.scale};
  }
  return found;
}

}  // namespace

ChartCorners find_chart(const ViewedPicture& picture, const Spectrum& light) {
  const std::vector<Xyz> wanted = chart_colours(light);
  constexpr double sure = 5, acceptable = 25;
  FoundChart best;
  for (const int columns : {480, 240, 120}) {  // the smaller, the quieter
    const FoundChart found = chart_in(small_picture(picture, columns), wanted);
    if (found.difference < best.difference) best = found;
    if (best.difference < sure) break;
  }
  if (!(best.difference < acceptable))
    throw InputError(
        "no ColorChecker is found in the picture; `corners` gives the centres of its corner patches");
  return best.corners;
}

}  // namespace petzval
