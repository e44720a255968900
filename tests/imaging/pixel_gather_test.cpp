// SPDX-License-Identifier: BSD-3-Clause
// Photosites and low-pass filters made of cells, against their transforms in closed form.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/pixel_gather.h>

#include <cmath>

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

/// What the weights pass after a path, against the photosite, up to Nyquist's frequency: without the other
/// frequencies of the kernels' samples.
double worst_to_nyquist(const Photosite& wanted, const PixelTaps& taps, const LightPath& path) {
  double worst = 0;
  for (double fx = 0; fx <= 0.5; fx += 0.05)
    for (double fy = 0; std::hypot(fx, fy) <= 0.5; fy += 0.05) {
      double before = 1;
      for (const double f : {fx, fy}) {
        const double of_cell = f / taps.cells;
        // Closed forms of a Gaussian of 0.65 cells, and of three means over a cell and one over its parts.
        const double of_part = of_cell / path.source.parts;
        const double means = of_cell == 0 ? 1 : std::pow(sinc(of_cell) / sinc(of_part), 3) * sinc(of_part);
        before *= means * (path.window ? std::exp(-2 * std::pow(pi * 0.65 * of_cell, 2)) : 1);
      }
      worst = std::max(worst, std::abs(taps.transform(fx, fy) * before - wanted.transform(fx, fy).real()));
    }
  return worst;
}

TEST(PixelGather, GivesBackWhatThePathTookOff) {
  for (const Photosite& wanted : {plain, small, wide, round, filtered})
    for (const int parts : {2, 5})
      for (const bool window : {true, false})
        for (const int cells : {2, 3, 4, 8}) {
          const LightPath path{SourceFilter(parts), window};
          // Two cells hold a whole pixel's aperture, but not that of less.
          if (cells == 2 && !wanted.is_plain()) continue;
          EXPECT_LT(worst_to_nyquist(wanted, pixel_taps(wanted, cells, path), path), 0.01)
              << wanted.text() << ", " << cells << " cells of " << parts << " parts, window " << window;
        }
}

// Whatever the cells: pixels that fill the sensor take all light, each cell's in equal parts.
TEST(PixelGather, WeightsTakeAllLight) {
  for (const int cells : {1, 2, 3, 4, 7}) {
    const PixelTaps taps = pixel_taps(plain, cells, {SourceFilter(2), true});
    const auto size = static_cast<std::size_t>(taps.size()), step = static_cast<std::size_t>(cells);
    for (std::size_t phase = 0; phase < step; ++phase) {
      double of_phase = 0;
      for (std::size_t i = phase; i < size; i += step) of_phase += taps.terms[0].across[i];
      EXPECT_NEAR(of_phase, 1.0 / cells, 1e-9) << cells << ", " << phase;
    }
  }
  for (const Photosite& wanted : {small, wide, round, filtered})
    EXPECT_NEAR(pixel_taps(wanted, 3, {SourceFilter(2), true}).transform(0, 0), 1, 1e-9) << wanted.text();
}

TEST(PixelGather, PixelsAreWhereTheCellsAre) {
  // Light that rises linearly: the mean over any symmetric photosite is the value at the pixel's centre.
  const SensorGeometry sensor{5, 4, 6.0};
  for (const Photosite& wanted : {plain, small, round, filtered}) {
    const PixelTaps taps = pixel_taps(wanted, 4, {SourceFilter(2), true});
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
                    2 * sensor.x_mm(column + 0.5) + sensor.y_mm(row + 0.5),
                    1e-7);  // of 0.03, in floats, with weights of both signs
  }
}

TEST(PixelGather, OtherShapesAreRefused) {
  Photosite star;
  star.shape = Photosite::Shape::polygon;
  star.vertices = {{0, 0}, {1, 0}, {0, 1}};
  EXPECT_THROW(pixel_taps(star, 4, {SourceFilter(2), true}), InputError);
  EXPECT_THROW(pixel_taps(site(Photosite::Shape::rectangle, 1.5, 1), 4, {}), InputError);
}

}  // namespace
}  // namespace petzval
