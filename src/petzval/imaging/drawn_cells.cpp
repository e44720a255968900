// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/drawn_cells.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace petzval {

namespace {

/// How far an edge may pass beside the true one [cells].
constexpr double bend_cells = 2e-3;
/// Pieces are no longer than this, so that a bend one way and back is seen [cells].
constexpr double longest_cells = 64;
constexpr int deepest = 20;

/// Places of the scene on the grid, corner after corner.
class Layout {
 public:
  Layout(const SceneLook& look, const SensorGeometry& grid) : look_(look), grid_(grid) {}

  std::optional<Point> cell_of(Point sample) {
    const std::optional<ImagePlace> place = look_.image_of(sample.x, sample.y, last_);
    if (!place) return std::nullopt;
    last_ = *place;
    const double pitch_mm = grid_.pitch_um * mm_per_um;
    return Point{grid_.columns / 2.0 - place->x_mm / pitch_mm, grid_.rows / 2.0 + place->y_mm / pitch_mm};
  }

  /// Adds the image of an edge to a shape. False where there is none.
  bool add(const Shape::Edge& edge, Shape& shape) {
    // Most edges begin where the last one ended.
    const std::optional<Point> from = end_ && edge.from == end_sample_ ? end_ : cell_of(edge.from);
    end_sample_ = edge.to;
    end_ = cell_of(edge.to);
    return from && end_ && add_between(edge, *from, *end_, 0, shape);
  }

 private:
  bool add_between(const Shape::Edge& edge, Point from, Point to, int depth, Shape& shape) {
    const Point middle{(edge.from.x + edge.to.x) / 2, (edge.from.y + edge.to.y) / 2};
    const std::optional<Point> bent = cell_of(middle);
    if (!bent) return false;
    const auto within = [](double x, double y, double length) { return x * x + y * y <= length * length; };
    const bool is_short = within(to.x - from.x, to.y - from.y, longest_cells),
               is_straight = within(bent->x - (from.x + to.x) / 2, bent->y - (from.y + to.y) / 2, bend_cells);
    if (depth == deepest || (is_straight && (is_short || is_away(from, to)))) {
      shape.add_edge({from, to});
      return true;
    }
    return add_between({edge.from, middle}, from, *bent, depth + 1, shape) &&
           add_between({middle, edge.to}, *bent, to, depth + 1, shape);
  }

  /// Whether no cell is near.
  bool is_away(Point from, Point to) const {
    const auto beyond = [](double a, double b, double size) {
      return (a < -longest_cells && b < -longest_cells) ||
             (a > size + longest_cells && b > size + longest_cells);
    };
    return beyond(from.x, to.x, grid_.columns) || beyond(from.y, to.y, grid_.rows);
  }

  const SceneLook& look_;
  const SensorGeometry& grid_;
  ImagePlace last_{};
  Point end_sample_{};
  std::optional<Point> end_{};
};

}  // namespace

std::unique_ptr<DrawnCells> DrawnCells::make(const SceneDrawing& drawing, int band, const SceneLook& look,
                                             const SensorGeometry& grid) {
  std::vector<std::optional<Shape>> laid(drawing.figures.size());
  parallel_for(laid.size(), [&](std::size_t index) {
    Layout layout(look, grid);
    Shape shape;
    for (const Shape::Edge& edge : drawing.figures[index].shape->edges())
      if (!layout.add(edge, shape)) return;
    laid[index] = std::move(shape);
  });
  std::vector<ShapesInPicture::Valued> figures;
  for (std::size_t index = 0; index < laid.size(); ++index) {
    if (!laid[index]) return nullptr;
    figures.push_back(
        {&*laid[index], double(drawing.figures[index].radiance[static_cast<std::size_t>(band)])});
  }
  return std::unique_ptr<DrawnCells>(new DrawnCells(ShapesInPicture(figures, grid.columns, grid.rows),
                                                    static_cast<std::size_t>(grid.columns)));
}

void DrawnCells::cover(std::size_t row, Row& cells) const {
  cells.covered.resize(columns_);
  cells.radiance.resize(columns_);
  const auto [from, end] = figures_.coverage(static_cast<int>(row), cells.covered, cells.radiance);
  for (std::vector<float>* values : {&cells.covered, &cells.radiance}) {
    std::fill_n(values->begin(), from, 0.0F);
    std::fill(values->begin() + std::ptrdiff_t(end), values->end(), 0.0F);
  }
}

}  // namespace petzval
