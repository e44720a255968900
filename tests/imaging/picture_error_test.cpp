// SPDX-License-Identifier: BSD-3-Clause
// The error of pictures against light that falls on pixels by the scene as it is between its samples: a sum
// over PSFs in closed form, which knows neither cells nor kernels.
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/imaging/image_formation.h>

#include <cmath>
#include <numbers>
#include <random>

namespace petzval {
namespace {

using namespace testing;

constexpr double coma_focal_mm = 6, g_source_sr = 0.25, pixel_um = 6;
constexpr int pixels = 48;

/// A comatic PSF of three round spots that grows with height: positions and widths are cubics of it, which a
/// table's interpolation follows.
std::vector<Spot> coma_spots(double height_mm, double scale) {
  const double t = height_mm / 0.2;
  return {{0, 0, scale, scale, 0.5},
          {0, 1.5 * t * scale, 1.5 * scale, 1.5 * scale, 0.3},
          {0, 3 * t * scale, 2 * scale, 2 * scale, 0.2}};
}

double height_of(double field_deg) {
  return coma_focal_mm * std::tan(radians(field_deg));
}

LensDataTable coma_table(double scale) {
  TableRecipe recipe;
  recipe.fields.clear();
  for (int i = 0; i <= 40; ++i) recipe.fields.push_back(0.1 * i);
  recipe.height_mm = [](double field, double) { return height_of(field); };
  recipe.g_source_sr = [](double) { return g_source_sr; };
  recipe.psf = [=](double field, double) {
    std::vector<Spot> spots = coma_spots(height_of(field), scale);
    // psf_of_spots() weighs peaks by 1/σ², as densities.
    return psf_of_spots(spots, 181, 0.15 * scale);
  };
  return make_table(recipe);
}

/// The light of a Gaussian that a pixel takes along an axis.
double within(double from, double to, double sigma) {
  const auto below = [&](double x) { return std::erf(x / (sigma * std::numbers::sqrt2)) / 2; };
  return below(to) - below(from);
}

/// Scenes of samples a given part of a pixel wide: parts of a sample are points with the bilinear light of
/// their middles.
std::vector<double> summed(const Scene& scene, double sample_um, double scale) {
  // No wider than a seventh of the narrowest spot.
  const int parts = std::max(6, 2 * static_cast<int>(std::ceil(sample_um / 0.6)));
  std::vector<double> light(static_cast<std::size_t>(pixels) * pixels);
  const double middle = pixels * pixel_um / 2, edge_um = scene.columns() * sample_um / 2;
  const double part_um = sample_um / parts;
  const auto sample = [&](int row, int column) {
    return double(
        scene.band(0)[static_cast<std::size_t>(std::clamp(row, 0, scene.rows() - 1) * scene.columns() +
                                               std::clamp(column, 0, scene.columns() - 1))]);
  };
  for (int i = 0; i < scene.rows() * parts; ++i)
    for (int j = 0; j < scene.columns() * parts; ++j) {
      // From the middle, right and down.
      const double right = (j + 0.5) * part_um - edge_um, down = (i + 0.5) * part_um - edge_um;
      const double u = (j + 0.5) / parts - 0.5, v = (i + 0.5) / parts - 0.5;
      const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(std::floor(v));
      const double radiance =
          std::lerp(std::lerp(sample(row, column), sample(row, column + 1), u - column),
                    std::lerp(sample(row + 1, column), sample(row + 1, column + 1), u - column), v - row);
      const double flux = g_source_sr * radiance * part_um * part_um / (pixel_um * pixel_um);
      const double height_um = std::hypot(right, down);
      const double out_right = height_um > 0 ? right / height_um : 0,
                   out_down = height_um > 0 ? down / height_um : 1;
      for (const Spot& spot : coma_spots(height_um * mm_per_um, scale)) {
        const double x = middle + right + spot.t_um * out_right, y = middle + down + spot.t_um * out_down;
        const double reach_um = 6 * spot.sigma_s_um;
        const auto pixel = [](double um) { return static_cast<int>(std::floor(um / pixel_um)); };
        for (int r = std::max(0, pixel(y - reach_um)); r <= std::min(pixels - 1, pixel(y + reach_um)); ++r)
          for (int c = std::max(0, pixel(x - reach_um)); c <= std::min(pixels - 1, pixel(x + reach_um)); ++c)
            light[static_cast<std::size_t>(r * pixels + c)] +=
                flux * spot.weight * within(c * pixel_um - x, (c + 1) * pixel_um - x, spot.sigma_s_um) *
                within(r * pixel_um - y, (r + 1) * pixel_um - y, spot.sigma_s_um);
      }
    }
  return light;
}

struct Case {
  double sample_um, scale, tolerance;
  int most_cells = ImagingOptions::most_cells;  ///< a pixel: what the picture may cost
};

class PictureError : public ::testing::TestWithParam<Case> {};

// A checkerboard of random squares, tilted by its samples' own steps, finer than pixels and coarser.
TEST_P(PictureError, IsWithinTheTolerance) {
  const auto [sample_um, scale, tolerance, most_cells] = GetParam();
  const int samples = static_cast<int>(std::ceil((pixels + 40) * pixel_um / sample_um));
  Scene scene(samples, samples, {550},
              degrees(2 * std::atan(samples * sample_um * mm_per_um / 2 / coma_focal_mm)), std::nullopt);
  std::mt19937 random(1843);
  std::uniform_real_distribution<float> bright(0, 1);
  for (int row = 0; row < samples; ++row)
    for (int column = 0; column < samples; ++column) {
      const double x = (column + 0.1 * row) * sample_um / 25, y = (row - 0.1 * column) * sample_um / 25;
      const bool white = (static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(y))) % 2 == 0;
      scene.band(0)[static_cast<std::size_t>(row * samples + column)] =
          white ? 1.0F : 0.05F + 0.1F * bright(random);
    }
  ImagingOptions options;
  options.product.tolerance = tolerance;
  ImagingReport report;
  const SpectralImage image =
      form_image(scene, coma_table(scale), {pixels, pixels, pixel_um}, options, {}, &report);
  const std::vector<double> wanted = summed(scene, sample_um, scale);
  double error = 0, light = 0;
  for (int row = 0; row < pixels; ++row)
    for (int column = 0; column < pixels; ++column) {
      const double truth = wanted[static_cast<std::size_t>(row * pixels + column)];
      error += std::pow(double(image.at(0, row, column)) - truth, 2);
      light += truth * truth;
    }
  std::printf("tolerance %g: %d cells, estimated %.1e, error %.1e\n", tolerance, report.cells_per_pixel,
              report.estimated_error(), std::sqrt(error / light));
  EXPECT_LE(std::sqrt(error / light), tolerance);
  EXPECT_LE(report.cells_per_pixel, most_cells);
}

// The last ones are previews of what a photograph holds: for these one cell a pixel has to do.
INSTANTIATE_TEST_SUITE_P(Scenes, PictureError,
                         ::testing::Values(Case{2, 1.5, 1e-2}, Case{2, 1.5, 1e-3}, Case{3.3, 1.5, 1e-3},
                                           Case{9, 1.5, 1e-3}, Case{2, 3, 1e-3}, Case{2, 0.8, 1e-3},
                                           Case{9, 1.5, 1e-2, 1}, Case{5, 0.8, 1e-2, 1}),
                         [](const auto& info) { return "number" + std::to_string(info.index); });

// Stars in darkness, through PSFs of two spots that move apart slowly over the frame: noise as strong as its
// mean would not show that. Against PSFs of every cell's own, on the same cells.
TEST(PictureOfLights, InDarknessIsWithinTheTolerance) {
  TableRecipe recipe;
  recipe.fields.clear();
  for (int i = 0; i <= 40; ++i) recipe.fields.push_back(0.1 * i);
  recipe.height_mm = [](double field, double) { return height_of(field); };
  recipe.g_source_sr = [](double) { return g_source_sr; };
  recipe.psf = [](double field, double) {
    const double apart_um = 6 * pixel_um * height_of(field) / height_of(4);
    return psf_of_spots({{0, 0, pixel_um, pixel_um, 0.5}, {0, apart_um, pixel_um, pixel_um, 0.5}}, 101,
                        pixel_um / 5);
  };
  const LensDataTable table = make_table(recipe);
  constexpr int side = 32, samples = 84;
  Scene scene(samples, samples, {550}, degrees(2 * std::atan(samples * 5e-3 / 2 / coma_focal_mm)),
              std::nullopt);
  for (int row = 4; row < samples; row += 9)
    for (int column = 3; column < samples; column += 7)
      scene.band(0)[static_cast<std::size_t>(samples * row + column)] = 1;
  ImagingOptions options;
  options.supersample = 5;
  const SensorGeometry sensor{side, side, pixel_um};
  const SpectralImage product = form_image(scene, table, sensor, options);
  options.method = BlurMethod::exact;
  const SpectralImage exact = form_image(scene, table, sensor, options);
  double error = 0, light = 0;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      error += std::pow(double(product.at(0, row, column)) - double(exact.at(0, row, column)), 2);
      light += std::pow(double(exact.at(0, row, column)), 2);
    }
  std::printf("error %.1e\n", std::sqrt(error / light));
  EXPECT_LE(std::sqrt(error / light), options.product.tolerance);
}

}  // namespace
}  // namespace petzval
