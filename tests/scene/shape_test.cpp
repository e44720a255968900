// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/scene/lettering.h>
#include <petzval/scene/shape.h>

#include <array>
#include <cmath>
#include <numeric>
#include <random>

namespace petzval {
namespace {

// Sums of a few hundred terms of order 1 in double precision.
constexpr double rounding = 1e-11;
constexpr double of_floats = 0x1p-23;  ///< the rounding of values up to 1

std::vector<double> row_of(const Shape& shape, int row, std::size_t columns) {
  std::vector<double> pixels(columns);
  shape.coverage(row, pixels);
  return pixels;
}

double area(const Shape& shape, int rows, std::size_t columns) {
  double sum = 0;
  for (int row = 0; row < rows; ++row) {
    const std::vector<double> pixels = row_of(shape, row, columns);
    sum = std::accumulate(pixels.begin(), pixels.end(), sum);
  }
  return sum;
}

TEST(Shape, RectangleCoversPixelsInPart) {
  Shape shape;
  shape.add_rectangle(1.25, 0.5, 3.5, 2);
  EXPECT_EQ(row_of(shape, 0, 5), (std::vector<double>{0, 0.375, 0.5, 0.25, 0}));
  EXPECT_EQ(row_of(shape, 1, 5), (std::vector<double>{0, 0.75, 1, 0.5, 0}));
  EXPECT_EQ(row_of(shape, 2, 5), (std::vector<double>(5, 0.0)));
}

TEST(Shape, TriangleByHand) {
  // The edge from (0, 0) to (4, 2) leaves 1/4, 3/4 … of the pixels below it.
  Shape shape;
  shape.add_polygon(std::array<Point, 3>{{{0, 0}, {4, 2}, {0, 2}}});
  EXPECT_EQ(row_of(shape, 0, 4), (std::vector<double>{0.75, 0.25, 0, 0}));
  EXPECT_EQ(row_of(shape, 1, 4), (std::vector<double>{1, 1, 0.75, 0.25}));
}

TEST(Shape, DirectionDoesNotMatter) {
  Shape clockwise, counterclockwise;
  clockwise.add_polygon(std::array<Point, 3>{{{0.3, 0.2}, {3.7, 1.1}, {1.2, 2.9}}});
  counterclockwise.add_polygon(std::array<Point, 3>{{{1.2, 2.9}, {3.7, 1.1}, {0.3, 0.2}}});
  for (int row = 0; row < 3; ++row)
    for (std::size_t x = 0; x < 4; ++x)
      EXPECT_NEAR(row_of(clockwise, row, 4)[x], row_of(counterclockwise, row, 4)[x], rounding);
}

TEST(Shape, AreaIsThatOfGeometry) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(0, 30), size(0.1, 9), angle(-4, 4);
  for (int i = 0; i < 50; ++i) {
    const double side = size(random);
    Shape square, disc;
    square.add_square({place(random) + 10, place(random) + 10}, side, angle(random));
    EXPECT_NEAR(area(square, 50, 50), side * side, 50 * rounding);
    disc.add_disc({place(random) + 10, place(random) + 10}, side, 90);
    EXPECT_NEAR(area(disc, 50, 50), 45 * side * side * std::sin(2 * pi / 90), 50 * rounding)
        << "regular 90-gon";
  }
}

TEST(Shape, WhatIsOutsideThePictureDoesNotMatter) {
  // A square that sticks out on all sides is the whole picture; one cut by each border agrees with the same
  // one in a larger picture.
  Shape everything;
  everything.add_square({2, 2}, 100, 0.4);
  EXPECT_NEAR(area(everything, 4, 4), 16, rounding);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> place(-4, 14), angle(-4, 4);
  for (int i = 0; i < 100; ++i) {
    const Point centre{place(random), place(random)};
    const double turn = angle(random);
    Shape here, shifted;
    here.add_square(centre, 5, turn);
    shifted.add_square({centre.x + 20, centre.y + 20}, 5, turn);
    for (int row = 0; row < 10; ++row) {
      const std::vector<double> small = row_of(here, row, 10), large = row_of(shifted, row + 20, 50);
      for (std::size_t x = 0; x < 10; ++x) EXPECT_NEAR(small[x], large[x + 20], rounding);
    }
  }
}

TEST(Shape, AgreesWithCountingPoints) {
  // Another method: 64 × 64 points a pixel, inside or outside. An edge of length below 2 in a pixel misjudges
  // less than 2 · 64 of 4096 points by half each.
  const std::array<Point, 4> corners = {{{0.7, 1.3}, {6.2, 0.4}, {4.1, 5.9}, {2.9, 2.2}}};  // not convex
  Shape shape;
  shape.add_polygon(corners);
  const auto inside = [&](double x, double y) {
    bool is_inside = false;
    for (std::size_t i = 0, j = 3; i < 4; j = i++)
      if ((corners[i].y > y) != (corners[j].y > y) &&
          x < (corners[j].x - corners[i].x) * (y - corners[i].y) / (corners[j].y - corners[i].y) +
                  corners[i].x)
        is_inside = !is_inside;
    return is_inside;
  };
  for (int row = 0; row < 7; ++row) {
    const std::vector<double> pixels = row_of(shape, row, 7);
    for (std::size_t x = 0; x < 7; ++x) {
      int count = 0;
      for (int i = 0; i < 64; ++i)
        for (int j = 0; j < 64; ++j)
          count += inside(static_cast<double>(x) + (i + 0.5) / 64, row + (j + 0.5) / 64);
      EXPECT_NEAR(pixels[x], count / 4096.0, 64.0 / 4096) << row << " " << x;
    }
  }
}

// Against each shape by itself: discs and a triangle that are cut by all borders, or lie outside.
TEST(ShapesInPicture, AddUpWhatEachShapeCovers) {
  constexpr std::size_t columns = 40;
  constexpr int rows = 30;
  std::vector<Shape> shapes(5);
  shapes[0].add_disc({3, 4}, 6.3);
  shapes[1].add_disc({20.2, 15.1}, 9.7);
  shapes[2].add_polygon(std::array<Point, 3>{{{31, -8}, {52, 12}, {33.3, 37}}});
  shapes[3].add_disc({-9, 12}, 5);
  shapes[4].add_rectangle(columns, 2, columns + 7.5, 9);
  const std::vector<double> values{0.25, 3, 0, 7, 11};
  std::vector<ShapesInPicture::Valued> valued;
  for (std::size_t i = 0; i < shapes.size(); ++i) valued.push_back({&shapes[i], values[i]});
  const ShapesInPicture all(valued, static_cast<int>(columns), rows);
  std::size_t covered_in_part = 0;
  for (int row = 0; row < rows; ++row) {
    std::vector<float> coverage(columns), light(columns);
    std::vector<double> alone(columns);
    const auto [from, end] = all.coverage(row, coverage, light);
    const auto reach = all.coverage(row, alone);
    EXPECT_EQ(reach.from, from);
    EXPECT_EQ(reach.end, end);
    std::vector<double> covered(columns), lit(columns);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const std::vector<double> of_shape = row_of(shapes[i], row, columns);
      for (std::size_t x = 0; x < columns; ++x) {
        covered[x] += of_shape[x];
        lit[x] += values[i] * of_shape[x];
      }
    }
    for (std::size_t x = 0; x < columns; ++x) {
      covered_in_part += static_cast<std::size_t>(covered[x] > 0.01 && covered[x] < 0.99);
      EXPECT_NEAR(x < from || x >= end ? 0 : coverage[x], covered[x], of_floats) << row << " " << x;
      EXPECT_NEAR(x < from || x >= end ? 0 : alone[x], covered[x], rounding) << row << " " << x;
      EXPECT_NEAR(x < from || x >= end ? 0 : light[x], lit[x], 11 * of_floats) << row << " " << x;
    }
  }
  EXPECT_GT(covered_in_part, 100U);
}

