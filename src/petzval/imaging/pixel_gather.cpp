// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/pixel_gather.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

constexpr int most_cells = 16;

/// Full axes of a shape, in pitches.
using Axes = std::array<double, 2>;

/// The area of each of S × S cells of a pixel under a centred shape, of sum 1.
std::vector<double> area_shares(Photosite::Shape shape, const Axes& axes, int cells) {
  constexpr int strips = 32;  // along a cell
  std::vector<double> shares;
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column) {
      const double left = (column - cells / 2.0) / cells, right = left + 1.0 / cells;
      double area = 0;
      for (int strip = 0; strip < strips; ++strip) {
        const double y = (row + (strip + 0.5) / strips - cells / 2.0) / cells;
        const double v = 2 * y / axes[1];
        double half = std::abs(v) < 1 ? axes[0] / 2 : 0;
        if (shape == Photosite::Shape::ellipse) half *= std::sqrt(std::max(0.0, 1 - v * v));
        area += std::max(0.0, std::min(right, half) - std::max(left, -half));
      }
      shares.push_back(area);
    }
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= sum;
  return shares;
}

/// Of cell centres about the middle of the pixel, along axis 0 (columns) or 1 (rows) [pitches²].
double variance(const std::vector<double>& shares, int cells, int axis) {
  double sum = 0;
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column) {
      const double at = ((axis == 0 ? column : row) + 0.5 - cells / 2.0) / cells;
      sum += shares[static_cast<std::size_t>(row * cells + column)] * at * at;
    }
  return sum;
}

/// The two dots of a filter along one axis, each linear between the cells about it: weights of cells −reach …
/// reach.
struct Dots {
  std::vector<double> weights;
  double added_variance = 0;  ///< by being linear [pitches²]
};

Dots dots_of(double separation, int cells, int reach) {
  const double at = std::abs(separation) / 2 * cells;
  const int below = static_cast<int>(at);
  const double beyond = at - below;
  Dots dots{std::vector<double>(static_cast<std::size_t>(2 * reach + 1)),
            beyond * (1 - beyond) / (double(cells) * cells)};
  for (const int side : {-1, 1}) {
    dots.weights[static_cast<std::size_t>(reach + side * below)] += (1 - beyond) / 2;
    if (beyond > 0) dots.weights[static_cast<std::size_t>(reach + side * (below + 1))] += beyond / 2;
  }
  return dots;
}

/// The axes of the shape whose area shares have these variances, or as near as cells come to it.
Axes matching_axes(const Photosite& site, int cells, const Axes& wanted) {
  Axes axes{site.width, site.height};
  constexpr int rounds = 4, halvings = 40;
  for (int round = 0; round < rounds; ++round)
    for (int axis = 0; axis < 2; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      double low = 0.5 / cells, high = 1;
      for (int i = 0; i < halvings; ++i) {
        axes[a] = (low + high) / 2;
        (variance(area_shares(site.shape, axes, cells), cells, axis) < wanted[a] ? low : high) = axes[a];
      }
      if (site.shape == Photosite::Shape::rectangle && axis == 1)
        return axes;  // they do not depend on each other
    }
  return axes;
}

}  // namespace

double PixelTaps::transform(double fx_cpp, double fy_cpp, int boxes) const {
  double sum = 0;
  for (int row = 0; row < size(); ++row)
    for (int column = 0; column < size(); ++column) {
      const double x = (column + 0.5 - size() / 2.0) / cells, y = (row + 0.5 - size() / 2.0) / cells;
      sum += weights[static_cast<std::size_t>(row * size() + column)] *
             std::cos(2 * pi * (fx_cpp * x + fy_cpp * y));
    }
  return sum * std::pow(sinc(fx_cpp / cells) * sinc(fy_cpp / cells), boxes);
}

PixelTaps pixel_taps(const Photosite& site, int cells, int boxes) {
  if ((site.shape != Photosite::Shape::rectangle && site.shape != Photosite::Shape::ellipse) ||
      !(site.width <= 1 && site.height <= 1))
    throw InputError(
        fmt::format("a photosite {}: a rectangle or ellipse within the pixel is right", site.text()));
  site.validate();
  PixelTaps taps;
  taps.cells = cells;
  const auto reach = [&](double separation) {
    return static_cast<int>(std::ceil(std::abs(separation) / 2 * cells));
  };
  taps.reach = std::max(reach(site.separation_x), reach(site.separation_y));
  const Dots across = dots_of(site.separation_x, cells, taps.reach),
             down = dots_of(site.separation_y, cells, taps.reach);

  Axes axes{site.width, site.height};
  if (!site.is_plain() || boxes > 1) {
    const double per_axis = site.shape == Photosite::Shape::ellipse ? 1.0 / 16 : 1.0 / 12;
    const double boxed = boxes / (12.0 * cells * cells);
    axes = matching_axes(site, cells,
                         {per_axis * site.width * site.width - boxed - across.added_variance,
                          per_axis * site.height * site.height - boxed - down.added_variance});
  }
  const std::vector<double> shares = area_shares(site.shape, axes, cells);
  const int size = taps.size();
  taps.weights.assign(static_cast<std::size_t>(size * size), 0);
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column)
      for (int i = 0; i <= 2 * taps.reach; ++i)
        for (int j = 0; j <= 2 * taps.reach; ++j)
          taps.weights[static_cast<std::size_t>((row + i) * size + column + j)] +=
              shares[static_cast<std::size_t>(row * cells + column)] *
              down.weights[static_cast<std::size_t>(i)] * across.weights[static_cast<std::size_t>(j)];
  return taps;
}

int cells_for(const Photosite& site, int boxes, int least) {
  if (site.is_plain()) return least;
  constexpr double good = 0.01, nyquist_cpp = 0.5, step_cpp = 0.05;
  for (int cells = least; cells < most_cells; ++cells) {
    const PixelTaps taps = pixel_taps(site, cells, boxes);
    double worst = 0;
    for (double f = step_cpp; f <= nyquist_cpp + step_cpp / 2; f += step_cpp)
      for (const auto& [x, y] : {std::pair{f, 0.0}, {0.0, f}, {f * std::sqrt(0.5), f * std::sqrt(0.5)}})
        worst = std::max(worst, std::abs(taps.transform(x, y, boxes) - site.transform(x, y).real()));
    if (worst <= good) return cells;
  }
  return most_cells;
}

CellPlane gathered(CellPlane plane, const PixelTaps& taps) {
  if (taps.size() == 1) return plane;
  const SensorGeometry inner = grown(plane.grid, -taps.reach);
  CellPlane result =
      CellPlane::unset({inner.columns / taps.cells, inner.rows / taps.cells, inner.pitch_um * taps.cells});
  const auto step = static_cast<std::size_t>(taps.cells), size = static_cast<std::size_t>(taps.size());
  parallel_for(result.rows(), [&](std::size_t row) {
    for (std::size_t column = 0; column < result.columns(); ++column) {
      double sum = 0;
      for (std::size_t i = 0; i < size; ++i) {
        const float* cells = plane.row(row * step + i) + column * step;
        for (std::size_t j = 0; j < size; ++j) sum += taps.weights[i * size + j] * double(cells[j]);
      }
      result.row(row)[column] = static_cast<float>(sum);
    }
  });
  return result;
}

}  // namespace petzval
