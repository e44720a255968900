// SPDX-License-Identifier: BSD-3-Clause
#define ZX_USE_UTF8
#include <ZXing/ReadBarcode.h>
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/scene/chart_figures.h>
#include <petzval/scene/named_chart.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace petzval {
namespace {

ChartParameter number(double value) {
  return {std::to_string(value), value};
}

/// Reflectance of a chart by name, over that of white.
std::vector<float> reflectances(const std::string& name, int columns, int rows) {
  ChartOptions options;
  options.columns = columns, options.rows = rows, options.wavelengths_nm = {550};
  const Scene scene = make_chart(name, *find_chart(name), options);
  const float white = *std::max_element(scene.band(0).begin(), scene.band(0).end());
  std::vector<float> values(scene.band(0).begin(), scene.band(0).end());
  for (float& value : values) value /= white;
  return values;
}

std::size_t crossings(const std::vector<double>& values, double level) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    count += (values[i] < level) != (values[(i + 1) % values.size()] < level);
  return count;
}

TEST(ChartFigures, SiemensStarHasItsSectorsAtEveryRadius) {
  constexpr int size = 600, sectors = 24;
  const std::vector<float> star = reflectances("siemens:24", size, size);
  // From where a sector is three samples wide to near the rim.
  for (const double radius : {30.0, 100.0, 250.0}) {
    std::vector<double> ring;
    for (int i = 0; i < 4000; ++i) {
      const double angle = 2 * pi * (i + 0.5) / 4000;
      const int x = static_cast<int>(size / 2.0 + radius * std::cos(angle)),
                y = static_cast<int>(size / 2.0 + radius * std::sin(angle));
      ring.push_back(star[static_cast<std::size_t>(y * size + x)]);
    }
    EXPECT_EQ(crossings(ring, 0.5), std::size_t{2 * sectors}) << radius;
  }
}

TEST(ChartFigures, UsafBarsAreThoseOfTheStandard) {
  // MIL-STD-150A: 2^(g + (e − 1)/6) line pairs per mm, bars five times as long as wide, three upright and
  // three level ones an element. A picture of 4:3 and 24/2^g mm has group g first.
  constexpr int group = 1;
  constexpr double width_px = 4800, width_mm = 24 / 2.0;
  const FigureChart chart = usaf_figures({width_px, 3600}, number(group));
  std::vector<double> widths_mm;
  for (const std::vector<Point>& outline : chart.figures[0].outlines) {
    const double w = outline[2].x - outline[0].x, h = outline[2].y - outline[0].y;
    const bool is_bar = std::abs(std::max(w, h) / std::min(w, h) - 5) < 1e-9 && outline[0].y == outline[1].y;
    if (is_bar) widths_mm.push_back(std::min(w, h) * width_mm / width_px);
  }
  std::sort(widths_mm.rbegin(), widths_mm.rend());
  ASSERT_GE(widths_mm.size(), std::size_t{6 * 6 * 6});
  for (std::size_t i = 0; i < 6 * 6 * 6; ++i) {
    const double line_pairs = std::pow(2.0, group + static_cast<double>(i / 6) / 6);
    EXPECT_NEAR(widths_mm[i] * 2 * line_pairs, 1, 1e-9) << i;
  }
}

TEST(ChartFigures, WedgesOfIso12233HaveTheFrequenciesBesideThem) {
  // A picture 1800 high: the unit is 100. Upright wedges stand 4.7 units beside the middle, 8 units long,
  // from 200 to 2000/… line widths per picture height: half way it is the mean of both ends.
  constexpr int columns = 2400, rows = 1800;
  const std::vector<float> chart = reflectances("iso12233:1000", columns, rows);
  const double middle_lw_ph = (100 + 1000) / 2.0, line_px = rows / middle_lw_ph;
  std::vector<double> edges;
  const int row = rows / 2;
  const auto value = [&](int column) { return chart[static_cast<std::size_t>(row * columns + column)]; };
  for (int column = 1200 + 470 - 40; column < 1200 + 470 + 40; ++column)
    if ((value(column) < 0.5) != (value(column + 1) < 0.5))
      edges.push_back(column + (0.5 - value(column)) / double(value(column + 1) - value(column)));
  ASSERT_EQ(edges.size(), std::size_t{18});
  // Nine bars and eight gaps; the edges are found to a few hundredths of a sample.
  EXPECT_NEAR((edges.back() - edges.front()) / 17, line_px, 0.02);
}

TEST(ChartFigures, SlantedSquaresOfIso12233HaveFourToOneAndFiveDegrees) {
  constexpr int columns = 1200, rows = 900;
  const FigureChart chart = iso12233_figures({columns, rows}, {});
  EXPECT_NEAR(chart.ground / chart.figures[0].level, 4, 1e-12);
  for (const std::vector<Point>& square : chart.figures[0].outlines)
    EXPECT_NEAR(degrees(std::atan2(square[1].y - square[0].y, square[1].x - square[0].x)), 5, 1e-9);
}

TEST(ChartFigures, DotsCoverASixteenthOfPi) {
  const std::vector<float> dots = reflectances("dots:12", 480, 360);
  double dark = 0;
  for (const float value : dots) dark += 1 - value;
  // Radius a quarter of the pitch; 12 × 9 cells fill the picture. The polygon is within 1e-4 of the circle.
  EXPECT_NEAR(dark / dots.size(), pi / 16, 1e-4);
}