TEST(ShapesInPicture, CountAnOverlapOfAShapeWithItselfOnce) {
  Shape twice;
  twice.add_rectangle(1, 0, 6, 1);
  twice.add_rectangle(4, 0, 9, 1);
  const ShapesInPicture::Valued one{&twice, 5};
  std::vector<float> coverage(10), light(10);
  const auto [from, end] = ShapesInPicture(std::span(&one, 1), 10, 1).coverage(0, coverage, light);
  EXPECT_EQ(from, 1U);
  EXPECT_EQ(end, 9U);
  for (std::size_t x = from; x < end; ++x) {
    EXPECT_EQ(coverage[x], 1) << x;
    EXPECT_EQ(light[x], 5) << x;
  }
}

// Rounding along an edge must not lead beyond its ends, where there is no room for it. Corners on the grid of
// pixels are where it would.
TEST(ShapesInPicture, StayWithinTheirCorners) {
  constexpr int side = 40;
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> on_grid(0, side);
  std::uniform_real_distribution<double> anywhere(0, side);
  for (int i = 0; i < 20000; ++i) {
    std::array<Point, 3> corners;
    for (Point& corner : corners) corner = {double(on_grid(random)), anywhere(random)};
    Shape triangle;
    triangle.add_polygon(corners);
    const ShapesInPicture::Valued one{&triangle, 2};
    const ShapesInPicture in_picture(std::span(&one, 1), side, side);
    const int row = static_cast<int>(std::min(corners[1].y, side - 1.0));
    std::vector<float> coverage(side), light(side);
    const auto [from, end] = in_picture.coverage(row, coverage, light);
    const std::vector<double> alone = row_of(triangle, row, side);
    for (std::size_t x = 0; x < side; ++x) {
      ASSERT_NEAR(x < from || x >= end ? 0 : coverage[x], alone[x], of_floats) << i << " " << x;
      ASSERT_NEAR(light[x], 2 * coverage[x], 2 * of_floats) << i << " " << x;
    }
  }
}

