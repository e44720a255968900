// SPDX-License-Identifier: BSD-3-Clause
// A star of one scene sample sends the same light to the sensor wherever it falls on the pixels.
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/imaging/image_formation.h>

#include <cmath>
#include <tuple>

namespace petzval {
namespace {

using namespace testing;

constexpr double focal_mm = 6, stars_g_sr = 0.25;

/// x' = f tan: no distortion, so that a sample's image has the same size everywhere.
LensDataTable rectilinear_table(double sigma_um) {
  TableRecipe recipe;
  recipe.fields.clear();
  for (int field = 0; field <= 24; ++field) recipe.fields.push_back(field);
  recipe.height_mm = [](double field, double) { return focal_mm * std::tan(radians(field)); };
  recipe.g_source_sr = [](double) { return stars_g_sr; };
  recipe.psf = [=](double, double) {
    return psf_of_spots({{0, 0, sigma_um, sigma_um, 1}}, 161, sigma_um / 10);
  };
  return make_table(recipe);
}

struct Stars {
  double samples_per_pixel, sigma_um;
  int cells;  ///< 0: chosen
};

class StarFlux : public ::testing::TestWithParam<Stars> {};

// 49 stars at irrational distances: flux and place of each, by the law of similar triangles.
TEST_P(StarFlux, IsThatOfItsSampleWhereverItFalls) {
  const double samples_per_pixel = GetParam().samples_per_pixel, sigma_um = GetParam().sigma_um;
  const int cells = GetParam().cells;
  const LensDataTable table = rectilinear_table(sigma_um);
  constexpr int pixels = 160;
  constexpr double pitch_um = 10;
  const double sample_mm = pitch_um * mm_per_um / samples_per_pixel;
  const int samples = static_cast<int>(2.2 * pixels * samples_per_pixel);
  Scene scene(samples, samples, {550}, degrees(2 * std::atan(samples * sample_mm / 2 / focal_mm)),
              std::nullopt);
  struct Star {
    int column, row;
  };
  std::vector<Star> stars;
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j) {
      const auto at = [&](double pixels_from_middle) {
        return static_cast<int>(std::lround(samples / 2.0 + pixels_from_middle * samples_per_pixel));
      };
      stars.push_back({at(20.37 * j + 1.13 * i), at(20.71 * i - 0.77 * j)});
      scene.band(0)[static_cast<std::size_t>(stars.back().row * samples + stars.back().column)] = 3;
    }
  ImagingOptions options;
  options.supersample = cells;
  const SensorGeometry sensor{pixels, pixels, pitch_um};
  const SpectralImage image = form_image(scene, table, sensor, options);
  // Flux over pitch².
  const double wanted = stars_g_sr * 3 / (samples_per_pixel * samples_per_pixel);
  for (const Star& star : stars) {
    const double column = (star.column + 0.5 - samples / 2.0) / samples_per_pixel + pixels / 2.0,
                 row = (star.row + 0.5 - samples / 2.0) / samples_per_pixel + pixels / 2.0;
    double sum = 0, across = 0, down = 0;
    for (int i = static_cast<int>(row) - 9; i <= static_cast<int>(row) + 9; ++i)
      for (int j = static_cast<int>(column) - 9; j <= static_cast<int>(column) + 9; ++j) {
        const double light = double(image.at(0, i, j));
        ASSERT_GE(light, 0);
        sum += light;
        across += light * (j + 0.5);
        down += light * (i + 0.5);
      }
    EXPECT_NEAR(sum / wanted, 1, 1e-3);
    EXPECT_NEAR(across / sum, column, 0.01);
    EXPECT_NEAR(down / sum, row, 0.01);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, StarFlux,
                         ::testing::Values(Stars{0.67, 4, 0}, Stars{0.47, 4, 0}, Stars{0.17, 4, 0},
                                           Stars{1, 4, 2}, Stars{2.3, 8, 0}, Stars{0.67, 2, 3}),
                         [](const auto& info) { return "number" + std::to_string(info.index); });

}  // namespace
}  // namespace petzval