/// Squares of the size that was asked for, turned by 5°, half of the frame dark.
TEST(ChartFigures, SlantedBoardHasEdgesAllOver) {
  const FigureChart chart = slanted_board_figures({800, 600}, number(10));
  EXPECT_DOUBLE_EQ(chart.ground, 4 * chart.figures.at(0).level);
  Shape dark;
  for (const std::vector<Point>& outline : chart.figures[0].outlines) {
    const double right = outline[1].x - outline[0].x, down = outline[1].y - outline[0].y;
    EXPECT_NEAR(std::hypot(right, down), 80, 1e-9);
    EXPECT_NEAR(down / right, std::tan(radians(5.0)), 1e-12);
    dark.add_polygon(outline);
  }
  double covered = 0;
  std::vector<double> row(800);
  for (int y = 0; y < 600; ++y) {
    dark.coverage(y, row);
    for (const double area : row) covered += area;
  }
  EXPECT_NEAR(covered / (800 * 600), 0.5, 0.01);  // a light square in the middle: one more than dark ones
  EXPECT_THROW(slanted_board_figures({800, 600}, number(0)), InputError);
}

TEST(ChartFigures, ChessboardsLookDifferentUpsideDown) {
  for (const int across : {2, 3, 7, 10, 13}) {
    const FigureChart chart = chessboard_figures({800, 600}, number(across));
    std::set<std::pair<long, long>> squares, turned;
    for (const std::vector<Point>& square : chart.figures[0].outlines) {
      const double x = (square[0].x + square[2].x) / 2 - 400, y = (square[0].y + square[2].y) / 2 - 300;
      squares.insert({std::lround(x * 16), std::lround(y * 16)});
      turned.insert({std::lround(-x * 16), std::lround(-y * 16)});
      EXPECT_NEAR(square[1].x - square[0].x, square[2].y - square[1].y, 1e-9);
    }
    EXPECT_NE(squares, turned) << across;
  }
}

/// What another library reads.
std::string read_code(const std::string& name, int columns, int rows) {
  std::vector<std::uint8_t> grey;
  for (const float value : reflectances(name, columns, rows))
    grey.push_back(static_cast<std::uint8_t>(std::lround(255 * value)));
  const ZXing::Result result =
      ZXing::ReadBarcode({grey.data(), columns, rows, ZXing::ImageFormat::Lum}, ZXing::DecodeHints());
  return std::string(ZXing::ToString(result.format())) + " " + result.text();
}

TEST(ChartFigures, CodesSayTheirText) {
  EXPECT_EQ(read_code("qr:Petzval 1840, f/3.6", 320, 240), "QRCode Petzval 1840, f/3.6");
  EXPECT_EQ(read_code("qr", 200, 200), "QRCode PETZVAL 1840");
  EXPECT_EQ(read_code("datamatrix:https://example.org/a?b=c", 240, 240),
            "DataMatrix https://example.org/a?b=c");
  EXPECT_EQ(read_code("qr:Grüße", 320, 240), "QRCode Grüße");
}

TEST(ChartFigures, RefuseParametersThatAreNone) {
  ChartOptions options;
  for (const std::string name : {"siemens:1", "siemens:2.5", "siemens:many", "siemens:", "usaf1951:99",
                                 "iso12233:7", "dots:0", "chessboard:1", "wall:3", "dead-leaves:x"})
    EXPECT_THROW(make_chart(name, *find_chart(name), options), InputError) << name;
  EXPECT_THROW(make_chart("qr:" + std::string(5000, 'x'), *find_chart("qr"), options), InputError);
}

/// The mean area that a disc and itself, moved by d, have in common, for radii of the density r^-3.
double overlap_area(double d, double least, double most) {
  double sum = 0, weight = 0;
  constexpr int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const double r = least * std::pow(most / least, (i + 0.5) / steps), w = 1 / (r * r);  // r^-3 dr, dr ~ r
    if (2 * r > d) sum += w * (2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d));
    weight += w;
  }
  return sum / weight;
}

TEST(DeadLeaves, HaveTheCorrelationOfMatheronsModel) {
  // Two places show one leaf with the probability B(d)/(2 B(0) − B(d)) (Matheron 1968), B the mean overlap;
  // greys of different leaves are independent, so this is the correlation. 60 pictures hold some 900 patches
  // as large as the largest leaf: 0.05 is a standard deviation and a half and more.
  constexpr int columns = 256, rows = 192, pictures = 60;
  const double least = 1.5, most = rows / 4.0;
  ChartOptions options;
  options.columns = columns, options.rows = rows, options.wavelengths_nm = {550};
  for (const int d : {6, 16, 40}) {
    double product = 0, square = 0;
    for (int seed = 1; seed <= pictures; ++seed) {
      const Scene scene = dead_leaves_chart(options, static_cast<std::uint64_t>(seed));
      const double white = scene.illuminant->at(550);
      const auto grey = [&](int row, int column) {
        return scene.band(0)[static_cast<std::size_t>(row * columns + column)] / white - 0.5;
      };
      for (int row = 0; row < rows; ++row)
        for (int column = 0; column + d < columns; ++column) {
          product += grey(row, column) * grey(row, column + d);
          square += grey(row, column) * grey(row, column);
        }
    }
    const double b0 = overlap_area(0, least, most), b = overlap_area(d, least, most);
    EXPECT_NEAR(product / square, b / (2 * b0 - b), 0.05) << d;
  }
}

TEST(DeadLeaves, AreThoseOfTheirSeed) {
  EXPECT_EQ(reflectances("dead-leaves:7", 60, 40), reflectances("dead-leaves:7", 60, 40));
  EXPECT_NE(reflectances("dead-leaves:7", 60, 40), reflectances("dead-leaves:8", 60, 40));
}

}  // namespace
}  // namespace petzval