TEST(Lettering, StaysInItsBox) {
  Shape shape;
  const char* text = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-/";
  add_text(shape, text, 10, 5, 20);
  EXPECT_GE(shape.top(), 5 - 2) << "slanted strokes reach a little beyond";
  EXPECT_LE(shape.bottom(), 25 + 2);
  const std::size_t columns = static_cast<std::size_t>(text_width(text, 20)) + 20;
  const double ink = area(shape, 30, columns), box = 20 * text_width(text, 20);
  EXPECT_GT(ink, 0.1 * box);
  EXPECT_LT(ink, 0.6 * box);
}

/// How much of each pixel a character covers.
std::vector<double> ink_of(char character) {
  Shape shape;
  add_text(shape, std::string(1, character), 4, 4, 14);
  std::vector<double> ink;
  for (int row = 0; row < 26; ++row)
    for (const double share : row_of(shape, row, 18)) ink.push_back(share);
  return ink;
}

TEST(Lettering, EveryCharacterOfALabelIsDrawnAndLooksLikeNoOther) {
  const std::string drawn = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.,:=+-_/%@()[]";
  for (const char a : drawn) {
    const std::vector<double> one = ink_of(a);
    EXPECT_GT(std::accumulate(one.begin(), one.end(), 0.0), 0) << a;
    for (const char b : drawn) {
      if (b <= a) continue;
      double apart = 0;
      const std::vector<double> other = ink_of(b);
      for (std::size_t i = 0; i < one.size(); ++i) apart += std::abs(one[i] - other[i]);
      constexpr double a_dot = 3;  // of strokes 1.8 pixels wide
      EXPECT_GT(apart, a_dot) << a << " and " << b;
    }
  }
}

TEST(Lettering, SmallLettersAreLowerAndReachBelowAsFarAsSaid) {
  const double height = 69, step = 10, slant = 2;
  for (const char letter : std::string("acegmnopqrsuvwxyz")) {
    Shape shape;
    add_text(shape, std::string(1, letter), 0, 0, height);
    EXPECT_GE(shape.top(), 2 * step - slant) << letter;
  }
  const std::string tails = "gjpqy_";
  for (char letter = 'a'; letter <= 'z'; ++letter) {
    Shape shape;
    add_text(shape, std::string(1, letter), 0, 0, height);
    EXPECT_LE(shape.bottom(), height + text_descent(height) + slant) << letter;
    EXPECT_EQ(shape.bottom() > height + slant, tails.find(letter) != tails.npos) << letter;
  }
  EXPECT_NEAR(text_descent(height), 2 * step, 1e-9);
}

TEST(Lettering, LetterIIsThreeBars) {
  // 7 grid steps high less the rounding of the box: strokes of 0.9 steps, two level ones of 2.9, one upright
  // of 6.9 that overlaps them by 0.9 each.
  Shape shape;
  add_text(shape, "I", 0, 0, 69);
  EXPECT_NEAR(area(shape, 70, 60), 100 * (2 * 0.9 * 2.9 + 0.9 * (6.9 - 1.8)), 1e-6);
}

TEST(Lettering, UnknownCharactersAreGaps) {
  Shape shape;
  add_text(shape, "\t~\xff é", 0, 0, 10);
  EXPECT_TRUE(shape.empty());
  EXPECT_EQ(text_width("", 10), 0);
}

}  // namespace
}  // namespace petzval
