// SPDX-License-Identifier: BSD-3-Clause
// Photosites and low-pass filters made of cells, against their transforms in closed form.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/imaging/pixel_gather.h>

#include <cmath>
#include <numeric>

namespace petzval {
namespace {

Photosite site(Photosite::Shape shape, double width, double height, double low_pass = 0) {
  Photosite result;
  result.shape = shape;
  result.width = width;
  result.height = height;
  result.separation_x = result.separation_y = low_pass;
  return result;
}

const Photosite plain, small = Photosite::square(0.5), wide = site(Photosite::Shape::rectangle, 0.9, 0.4),
                       round = site(Photosite::Shape::ellipse, 0.8, 0.8, 0.4),
                       filtered = site(Photosite::Shape::rectangle, 1, 1, 0.7);

double worst_to_nyquist(const Photosite& wanted, const PixelTaps& taps, int boxes) {
  double worst = 0;
  for (double fx = 0; fx <= 0.5; fx += 0.05)
    for (double fy = 0; std::hypot(fx, fy) <= 0.5; fy += 0.05)
      worst = std::max(worst, std::abs(taps.transform(fx, fy, boxes) - wanted.transform(fx, fy).real()));
  return worst;
}

TEST(PixelGather, OneBoxTilesAPixelExactly) {
  for (const int cells : {1, 2, 3, 8})
    EXPECT_LT(worst_to_nyquist(plain, pixel_taps(plain, cells, 1), 1), 1e-12) << cells;
}

TEST(PixelGather, TapsPassWhatThePhotositeDoes) {
  for (const Photosite& wanted : {small, wide, round, filtered})
    for (const int boxes : {1, 2}) {
      const int cells = cells_for(wanted, boxes, 1);
      // cells_for looks along the axes and the diagonal; the rest of the plane lies between them.
      EXPECT_LT(worst_to_nyquist(wanted, pixel_taps(wanted, cells, boxes), boxes), 0.011)
          << wanted.text() << " of " << cells << " cells after " << boxes << " boxes";
      EXPECT_GE(cells_for(wanted, boxes, 5), 5);
    }
  // A cell that sees a mean and receives one: the pixel aperture once all the same.
  EXPECT_LT(worst_to_nyquist(plain, pixel_taps(plain, 3, 2), 2), 0.012);
  EXPECT_LT(worst_to_nyquist(plain, pixel_taps(plain, 8, 2), 2), 0.002);
}

TEST(PixelGather, WeightsAreSharesOfOne) {
  for (const Photosite& wanted : {plain, small, wide, round, filtered}) {
    const PixelTaps taps = pixel_taps(wanted, 4, 2);
    EXPECT_NEAR(std::accumulate(taps.weights.begin(), taps.weights.end(), 0.0), 1, 1e-12);
    for (const double weight : taps.weights) EXPECT_GE(weight, 0);
  }
}

TEST(PixelGather, PixelsAreWhereTheCellsAre) {
  // Light that rises linearly: the mean over any symmetric photosite is the value at the pixel's centre.
  const SensorGeometry sensor{5, 4, 6.0};
  for (const Photosite& wanted : {plain, small, round, filtered}) {
    const PixelTaps taps = pixel_taps(wanted, 4, 1);
    CellPlane plane(grown(subdivided(sensor, 4), taps.reach));
    for (std::size_t row = 0; row < plane.rows(); ++row)
      for (std::size_t column = 0; column < plane.columns(); ++column)
        plane.row(row)[column] = static_cast<float>(2 * plane.grid.x_mm(double(column) + 0.5) +
                                                    plane.grid.y_mm(double(row) + 0.5));
    const CellPlane pixels = gathered(plane, taps);
    ASSERT_EQ(pixels.grid.columns, sensor.columns);
    ASSERT_EQ(pixels.grid.rows, sensor.rows);
    EXPECT_NEAR(pixels.grid.pitch_um, sensor.pitch_um, 1e-12);
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 5; ++column)
        EXPECT_NEAR(pixels.row(static_cast<std::size_t>(row))[column],
                    2 * sensor.x_mm(column + 0.5) + sensor.y_mm(row + 0.5), 1e-8);  // of 0.03, in floats
  }
}

TEST(PixelGather, OtherShapesAreRefused) {
  Photosite star;
  star.shape = Photosite::Shape::polygon;
  star.vertices = {{0, 0}, {1, 0}, {0, 1}};
  EXPECT_THROW(pixel_taps(star, 4, 1), InputError);
  EXPECT_THROW(pixel_taps(site(Photosite::Shape::rectangle, 1.5, 1), 4, 1), InputError);
}

}  // namespace
}  // namespace petzval
