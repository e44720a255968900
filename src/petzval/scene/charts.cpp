// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/colour/spectra_files.h>
#include <petzval/scene/charts.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

constexpr double edge_dark = 0.2, edge_light = 0.8;

}  // namespace

Scene checkerboard_chart(const ChartOptions& options, int squares_across) {
  if (squares_across < 1 || squares_across > options.columns)
    throw InputError(
        fmt::format("a checkerboard of {} squares across; 1 to {} (a sample each) would be right",
                    squares_across, options.columns));
  ChartCanvas canvas(options);
  canvas.fill(canvas.flat_paint(0));
  const double size = static_cast<double>(options.columns) / squares_across;
  // Rows of squares above and below that of the corner at the middle, or about the middle.
  const double top = options.rows / 2.0 - squares_across * size / 2;
  const int first = static_cast<int>(std::floor(-top / size)),
            end = static_cast<int>(std::ceil((options.rows - top) / size));
  Shape white;
  for (int j = first; j < end; ++j)
    for (int i = ((j % 2) + 2) % 2; i < squares_across; i += 2)
      white.add_rectangle(i * size, top + j * size, (i + 1) * size, top + (j + 1) * size);
  canvas.draw(white, canvas.flat_paint(1));
  return std::move(canvas).lit();
}

void draw_colorchecker(ChartCanvas& canvas, Point corner, double width) {
  const SpectrumSet patches = read_spectrum_set("colorchecker_reflectance");
  // In units of the distance from patch to patch: 6.3 × 4.3 with a margin, each patch 0.85.
  const double pitch = width / 6.3, margin = 0.225 * pitch, side = 0.85 * pitch;
  Shape board;
  board.add_rectangle(corner.x, corner.y, corner.x + width, corner.y + width / colorchecker_aspect);
  canvas.draw(board, canvas.paint(patches.find("black").scaled(0.5)));
  for (std::size_t i = 0; i < patches.spectra.size(); ++i) {
    const double x = corner.x + margin + pitch * static_cast<double>(i % 6);
    const double y = corner.y + margin + pitch * static_cast<double>(i / 6);
    Shape patch;
    patch.add_rectangle(x, y, x + side, y + side);
    canvas.draw(patch, canvas.paint(patches.spectra[i].spectrum));
  }
}

Scene colorchecker_chart(const ChartOptions& options) {
  ChartCanvas canvas(options);
  canvas.fill(canvas.paint(read_spectrum_set("colorchecker_reflectance").find("neutral 5")));
  const double width = 0.96 * std::min<double>(options.columns, options.rows * colorchecker_aspect);
  draw_colorchecker(canvas, {(options.columns - width) / 2, (options.rows - width / colorchecker_aspect) / 2},
                    width);
  return std::move(canvas).lit();
}

Scene point_chart(const ChartOptions& options, int points_across) {
  if (points_across < 1 || points_across > std::min(options.columns, options.rows))
    throw InputError(fmt::format("a grid of {0} x {0} points; 1 to {1} (a sample each) would be right",
                                 points_across, std::min(options.columns, options.rows)));
  ChartCanvas canvas(options);
  const auto sample = [&](int point, int samples) {
    return static_cast<std::size_t>((2 * static_cast<std::int64_t>(point) + 1) * samples /
                                    (2 * points_across));
  };
  canvas.modulate(canvas.flat_paint(1), [&](int row, std::span<double> factors) {
    for (int j = 0; j < points_across; ++j)
      if (sample(j, options.rows) == static_cast<std::size_t>(row))
        for (int i = 0; i < points_across; ++i) factors[sample(i, options.columns)] = 1;
  });
  return std::move(canvas).lit();
}

Scene grid_chart(const ChartOptions& options, int squares_across) {
  if (squares_across < 1 || squares_across > options.columns)
    throw InputError(fmt::format("a grid of {} squares across; 1 to {} (a sample each) would be right",
                                 squares_across, options.columns));
  ChartCanvas canvas(options);
  canvas.fill(canvas.flat_paint(1));
  const double w = options.columns, h = options.rows, size = w / squares_across, half_line = size / 20;
  Shape upright, level;
  for (int i = 0; i <= squares_across; ++i)
    upright.add_rectangle(i * size - half_line, 0, i * size + half_line, h);
  // From the middle, as in a board of squares: the rows need not be a multiple of them.
  const double first = h / 2 - size * squares_across / 2;
  for (int i = 0; i <= squares_across; ++i) {
    const double y = first + i * size;
    if (y > -half_line && y < h + half_line) level.add_rectangle(0, y - half_line, w, y + half_line);
  }
  canvas.draw(upright, canvas.flat_paint(0));
  canvas.draw(level, canvas.flat_paint(0));
  return std::move(canvas).lit();
}

Scene wall_chart(const ChartOptions& options) {
  ChartCanvas canvas(options);
  canvas.fill(canvas.flat_paint(1));
  return std::move(canvas).lit();
}

Scene slanted_edge_chart(const ChartOptions& options, double angle_deg) {
  if (!(std::abs(angle_deg) <= 45))
    throw InputError(
        fmt::format("an edge {} degrees from the vertical; -45 to 45 would be right", angle_deg));
  ChartCanvas canvas(options);
  canvas.fill(canvas.flat_paint(edge_dark));
  const double w = options.columns, h = options.rows;
  const double lean = std::tan(radians(angle_deg)) * h / 2;
  const double beyond = w + std::abs(lean);
  Shape right_half;
  right_half.add_polygon(
      std::array<Point, 4>{{{w / 2 + lean, 0}, {beyond, 0}, {beyond, h}, {w / 2 - lean, h}}});
  canvas.draw(right_half, canvas.flat_paint(edge_light));
  return std::move(canvas).lit();
}

}  // namespace petzval
