// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/flare/facet_deposit.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// Facets below this area [pixels] have no area to share out with any digits.
constexpr double least_area = 1e-6;

void add_point(double column, double row, double flux, const RowBand& band) {
  const double x = std::floor(column), y = std::floor(row);
  if (!(x >= 0 && x < band.columns && y >= band.from && y < band.to)) return;
  band.flux[static_cast<std::size_t>(static_cast<int>(y) - band.from) *
                static_cast<std::size_t>(band.columns) +
            static_cast<std::size_t>(x)] += flux;
}

/// Along the longest side, by points closer than pixels.
void add_sliver(const LightFacet& facet, const RowBand& band) {
  std::size_t from = 0;
  double longest = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double length = std::hypot(facet.column[j] - facet.column[i], facet.row[j] - facet.row[i]);
    if (length > longest) longest = length, from = i;
  }
  constexpr double most_points = 1e5, points_per_pixel = 4;
  const auto points = static_cast<int>(std::min(most_points, std::ceil(longest * points_per_pixel) + 1));
  const std::size_t to = (from + 1) % 3;
  for (int k = 0; k < points; ++k) {
    const double t = (k + 0.5) / points;
    add_point(facet.column[from] + t * (facet.column[to] - facet.column[from]),
              facet.row[from] + t * (facet.row[to] - facet.row[from]), facet.flux / points, band);
  }
}

/// What edges cross in one row: signed heights and the areas to the left within the pixel, per column, so
/// that running sums are the covered area.
class RowCover {
 public:
  explicit RowCover(int columns) : columns_(columns), change_(static_cast<std::size_t>(columns) + 2) {}

  /// Part of an edge within the row, from (x0, y0) to (x1, y1).
  void add(double x0, double y0, double x1, double y1) {
    const double height = y1 - y0;
    if (height == 0) return;
    const double end = columns_;
    double left = std::clamp(std::min(x0, x1), 0.0, end), right = std::clamp(std::max(x0, x1), 0.0, end);
    runs_[run_count_++] = {static_cast<int>(left), std::min(static_cast<int>(right) + 1, columns_)};
    const double run = std::abs(x1 - x0);
    // Beyond the picture's sides the edge stands on them.
    if (run == 0 || std::max(x0, x1) <= 0 || std::min(x0, x1) >= end) return upright(left, height);
    if (const double before = -std::min(x0, x1); before > 0) upright(0, height * before / run);
    if (const double beyond = std::max(x0, x1) - end; beyond > 0) upright(end, height * beyond / run);
    const double per_column = height / run;
    while (left < right) {
      const double next = std::min(right, static_cast<double>(static_cast<int>(left) + 1));
      slanted(left, next, per_column * (next - left));
      left = next;
    }
  }

  /// Adds light × covered area of each pixel, and is empty again. \param light  by column, of this row.
  template <class Light>
  void flush(double* pixels, const Light& light) {
    // From one run of columns that an edge crosses to the next the cover stays.
    std::sort(runs_.begin(), runs_.begin() + run_count_);
    double covered = 0;
    int x = columns_ + 1;
    for (std::size_t k = 0; k < run_count_; ++k) {
      const auto [from, to] = runs_[k];
      if (k == 0) x = from;
      const double inside = covered;
      for (; x < from; ++x) pixels[x] += light(x) * inside;
      for (; x <= to; ++x) {
        covered += change_[static_cast<std::size_t>(x)];
        change_[static_cast<std::size_t>(x)] = 0;
        if (x < columns_) pixels[x] += light(x) * covered;
      }
    }
    change_[static_cast<std::size_t>(columns_) + 1] = 0;
    run_count_ = 0;
  }

 private:
  void upright(double x, double height) { slanted(x, x, height); }
  /// An edge within one column covers everything to its right, and of its own column what lies to its right.
  void slanted(double from, double to, double height) {
    const double middle = 0.5 * (from + to);
    const auto column = static_cast<std::size_t>(from);  // not negative
    const double own = height * (1 - (middle - static_cast<double>(column)));
    change_[column] += own;
    change_[column + 1] += height - own;
  }

