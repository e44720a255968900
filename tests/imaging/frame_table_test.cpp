// SPDX-License-Identifier: BSD-3-Clause
// Tables over the frame in two dimensions, made by formula: PSFs without any symmetry, whose direction and
// size vary freely, and a field off its place; against sums written out here and the method of one PSF a
// cell.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/imaging/exact_blur.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/product_blur.h>
#include <petzval/imaging/scene_rows.h>
#include <petzval/imaging/smooth_psf.h>

#include <cmath>

#include "synthetic_table.h"

namespace petzval {
namespace {

using namespace testing;

constexpr double focal_mm = 6, g_middle_sr = 0.25;
/// The axis of the lens stands here on the sensor.
constexpr double axis_x_mm = 0.11, axis_y_mm = -0.07;

/// Three Gaussians that a place is imaged to: a head and a tail, whose direction turns across the frame and
/// whose length depends on both coordinates. Along x' and y' [µm].
std::vector<Spot> spots_at(double x_mm, double y_mm) {
  const double turn = 0.7 + 1.1 * x_mm - 0.6 * y_mm + 0.5 * x_mm * y_mm;
  const double tail_um = 7 + 4 * x_mm + 3 * y_mm * y_mm, width_um = 2.6 + 0.8 * y_mm - 0.5 * x_mm;
  const double s = tail_um * std::cos(turn), t = tail_um * std::sin(turn);
  return {{0, 0, width_um, width_um, 1},
          {s / 2, t / 2, 1.4 * width_um, 1.4 * width_um, 0.8},
          {s, t, 1.8 * width_um, 1.8 * width_um, 0.5}};
}

double g_at(double x_mm, double y_mm) {
  return g_middle_sr * (1 - 0.1 * x_mm + 0.05 * y_mm - 0.08 * (x_mm * x_mm + y_mm * y_mm));
}

std::vector<double> even_axis(double half, int count) {
  std::vector<double> axis;
  for (int i = 0; i < count; ++i) axis.push_back(half * (2.0 * i / (count - 1) - 1));
  return axis;
}

/// \param turned  PSFs stored in axes that are turned by another angle at each place.
LensDataTable frame_table(int across = 11, int down = 9, bool turned = false) {
  LensDataTable table;
  table.lens_name = "made by formula, over the frame";
  table.wavelengths_nm = {550};
  table.vertex_to_sensor_mm = 10;
  FramePlaces& frame = table.frame.emplace();
  frame.x_mm = even_axis(0.8, across);
  frame.y_mm = even_axis(0.6, down);
  for (const double y : frame.y_mm)
    for (const double x : frame.x_mm) {
      const double right = x - axis_x_mm, up = y - axis_y_mm, away = std::hypot(right, up);
      const double field = away > 0 ? degrees(std::atan(away / focal_mm)) / away : degrees(1 / focal_mm);
      frame.object_x.push_back(field * right);
      frame.object_y.push_back(field * up);
      const double azimuth = turned ? 40 * x - 75 * y + 10 : 0;
      frame.psf_azimuth_deg.push_back(azimuth);
      std::vector<Spot> spots = spots_at(x, y);
      const double c = std::cos(radians(azimuth)), n = std::sin(radians(azimuth));
      for (Spot& spot : spots) {
        const double s = spot.s_um, t = spot.t_um;
        spot.s_um = c * s + n * t;
        spot.t_um = c * t - n * s;
      }
      table.g_source_sr.push_back(g_at(x, y));
      table.g_sensor_sr.push_back(g_at(x, y));
      table.psf.push_back(psf_of_spots(spots, 129, 0.6));
    }
  table.validate();
  return table;
}

/// The kernel of a place by its formula: the Gaussians seen through the window at the middles of cells.
Kernel formula_kernel(double x_mm, double y_mm, double cell_um, int radius) {
  Kernel kernel(radius);
  const double window = window_cells * cell_um;
  for (const Spot& spot : spots_at(x_mm, y_mm)) {
    const double variance = spot.sigma_s_um * spot.sigma_s_um + window * window;
    for (int row = -radius; row <= radius; ++row)
      for (int column = -radius; column <= radius; ++column) {
        const double x = -column * cell_um - spot.s_um, y = row * cell_um - spot.t_um;
        kernel.at(row, column) += spot.weight / variance * std::exp(-(x * x + y * y) / (2 * variance));
      }
  }
  const double sum = kernel.sum();
  for (double& weight : kernel.weights) weight /= sum;
  return kernel;
}

double relative_difference(const Kernel& a, const Kernel& b) {
  double difference = 0, total = 0;
  for (std::size_t i = 0; i < b.weights.size(); ++i) {
    difference += std::pow(a.weights[i] - b.weights[i], 2);
    total += std::pow(b.weights[i], 2);
  }
  return std::sqrt(difference / total);
}

constexpr double cell_um = 10;

TEST(FrameTable, KernelsAreTheFormulasAtAndBetweenPlaces) {
  for (const bool turned : {false, true}) {
    const LensDataTable table = frame_table(11, 9, turned);
    const PsfField psfs(table, 550, cell_um);
    EXPECT_EQ(psfs.symmetry(), KernelSymmetry::none);
    // At places the window's spline (5e-5) and what refinement does to samples count; between them a cubic
    // mixture of PSFs that turn by 0.18 rad from place to place: (0.18)^3 / 10 of what is not in their
    // moments.
    for (const double x : {-0.48, 0.0, 0.32})
      for (const double y : {-0.45, 0.15})
        EXPECT_LT(relative_difference(psfs.kernel_at(x, y), formula_kernel(x, y, cell_um, psfs.radius())),
                  1e-3)
            << x << " " << y << " " << turned;
    for (const double x : {-0.56, -0.03, 0.41})
      for (const double y : {-0.38, 0.02, 0.5})
        EXPECT_LT(relative_difference(psfs.kernel_at(x, y), formula_kernel(x, y, cell_um, psfs.radius())),
                  3e-3)
            << x << " " << y << " " << turned;
  }
}

/// The result of blurring every cell by a kernel, cells of light only.
template <typename KernelAt>
CellPlane summed(const CellPlane& source, int margin, int radius, const KernelAt& kernel_at) {
  CellPlane result(grown(source.grid, -margin));
  for (int row = 0; row < source.grid.rows; ++row)
    for (int column = 0; column < source.grid.columns; ++column) {
      const float light = source.row(static_cast<std::size_t>(row))[column];
      if (light == 0) continue;
      const Kernel kernel = kernel_at(source.grid.x_mm(column + 0.5), source.grid.y_mm(row + 0.5));
      for (int i = -radius; i <= radius; ++i)
        for (int j = -radius; j <= radius; ++j) {
          const int r = row + i - margin, c = column + j - margin;
          if (r < 0 || c < 0 || r >= result.grid.rows || c >= result.grid.columns) continue;
          result.row(static_cast<std::size_t>(r))[c] += static_cast<float>(double(light) * kernel.at(i, j));
        }
    }
  return result;
}

TEST(FrameTable, ExactIsTheStraightSumOverPsfs) {
  const LensDataTable table = frame_table();
  const PsfField psfs(table, 550, cell_um);
  const CellPlane source = random_plane({60, 44, cell_um});
  const CellPlane straight = summed(source, 4, psfs.radius(), [&](double x, double y) {
    return formula_kernel(x, y, cell_um, psfs.radius());
  });
  // What kernels may be off, 3e-3 of each at most.
  EXPECT_LT(relative_l2(blur_exact(source, psfs, 4), straight), 2e-3);
}

TEST(FrameTable, ProductAndSectionsKeepTheTolerance) {
  const LensDataTable table = frame_table();
  const PsfField psfs(table, 550, cell_um, PsfInterpolation::psf, LightCentres(table));
  for (const SensorGeometry& grid : {SensorGeometry{101, 74, cell_um}, SensorGeometry{100, 73, cell_um}}) {
    const int margin = psfs.radius();
    for (const bool checked : {false, true}) {
      const CellPlane source = checked ? tilted_checkerboard(grid) : texture(grid);
      const CellPlane exact = blur_exact(source, psfs, margin);
      for (const double tolerance : {1e-2, 1e-3, 1e-4})
        for (const bool direct : {false, true}) {
          ProductOptions options;
          options.tolerance = tolerance;
          options.direct = direct;
          const auto plan = plan_product(psfs, {grid, margin}, options);
          ASSERT_TRUE(plan) << tolerance << " " << direct;
          EXPECT_LT(relative_l2(ProductBlur(psfs, grid, *plan).blur(source, margin), exact), tolerance)
              << grid.columns << " " << direct << " " << checked;
        }
      // One cell a section: every cell its own kernel.
      EXPECT_LT(relative_l2(blur_sections(source, psfs, margin, {1, 0, false}), exact), 1e-5);
    }
  }
}

TEST(FrameTable, EnergyStays) {
  const LensDataTable table = frame_table();
  const PsfField psfs(table, 550, cell_um);
  const int margin = psfs.radius();
  CellPlane source({120, 90, cell_um});
  for (int row = margin; row < 90 - margin; ++row)
    for (int column = margin; column < 120 - margin; ++column)
      source.row(static_cast<std::size_t>(row))[column] = static_cast<float>((row * 7 + column * 3) % 11);
  const auto plan = plan_product(psfs, {source.grid, 0}, {1e-3});
  EXPECT_NEAR(sum_of(ProductBlur(psfs, source.grid, *plan).blur(source, 0)) / sum_of(source), 1, 1e-6);
}

TEST(FrameTable, SeesWhereTheFieldLies) {
  const LensDataTable table = frame_table();
  Scene scene(400, 300, {550}, 18, std::nullopt);
  const SceneMap map(table, {}, {}, 550, scene, 1);
  const double samples_per_mm = 1 / (focal_mm * scene.tangent_per_sample());
  for (const double x : {-0.7, -0.23, 0.0, 0.5})
    for (const double y : {-0.55, 0.1, 0.44}) {
      const SceneMap::Place place = map.place(x, y);
      // Fields are atan: their sixth derivative times h^4 leaves 1e-6 of a sample.
      EXPECT_NEAR(place.column, 200 - (x - axis_x_mm) * samples_per_mm, 1e-4);
      EXPECT_NEAR(place.row, 150 + (y - axis_y_mm) * samples_per_mm, 1e-4);
      EXPECT_NEAR(place.g_source_sr, g_at(x, y), 1e-9);
    }
}

TEST(FrameTable, RowsOfCellsAreTheirPlaces) {
  const LensDataTable table = frame_table();
  // Cells that see half a sample, several at a time, and two samples, in parts.
  for (const int columns : {100, 400}) {
    const int rows = columns * 3 / 4;
    Scene scene(columns, rows, {550}, 18, std::nullopt);
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column)
        scene.band(0)[static_cast<std::size_t>(row * columns + column)] =
            static_cast<float>(1 + 0.01 * column + 0.02 * row);
    const SensorGeometry grid{150, 110, cell_um};
    const SceneMap map(table, {}, {}, 550, scene, 1);
    const CellPlane plane = ideal_irradiance(scene, 0, map, grid, 4, Surround::error);
    for (int row = 0; row < grid.rows; row += 13)
      for (int column = 0; column < grid.columns; column += 17) {
        const SceneMap::Place at = map.place(grid.x_mm(column + 0.5), grid.y_mm(row + 0.5));
        // Of a slope the mean over a rectangle is the value in its middle; g_source changes by a thousandth
        // of itself across a cell, radiance by 4 %: a twelfth of the product of both.
        const double radiance = 1 + 0.01 * (at.column - 0.5) + 0.02 * (at.row - 0.5);
        EXPECT_NEAR(double(plane.row(static_cast<std::size_t>(row))[column]) / (at.g_source_sr * radiance), 1,
                    4e-6);
      }
  }
}

/// The whole way, for a star: its flux, and where its light has its centre.
TEST(FormImageOverFrame, AStarLandsWhereTheFormulaHasIt) {
  const LensDataTable table = frame_table();
  const SensorGeometry sensor{120, 90, 10};
  for (const auto& [x, y] : {std::pair{-0.3, 0.2}, std::pair{0.25, -0.22}, std::pair{0.05, 0.3}}) {
    Scene scene(600, 450, {550}, 18, std::nullopt);
    const double samples_per_mm = 1 / (focal_mm * scene.tangent_per_sample());
    const int column = static_cast<int>(std::lround(300 - (x - axis_x_mm) * samples_per_mm - 0.5)),
              row = static_cast<int>(std::lround(225 + (y - axis_y_mm) * samples_per_mm - 0.5));
    add_star(scene, 0, column, row, 2);
    const double flux = 2 * pi * 4 / (samples_per_mm * samples_per_mm);  // of the star, per g
    const double there_x = axis_x_mm - (column + 0.5 - 300) / samples_per_mm,
                 there_y = axis_y_mm + (row + 0.5 - 225) / samples_per_mm;
    double s = 0, t = 0, light = 0;
    for (const Spot& spot : spots_at(there_x, there_y)) {
      s += spot.weight * spot.s_um;
      t += spot.weight * spot.t_um;
      light += spot.weight;
    }
    const SpectralImage image = form_image(scene, table, sensor, {});
    double sum = 0, centre_x = 0, centre_y = 0;
    for (int i = 0; i < sensor.rows; ++i)
      for (int j = 0; j < sensor.columns; ++j) {
        const double value = image.at(0, i, j);
        sum += value;
        centre_x += value * sensor.x_mm(j + 0.5);
        centre_y += value * sensor.y_mm(i + 0.5);
      }
    // A tenth of a micrometre is a hundredth of a pixel; a star of 12 um is lit by the g of its surroundings.
    EXPECT_NEAR(centre_x / sum, there_x + s / light * 1e-3, 1e-4);
    EXPECT_NEAR(centre_y / sum, there_y + t / light * 1e-3, 1e-4);
    EXPECT_NEAR(sum * 1e-4 / (flux * g_at(there_x, there_y)), 1, 1e-3);
  }
}

TEST(FormImageOverFrame, SameBytesForAnyNumberOfThreads) {
  const LensDataTable table = frame_table();
  Scene scene(200, 150, {550}, 18, std::nullopt);
  for (std::size_t i = 0; i < scene.band_size(); ++i) scene.band(0)[i] = static_cast<float>(i * 37 % 101);
  const auto bytes = [&](int threads) {
    const ThreadLimit limit(threads);
    const SpectralImage image = form_image(scene, table, {120, 90, 10}, {});
    return std::vector<float>(image.values().begin(), image.values().end());
  };
  EXPECT_EQ(bytes(1), bytes(2));
}

TEST(FormImageOverFrame, RefusesWhatBelongsToHeights) {
  const LensDataTable table = frame_table();
  Scene scene(40, 30, {550}, 18, std::nullopt);
  ImagingOptions options;
  options.interpolation = PsfInterpolation::otf;
  EXPECT_THROW(form_image(scene, table, {20, 15, 20}, options), InputError);
  options = {};
  options.fit.polynomial_order = 4;
  EXPECT_THROW(form_image(scene, table, {20, 15, 20}, options), InputError);
}

}  // namespace
}  // namespace petzval
