// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/colour/spectra_files.h>
#include <petzval/scene/charts.h>
#include <petzval/scene/lettering.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

ChartOptions at_distance(ChartOptions options) {
  constexpr double usual_m = 1;
  if (!options.distance_m) options.distance_m = usual_m;
  return options;
}

/// Samples that a shape covers by half and more are at a depth.
void set_depth(const Shape& shape, double depth_m, const Scene& scene, std::vector<float>& depths) {
  const auto width = static_cast<std::size_t>(scene.columns());
  parallel_for(static_cast<std::size_t>(scene.rows()), [&](std::size_t row) {
    std::vector<double> covered(width);
    shape.coverage(static_cast<int>(row), covered);
    for (std::size_t column = 0; column < width; ++column)
      if (covered[column] >= 0.5) depths[row * width + column] = static_cast<float>(depth_m);
  });
}

/// Cards one in front of the other, and a wall. The layout is in thirds of the chart's height, origin in the
/// middle of the picture.
class Cards {
 public:
  explicit Cards(const ChartOptions& options)
      : canvas_(options),
        unit_(std::min(options.columns / 4.0, options.rows / 3.0)),
        middle_{options.columns / 2.0, options.rows / 2.0} {
    for (const double ratio : ratios) depths_m_.push_back(ratio * *options.distance_m);
  }

  Scene draw(const std::string& name);

 private:
  /// Distances over that of the middle card: wall, far, middle and near card.
  static constexpr std::array<double, 4> ratios = {4, 1.8, 1, 0.6};

  Point at(double x, double y) const { return {middle_.x + unit_ * x, middle_.y + unit_ * y}; }
  Shape rectangle(double left, double top, double right, double bottom) const {
    const Point a = at(left, top), b = at(right, bottom);
    Shape shape;
    shape.add_rectangle(a.x, a.y, b.x, b.y);
    return shape;
  }
  void text(const char* words, double left, double top, double height) {
    Shape letters;
    const Point corner = at(left, top);
    add_text(letters, words, corner.x, corner.y, height * unit_);
    canvas_.draw(letters, canvas_.flat_paint(0.03));
  }
  void draw_wall();
  void draw_squares(double left, double top, double side, int across, int down);

  ChartCanvas canvas_;
  double unit_;
  Point middle_;
  std::vector<double> depths_m_;
};

/// Dark, with rows of small lamps that show what becomes of a point.
void Cards::draw_wall() {
  canvas_.fill(canvas_.flat_paint(0.05));
  Shape lamps;
  constexpr double spacing = 0.4, radius = 0.012;
  const int across = static_cast<int>(middle_.x / unit_ / spacing),
            down = static_cast<int>(middle_.y / unit_ / spacing);
  for (int row = -down; row <= down; ++row)
    for (int column = -across; column <= across; ++column)
      lamps.add_disc(at(spacing * (column + 0.5 * (row % 2)), spacing * row), radius * unit_);
  constexpr double bright = 20;  // they shine: more than a white surface
  canvas_.draw(lamps, canvas_.flat_paint(bright));
}

void Cards::draw_squares(double left, double top, double side, int across, int down) {
  Shape squares;
  for (int row = 0; row < down; ++row)
    for (int column = row % 2; column < across; column += 2) {
      const Point a = at(left + column * side, top + row * side);
      squares.add_rectangle(a.x, a.y, a.x + side * unit_, a.y + side * unit_);
    }
  canvas_.draw(squares, canvas_.flat_paint(0.05));
}

Scene Cards::draw(const std::string& name) {
  draw_wall();
  const Shape far = rectangle(-0.35, -1.1, 1.55, 0.2), middle = rectangle(-1.1, -0.5, 0.55, 0.75),
              near = rectangle(-1.75, 0.2, -0.35, 1.3);
  canvas_.draw(far, canvas_.flat_paint(0.6));
  draw_colorchecker(canvas_, at(-0.25, -1.05), 1.7 * unit_);
  canvas_.draw(middle, canvas_.flat_paint(0.8));
  text("PETZVAL", -0.95, -0.4, 0.22);
  text("IN FOCUS", -0.95, -0.02, 0.16);
  draw_squares(-0.95, 0.28, 0.05, 27, 7);
  canvas_.draw(near, canvas_.flat_paint(0.7));
  draw_squares(-1.65, 0.3, 0.15, 8, 6);

  Scene scene = std::move(canvas_).lit();
  scene.name = name;
  scene.depth_m.assign(scene.band_size(), static_cast<float>(depths_m_[0]));
  set_depth(far, depths_m_[1], scene, scene.depth_m);
  set_depth(middle, depths_m_[2], scene, scene.depth_m);
  set_depth(near, depths_m_[3], scene, scene.depth_m);
  return scene;
}

}  // namespace

Scene cards_chart(const ChartOptions& options) {
  return Cards(at_distance(options)).draw("cards");
}

Scene slanted_plane_chart(const ChartOptions& asked) {
  const ChartOptions options = at_distance(asked);
  // Reciprocal distance is linear in the tangent of the object angle: 1/z = (1 − slope τ)/d, τ from −1 at the
  // left edge to 1 at the right one. A line x = c of the plane, in half widths at d, is seen at
  // τ = c/(1 + slope c); a line y = c runs along c (1 − slope τ).
  constexpr double slope = 0.5;
  constexpr int squares_across = 16;  // of those at d that would fill the width
  const double half_width = options.columns / 2.0, half_height = options.rows / 2.0;
  const auto seen = [&](double x, double y) {
    const double tau = x / (1 + slope * x);
    return Point{half_width * (1 + tau), half_height + half_width * y * (1 - slope * tau)};
  };
  const double first_x = -1 / (1 + slope), last_x = 1 / (1 - slope);
  const double last_y = half_height / half_width / (1 - slope), side = 2.0 / squares_across;
  ChartCanvas canvas(options);
  canvas.fill(canvas.flat_paint(0.9));
  Shape dark;
  for (int i = static_cast<int>(std::floor(first_x / side)); i * side < last_x; ++i)
    for (int j = static_cast<int>(std::floor(-last_y / side)); j * side < last_y; ++j) {
      if ((i + j) % 2 != 0) continue;
      const double x0 = i * side, x1 = x0 + side, y0 = j * side, y1 = y0 + side;
      dark.add_polygon(std::array<Point, 4>{seen(x0, y0), seen(x1, y0), seen(x1, y1), seen(x0, y1)});
    }
  canvas.draw(dark, canvas.flat_paint(0.05));
  Scene scene = std::move(canvas).lit();
  scene.depth_m.resize(scene.band_size());
  const auto width = static_cast<std::size_t>(options.columns);
  for (std::size_t i = 0; i < scene.depth_m.size(); ++i) {
    const double tau = (double(i % width) + 0.5) / half_width - 1;
    scene.depth_m[i] = static_cast<float>(*options.distance_m / (1 - slope * tau));
  }
  return scene;
}

}  // namespace petzval