  int columns_;
  /// Columns [first, second] in which edges change the cover, up to three edges a row.
  std::array<std::pair<int, int>, 4> runs_{};
  std::size_t run_count_ = 0;
  std::vector<double> change_;
};

/// The shade of a facet as a linear function.
struct LinearShade {
  double start = 1, by_column = 0, by_row = 0;

  LinearShade(const LightFacet& facet, double area) {
    const auto& [c0, c1, c2] = facet.column;
    const auto& [r0, r1, r2] = facet.row;
    const double up = facet.shade[1] - facet.shade[0], over = facet.shade[2] - facet.shade[0];
    by_column = (up * (r2 - r0) - over * (r1 - r0)) / (2 * area);
    by_row = (over * (c1 - c0) - up * (c2 - c0)) / (2 * area);
    start = facet.shade[0] - by_column * c0 - by_row * r0;
  }
  double at(double column, double row) const { return start + by_column * column + by_row * row; }
};

void add_triangle(const LightFacet& facet, double area, const RowBand& band, RowCover& cover) {
  const auto [low, high] = std::ranges::minmax(facet.row);
  const int from = static_cast<int>(std::clamp(std::floor(low), double(band.from), double(band.to)));
  const int to = static_cast<int>(std::clamp(std::ceil(high), double(band.from), double(band.to)));
  // Rows run downwards: a facet of positive area is left of the edges that lead down.
  const double density = -facet.flux / area;
  const auto [least, most] = std::ranges::minmax(facet.shade);
  const bool flat = least == most;
  const LinearShade shade(facet, area);
  for (int row = from; row < to; ++row) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const double y0 = facet.row[i], y1 = facet.row[j];
      const double top = std::clamp(y0, double(row), double(row + 1)),
                   bottom = std::clamp(y1, double(row), double(row + 1));
      if (top == bottom) continue;
      const double slope = (facet.column[j] - facet.column[i]) / (y1 - y0);
      // Ends of the edge are taken as they are, so that its parts meet.
      const double x0 = top == y0 ? facet.column[i] : facet.column[i] + slope * (top - y0);
      const double x1 = bottom == y1 ? facet.column[j] : facet.column[i] + slope * (bottom - y0);
      cover.add(x0, top, x1, bottom);
    }
    double* const pixels = band.flux.data() + static_cast<std::ptrdiff_t>(row - band.from) * band.columns;
    if (flat) {
      cover.flush(pixels, [&](int) { return density; });
    } else {
      const double begin = shade.at(0.5, row + 0.5), step = shade.by_column;
      cover.flush(pixels, [&, low = least, high = most](int x) {
        return density * std::clamp(begin + step * x, low, high);
      });
    }
  }
}

}  // namespace

void deposit_facets(std::span<const LightFacet> facets, const RowBand& band) {
  RowCover cover(band.columns);
  for (const LightFacet& facet : facets) {
    const auto [low, high] = std::ranges::minmax(facet.row);
    if (!(high >= band.from && low < band.to)) continue;
    const auto [left, right] = std::ranges::minmax(facet.column);
    if (!(right >= 0 && left < band.columns)) continue;
    if (std::floor(left) == std::floor(right) && std::floor(low) == std::floor(high)) {
      add_point(left, low, facet.flux, band);
      continue;
    }
    const double area = 0.5 * ((facet.column[1] - facet.column[0]) * (facet.row[2] - facet.row[0]) -
                               (facet.column[2] - facet.column[0]) * (facet.row[1] - facet.row[0]));
    if (std::abs(area) < least_area)
      add_sliver(facet, band);
    else
      add_triangle(facet, area, band, cover);
  }
}

}  // namespace petzval
