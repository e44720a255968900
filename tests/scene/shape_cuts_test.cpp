// SPDX-License-Identifier: BSD-3-Clause
// Shapes that cover each other, cut apart, against places looked up one by one.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/scene/lettering.h>
#include <petzval/scene/shape_cuts.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace petzval {
namespace {

/// How often a shape winds about a place: its edges to the right of it.
int winding(const Shape& shape, Point at) {
  int turns = 0;
  for (const Shape::Edge& edge : shape.edges()) {
    const Point &a = edge.from, &b = edge.to;
    if ((a.y <= at.y) == (b.y <= at.y)) continue;
    if (a.x + (b.x - a.x) * (at.y - a.y) / (b.y - a.y) > at.x) turns += b.y > a.y ? 1 : -1;
  }
  return turns;
}

std::vector<const Shape*> pointers(const std::vector<Shape>& shapes) {
  std::vector<const Shape*> result;
  for (const Shape& shape : shapes) result.push_back(&shape);
  return result;
}

template <typename Place>
void expect_last_shapes(const std::vector<Shape>& shapes, const Place& place) {
  const std::vector<Shape> parts = uncovered_parts(pointers(shapes));
  ASSERT_EQ(parts.size(), shapes.size());
  int covered = 0;
  for (int sample = 0; sample < 20000; ++sample) {
    const Point at = place();
    std::size_t last = shapes.size();
    for (std::size_t i = 0; i < shapes.size(); ++i)
      if (winding(shapes[i], at) != 0) last = i;
    covered += last < shapes.size();
    for (std::size_t i = 0; i < parts.size(); ++i) ASSERT_EQ(std::abs(winding(parts[i], at)), i == last) << i;
  }
  EXPECT_GT(covered, 10000);  // else nothing was tried
}

TEST(UncoveredParts, EachPlaceBelongsToTheLastShapeOverIt) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(0, 40), size(2, 12), angle(-3, 3);
  std::vector<Shape> shapes(30);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Point centre{place(random), place(random)};
    if (i % 3 == 0)
      shapes[i].add_disc(centre, size(random), 17);
    else
      shapes[i].add_square(centre, size(random), angle(random));
  }
  expect_last_shapes(shapes, [&] { return Point{place(random), place(random)}; });
}

// As many outlines as are cut by halves: letters with holes under two gratings.
TEST(UncoveredParts, ManyOutlinesBelongToTheLastShapeOverThem) {
  constexpr int lines = 120;
  std::vector<Shape> shapes(3);
  for (int row = 0; row < 20; ++row) add_text(shapes[0], "BO8QR", 1.5, 1 + 6 * row, 5);
  for (int i = 0; i < lines; ++i) {
    const double x = 0.3 * i, slant = 4;
    shapes[1].add_polygon(
        std::array<Point, 4>{{{x, 0}, {x + 0.1, 0}, {x + 0.1 + slant, 120}, {x + slant, 120}}});
    shapes[2].add_rectangle(0, i, 40, i + 0.45);
  }
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> x(0, 40), y(0, 120);
  expect_last_shapes(shapes, [&] { return Point{x(random), y(random)}; });
}

// Corners are rounded to 2^-24, and each moves an edge of some pixels by as much.
constexpr double of_corners = 1e-6;

// Pixels that the border between two shapes crosses are covered by both together: none of the ground shows.
TEST(UncoveredParts, MeetWithoutAGap) {
  const double border = 4.3, lean = 0.4;
  std::vector<Shape> shapes(3);
  shapes[0].add_polygon(std::array<Point, 4>{{{1, 1}, {border, 1}, {border + lean, 9}, {1, 9}}});
  shapes[1].add_polygon(std::array<Point, 4>{{{border, 1}, {9, 1}, {9, 9}, {border + lean, 9}}});
  shapes[2].add_rectangle(3.2, 3.7, 5.1, 6.4);
  const std::vector<Shape> parts = uncovered_parts(pointers(shapes));
  std::vector<double> sum(10), coverage(10);
  for (int row = 1; row < 9; ++row) {
    std::fill(sum.begin(), sum.end(), 0.0);
    for (const Shape& part : parts) {
      part.coverage(row, coverage);
      for (std::size_t column = 0; column < sum.size(); ++column) sum[column] += coverage[column];
    }
    for (std::size_t column = 1; column < 9; ++column)
      EXPECT_NEAR(sum[column], 1, of_corners) << row << ' ' << column;
  }
}

TEST(UncoveredParts, LeavesAShapeThatNothingCoversAsItIs) {
  std::vector<Shape> shapes(2);
  shapes[0].add_square({5, 5}, 4, 0.3);
  shapes[1].add_square({15, 5}, 4, 0.3);
  const std::vector<Shape> parts = uncovered_parts(pointers(shapes));
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    ASSERT_EQ(parts[i].edges().size(), shapes[i].edges().size());
    for (std::size_t k = 0; k < parts[i].edges().size(); ++k)
      EXPECT_EQ(parts[i].edges()[k].from, shapes[i].edges()[k].from);
  }
}

// A cross of two bars, either of them either way round.
TEST(United, CoversWhatOutlinesShareOnce) {
  const std::vector<std::vector<Point>> bars{{{0, 4}, {10, 4}, {10, 6}, {0, 6}},
                                             {{4, 0}, {4, 10}, {6, 10}, {6, 0}}};
  const Shape cross = united(bars);
  double area = 0;
  std::vector<double> coverage(10);
  for (int row = 0; row < 10; ++row) {
    cross.coverage(row, coverage);
    for (const double pixel : coverage) area += pixel;
  }
  EXPECT_NEAR(area, 20 + 20 - 4, of_corners);
  EXPECT_EQ(std::abs(winding(cross, {5, 5})), 1);
}

// Strokes of a letter overlap at its corners. No place is covered twice, and a ring stays open within.
TEST(United, LettersCoverEachPlaceOnce) {
  Shape letters;
  add_text(letters, "QR8@", 1, 1, 20);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> x(0, 80), y(0, 22);
  int inside = 0;
  for (int sample = 0; sample < 20000; ++sample) {
    const int turns = std::abs(winding(letters, {x(random), y(random)}));
    ASSERT_LE(turns, 1);
    inside += turns;
  }
  EXPECT_GT(inside, 2000);
  Shape ring;
  add_text(ring, "O", 0, 0, 69);
  EXPECT_EQ(winding(ring, {24.5, 34.5}), 0);
  EXPECT_NE(winding(ring, {4.5, 34.5}), 0);
}

}  // namespace
}  // namespace petzval
