// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/colour/band_light.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/spectra_files.h>
#include <petzval/scene/charts.h>
#include <petzval/scene/scene_file.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {
namespace {

ChartOptions sized(int columns, int rows, std::vector<double> wavelengths_nm = {550}) {
  ChartOptions options;
  options.columns = columns;
  options.rows = rows;
  options.wavelengths_nm = std::move(wavelengths_nm);
  return options;
}

/// Radiance relative to that of a perfect white, at a row and column.
double reflectance(const Scene& scene, int band, int row, int column) {
  const std::size_t at = static_cast<std::size_t>(row * scene.columns() + column);
  return scene.band(band)[at] /
         band_light(*scene.illuminant, scene.wavelengths_nm())[static_cast<std::size_t>(band)];
}

// Values are single precision products of a few factors.
constexpr double single_precision = 1e-6;

TEST(Checkerboard, HasThePapersSquares) {
  // 768 × 576 samples, 16 squares across: 48 samples a square, 12 squares down, corners of squares in the
  // middle.
  const Scene scene = checkerboard_chart(sized(768, 576), 16);
  for (int row = 0; row < 576; row += 7)
    for (int column = 0; column < 768; column += 5)
      EXPECT_NEAR(reflectance(scene, 0, row, column), (row / 48 + column / 48) % 2 == 0 ? 1 : 0,
                  single_precision)
          << row << " " << column;
}

TEST(Checkerboard, MixesByAreaWhereSquaresMeetWithinASample) {
  // 5 samples, 2 squares across: the middle column is half and half; 5 rows the same, and the middle sample
  // has two black and two white quarters.
  const Scene scene = checkerboard_chart(sized(5, 5), 2);
  EXPECT_NEAR(reflectance(scene, 0, 0, 2), 0.5, single_precision);
  EXPECT_NEAR(reflectance(scene, 0, 2, 0), 0.5, single_precision);
  EXPECT_NEAR(reflectance(scene, 0, 2, 2), 0.5, single_precision);
  EXPECT_NEAR(reflectance(scene, 0, 0, 0) + reflectance(scene, 0, 0, 4), 1, single_precision);
  // 3 squares on 4 samples of 3/4 square each: the second sample has 1/3 of the first square.
  const Scene thirds = checkerboard_chart(sized(4, 4), 3);
  EXPECT_NEAR(reflectance(thirds, 0, 0, 0), 1, single_precision);
  EXPECT_NEAR(reflectance(thirds, 0, 0, 1), 1.0 / 3, single_precision);
}

TEST(Checkerboard, RefusesSquaresFinerThanSamples) {
  for (const int squares : {0, -3, 9})
    EXPECT_THROW(checkerboard_chart(sized(8, 8), squares), InputError) << squares;
  EXPECT_NO_THROW(checkerboard_chart(sized(8, 8), 8));
}

TEST(ColorChecker, ShowsTheMeasuredReflectances) {
  ChartOptions options = sized(630, 430, {});
  const Scene scene = colorchecker_chart(options);
  ASSERT_EQ(scene.bands(), 31);
  const SpectrumSet patches = read_spectrum_set("colorchecker_reflectance");
  for (int patch = 0; patch < 24; ++patch) {
    // The board fills 96 % of the picture; patches lie on a grid of 6 × 4 in its middle.
    const int column = static_cast<int>(315 + 0.96 * 100 * (patch % 6 - 2.5));
    const int row = static_cast<int>(215 + 0.96 * 100 * (patch / 6 - 1.5));
    for (int band = 0; band < 31; ++band)
      EXPECT_NEAR(reflectance(scene, band, row, column),
                  patches.spectra[static_cast<std::size_t>(patch)].spectrum.at(400 + 10 * band),
                  single_precision)
          << patches.spectra[static_cast<std::size_t>(patch)].name;
  }
}

TEST(ColorChecker, RadianceFollowsTheIlluminant) {
  ChartOptions options = sized(63, 43, {450, 650});
  options.illuminant = "A";
  const Scene scene = colorchecker_chart(options);
  const Spectrum lamp = illuminant("A");
  EXPECT_NEAR(scene.illuminant->at(650) / scene.illuminant->at(450), lamp.at(650) / lamp.at(450), 1e-12);
}

TEST(Points, AreSingleSamples) {
  const Scene scene = point_chart(sized(90, 60), 3);
  int lit = 0;
  for (const float value : scene.band(0)) lit += value > 0;
  EXPECT_EQ(lit, 9);
  for (const int row : {10, 30, 50})
    for (const int column : {15, 45, 75})
      EXPECT_NEAR(reflectance(scene, 0, row, column), 1, single_precision);
  EXPECT_THROW(point_chart(sized(9, 6), 7), InputError);
  EXPECT_THROW(point_chart(sized(9, 6), 0), InputError);
}

TEST(Wall, IsTheSameEverywhere) {
  const Scene scene = wall_chart(sized(7, 5, {400, 550, 700}));
  for (int band = 0; band < 3; ++band)
    for (const float value : scene.band(band)) EXPECT_EQ(value, scene.band(band)[0]);
}

TEST(SlantedEdge, LeansByItsAngle) {
  // In every row, what is light adds up to the distance of the edge from the right border: column of the edge
  // = W/2 + (H/2 − row) · tan(angle).
  for (const double angle : {5.0, -5.0, 0.0, 30.0}) {
    const Scene scene = slanted_edge_chart(sized(100, 60), angle);
    for (int row = 0; row < 60; ++row) {
      double light = 0;
      for (int column = 0; column < 100; ++column) light += (reflectance(scene, 0, row, column) - 0.2) / 0.6;
      EXPECT_NEAR(100 - light, 50 + (30 - (row + 0.5)) * std::tan(radians(angle)), 100 * single_precision)
          << angle << " " << row;
    }
  }
  EXPECT_THROW(slanted_edge_chart(sized(9, 9), 46), InputError);
  EXPECT_THROW(slanted_edge_chart(sized(9, 9), std::nan("")), InputError);
}

TEST(Studio, HasItsPartsWhereTheyBelong) {
  const Scene scene = studio_chart(sized(800, 600));
  // One unit is 200 samples, the middle (400, 300). Black of the left slanted square, white around it, the
  // dark half of a star's sectors between its light half.
  EXPECT_NEAR(reflectance(scene, 0, 300, 400 - 324), 0.03, 0.001);
  EXPECT_NEAR(reflectance(scene, 0, 300 + 60, 400 - 324), 0.88, 0.02);
  double least = 1, greatest = 0;
  for (int i = 0; i < 40; ++i) {
    const double value = reflectance(scene, 0, 300 + 224 + 50, 400 + 324 - 20 + i);
    least = std::min(least, value), greatest = std::max(greatest, value);
  }
  EXPECT_LT(least, 0.05);
  EXPECT_GT(greatest, 0.8);
  // The line grid reaches every corner: a line each eighth of a unit, so in any 26 samples along a border.
  for (const int row : {0, 599})
    for (const int start : {0, 774}) {
      double brightest = 0;
      for (int column = start; column < start + 26; ++column)
        brightest = std::max(brightest, reflectance(scene, 0, row, column));
      EXPECT_GT(brightest, 0.5) << row << " " << start;
    }
}

TEST(Studio, IsMadeForEveryShape) {
  for (const auto& [columns, rows] : {std::pair(1, 1), {1, 500}, {500, 1}, {3, 2}, {300, 900}, {900, 300}}) {
    const Scene scene = studio_chart(sized(columns, rows));
    EXPECT_NO_THROW(scene.validate()) << columns << " x " << rows;
  }
}

class EveryChart : public ::testing::TestWithParam<const char*> {
 protected:
  static Scene make(int columns, int rows, std::vector<double> wavelengths_nm) {
    SceneOptions options;
    options.columns = columns;
    options.rows = rows;
    options.wavelengths_nm = std::move(wavelengths_nm);
    return read_scene(GetParam(), options);
  }
};

TEST_P(EveryChart, HasAHundredCandelas) {
  // Bands every 10 nm from 400 to 700 nm hold all but 3e-4 of luminance, and reflectances bend between them.
  EXPECT_NEAR(make(192, 144, {}).mean_luminance_cd_m2(), 100, 0.3);
}

TEST_P(EveryChart, HasTheSameLightInFewAndManyBands) {
  const auto light = [](const Scene& scene) {
    const std::vector<double> radiance = scene.mean_radiance();
    const std::vector<double> widths = band_widths_nm(scene.wavelengths_nm());
    return std::inner_product(radiance.begin(), radiance.end(), widths.begin(), 0.0);
  };
  const Scene all = make(96, 72, {}), few = make(96, 72, {400, 450, 500, 550, 600, 650, 700});
  EXPECT_NEAR(light(few) / light(all), 1, 5e-3) << "what reflectances do between the bands is not known";
  // A single band is 1 nm of the light; the light is shared out over 10 nm on both sides of it.
  EXPECT_NEAR(make(96, 72, {550}).mean_radiance()[0] / all.mean_radiance()[15], 1, 5e-3);
  EXPECT_EQ(make(96, 72, {587.5618}).bands(), 1);
}

TEST_P(EveryChart, HasTheSameRadianceAtTwiceTheResolution) {
  // Blocks of 2 × 2 samples against single ones. Edges are exact by area, so the mean of all differs by
  // rounding and by what is not made of edges: the background's texture (sampled at the middle of a sample;
  // ±0.1 % of the mean) and overlapping edges of strokes. Points are samples by definition: a point of half
  // the size is four times as bright.
  const Scene coarse = make(192, 144, {550}), fine = make(384, 288, {550});
  const double mean = coarse.mean_radiance()[0];
  EXPECT_NEAR(fine.mean_radiance()[0] / mean, 1, 2e-3);
  if (std::string(GetParam()).starts_with("points")) return;
  double difference = 0;
  for (int row = 0; row < 144; ++row)
    for (int column = 0; column < 192; ++column) {
      double sum = 0;
      for (int i = 0; i < 4; ++i)
        sum += fine.band(0)[static_cast<std::size_t>((2 * row + i / 2) * 384 + 2 * column + i % 2)];
      difference += std::abs(sum / 4 - coarse.band(0)[static_cast<std::size_t>(row * 192 + column)]);
    }
  EXPECT_LT(difference / (192 * 144 * mean), 0.01);
}

TEST_P(EveryChart, IsTheSameForAnyNumberOfThreads) {
  const auto values = [&](int threads) {
    const ThreadLimit limit(threads);
    const Scene scene = make(160, 120, {450, 550, 650});
    return std::vector<float>(scene.values().begin(), scene.values().end());
  };
  EXPECT_EQ(values(1), values(2));
}

/// 16 squares on 320 samples: lines two samples wide every 20, the middle ones about the middle of the
/// picture.
TEST(Grid, HasLinesThroughTheMiddleAndAlongTheEdges) {
  const Scene scene = grid_chart(sized(320, 240), 16);
  for (int row = 0; row < 240; row += 3)
    for (int column = 0; column < 320; column += 3) {
      const auto on_line = [](int sample) { return sample % 20 == 0 || sample % 20 == 19; };
      EXPECT_NEAR(reflectance(scene, 0, row, column), on_line(row) || on_line(column) ? 0 : 1,
                  single_precision)
          << row << " " << column;
    }
  // An odd number: the middle of the picture is the middle of a square.
  EXPECT_NEAR(reflectance(grid_chart(sized(300, 300), 3), 0, 150, 150), 1, single_precision);
  EXPECT_THROW(grid_chart(sized(8, 8), 9), InputError);
}

TEST_P(EveryChart, IsSoundAndHasItsLight) {
  const Scene scene = make(64, 48, {400, 587.5618, 700});
  EXPECT_NO_THROW(scene.validate());
  ASSERT_TRUE(scene.illuminant.has_value());
  for (int band = 0; band < 3; ++band)
    for (const float value : scene.band(band))
      EXPECT_LE(value,
                scene.illuminant->at(scene.wavelengths_nm()[static_cast<std::size_t>(band)]) * 1.000001)
          << "nothing reflects more than it gets";
}

INSTANTIATE_TEST_SUITE_P(Builtin, EveryChart,
                         ::testing::Values("checkerboard", "checkerboard:7", "colorchecker", "grid:5",
                                           "points:4", "slanted-edge:5", "studio", "wall"));

TEST(ChartOptions, NonsenseIsRefused) {
  ChartOptions options = sized(4, 4);
  options.illuminant = "moonshine";
  EXPECT_THROW(wall_chart(options), InputError);
  options = sized(4, 4, {2000});
  EXPECT_THROW(wall_chart(options), InputError) << "D65 has no light there";
  for (const double luminance : {0.0, -1.0, std::nan("")}) {
    options = sized(4, 4);
    options.mean_luminance_cd_m2 = luminance;
    EXPECT_THROW(wall_chart(options), InputError);
  }
  EXPECT_THROW(wall_chart(sized(2000000000, 2000000000)), InputError);
}

}  // namespace
}  // namespace petzval
