// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/psf_tails.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace petzval {
namespace {

using namespace testing;

/// A sharp spot and a halo: of a share that is the same everywhere, or grows from nothing on the axis.
LensDataTable halo_table(bool grows, const std::vector<double>& wavelengths_nm = {550}, double share = 0.3) {
  TableRecipe recipe;
  recipe.wavelengths_nm = wavelengths_nm;
  recipe.g_source_sr = [](double field) { return 0.25 - 0.005 * field; };
  recipe.psf = [grows, share](double field, double nm) {
    const double halo = grows ? field / 40 : share, wide_um = 200 + 0.2 * (nm - 550);
    return psf_of_spots(
        {{0, 0, 15, 15, 15 * 15 * (1 - halo) / 225}, {0, grows ? 2 * field : 0, wide_um, wide_um, halo}}, 201,
        8);
  };
  return make_table(recipe);
}

Scene noise_scene(const std::vector<double>& wavelengths_nm) {
  Scene scene(64, 48, wavelengths_nm, 4, {});
  std::mt19937 random(3);
  std::uniform_real_distribution<float> light(0, 1);
  for (int band = 0; band < scene.bands(); ++band) {
    for (float& value : scene.band(band)) value = light(random);
    add_star(scene, band, 20, 12, 1.5);
  }
  return scene;
}

const SensorGeometry sensor{33, 25, 10};

ImagingOptions from_pixels(int tail_pixels, double tolerance = 1e-3) {
  ImagingOptions options;
  options.tail_pixels = tail_pixels;
  options.product.tolerance = tolerance;
  options.surround = Surround::extend;
  options.supersample = 2;
  return options;
}

double difference(const SpectralImage& a, const SpectralImage& b, int band) {
  double square = 0, of = 0;
  for (std::size_t i = 0; i < a.band(band).size(); ++i) {
    square += std::pow(double(a.band(band)[i]) - double(b.band(band)[i]), 2);
    of += std::pow(double(b.band(band)[i]), 2);
  }
  return std::sqrt(square / of);
}

TEST(SplitTails, PartsAddUp) {
  const LensDataTable table = halo_table(true);
  const std::optional<TailSplit> split = split_tails(table, 160);
  ASSERT_TRUE(split);
  for (std::size_t entry = 0; entry < table.psf.size(); ++entry) {
    const double sharp = split->sharp.g_source_sr[entry], tail = split->tails.g_source_sr[entry];
    EXPECT_NEAR(sharp + tail, table.g_source_sr[entry], 1e-15);
    const Psf& whole = table.psf[entry];
    const double peak = double(whole.at(100, 100)) * table.g_source_sr[entry];
    for (std::size_t i = 0; i < whole.values.size(); ++i)
      EXPECT_NEAR(sharp * double(split->sharp.psf[entry].values[i]) +
                      tail * double(split->tails.psf[entry].values[i]),
                  table.g_source_sr[entry] * double(whole.values[i]), 1e-6 * peak);
    for (const LensDataTable* part : {&split->sharp, &split->tails}) EXPECT_NO_THROW(part->validate());
    for (const Psf* part : {&split->sharp.psf[entry], &split->tails.psf[entry]})
      EXPECT_NEAR(std::accumulate(part->values.begin(), part->values.end(), 0.0), 1, 1e-5);
  }
  // The halo alone reaches so far: a window of 160 µm leaves most of its light outside.
  EXPECT_GT(split->tails.g_source_sr.back(), 0.25 * table.g_source_sr.back());
  EXPECT_LT(split->tails.g_source_sr.back(), 0.5 * table.g_source_sr.back());
}

// Where the window ends upon a sample, rounding must not make its light less than none.
TEST(SplitTails, AreSoundWhereTheWindowEndsOnASample) {
  const LensDataTable table = halo_table(true);
  for (int step = 0; step < 200; ++step) {
    const std::optional<TailSplit> split = split_tails(table, 8 * std::hypot(13, 20) * (1 + 1e-6 * step));
    ASSERT_TRUE(split);
    ASSERT_NO_THROW(split->sharp.validate()) << step;
    ASSERT_NO_THROW(split->tails.validate()) << step;
  }
}

TEST(SplitTails, AreAsStrongAsTheirShareOfTheLight) {
  for (const double share : {0.3, 0.02}) {
    const std::optional<TailSplit> split = split_tails(halo_table(false, {550}, share), 160);
    ASSERT_TRUE(split);
    const double tail = split->tails.g_source_sr[0];
    EXPECT_NEAR(tail_strength(*split), tail / (tail + split->sharp.g_source_sr[0]), 1e-9);
    EXPECT_LT(tail_strength(*split), share);
    EXPECT_GT(tail_strength(*split), 0.5 * share);
  }
}

TEST(SplitTails, LeaveNarrowTablesAlone) {
  EXPECT_FALSE(split_tails(halo_table(true), 600));
}

TEST(AddCoarse, FollowsParabolasAndKeepsTheLight) {
  const SensorGeometry frame{40, 24, 2};
  const int times = 4;
  const SensorGeometry coarse = coarse_frame(frame, times);
  ASSERT_EQ(coarse.columns, 10);
  const auto light = [](double x, double y) { return 100 + x + 0.1 * x * x - 0.2 * y * y + 0.3 * y; };
  // Means over squares: of x², a twelfth of the side squared is more than in the middle.
  const auto mean = [&](double x, double y, double side) {
    return light(x, y) + (0.1 - 0.2) * side * side / 12;
  };
  std::vector<float> far, near(static_cast<std::size_t>(frame.columns) * 24, 1.0F);
  for (int i = 0; i < coarse.rows; ++i)
    for (int j = 0; j < coarse.columns; ++j)
      far.push_back(static_cast<float>(mean((j + 0.5) * times, (i + 0.5) * times, times)));
  add_coarse(far, coarse, times, {4, 20}, frame, near);
  double sum = 0;
  for (int i = 0; i < frame.rows; ++i)
    for (int j = 0; j < frame.columns; ++j) {
      const double value = double(near[static_cast<std::size_t>(i * frame.columns + j)]) - 1;
      if (i >= 4 && i < 20) sum += value;
      if (i < 4 || i >= 20) {
        EXPECT_EQ(value, 0);
      }
      if (i >= 4 && i < 20 && j >= 4 && j < 36) {
        EXPECT_NEAR(value, mean(j + 0.5, i + 0.5, 1), 1e-4);
      }
    }
  const double wanted = std::accumulate(far.begin() + 10, far.end() - 10, 0.0) * times * times;
  EXPECT_NEAR(sum / wanted, 1, 1e-6);
}

// The bound is the tolerance: the picture of whole kernels is made to a hundredth of it. Where the halo's
// share changes from field to field, tables are not interpolated like their parts; here it does not.
TEST(FarLight, AddsUpToThePictureOfWholeKernels) {
  const Scene scene = noise_scene({550});
  for (const double share : {0.3, 0.02}) {
    const LensDataTable table = halo_table(false, {550}, share);
    ImagingReport report;
    const SpectralImage whole = form_image(scene, table, sensor, from_pixels(0, 1e-5), {}, &report);
    EXPECT_EQ(report.tail_pixels, 0);
    for (const int pixels : {ImagingOptions().tail_pixels, 32}) {
      const SpectralImage parts = form_image(scene, table, sensor, from_pixels(pixels), {}, &report);
      EXPECT_EQ(report.tail_pixels, pixels);
      EXPECT_LT(report.margin_cells, 80);
      EXPECT_EQ(report.brightest, double(std::ranges::max(parts.band(0))));
      EXPECT_LT(difference(parts, whole, 0), 1e-3) << share << pixels;
    }
    if (share == 0.3) {
      EXPECT_LT(difference(form_image(scene, table, sensor, from_pixels(32, 1e-4)), whole, 0), 3e-4);
    }
  }
}

TEST(FarLight, IsInEveryRowAndBandThatIsAskedFor) {
  const LensDataTable table = halo_table(false, {500, 600});
  const Scene scene = noise_scene({500, 600});
  const ImagingOptions options = from_pixels(32);
  const SpectralImage whole = form_image(scene, table, sensor, options);
  ImageSeries series(scene, table, sensor, options);
  const AimedLight some{{{}}, {10, 20}};
  const std::vector<SpectralImage> rows = series.form(std::span(&some, 1));
  for (const int band : {0, 1})
    for (std::size_t i = 10 * 33; i < 20 * 33; ++i)
      EXPECT_NEAR(rows[0].band(band)[i], whole.band(band)[i], 1e-6);
  // Of two processes each forms a band, and knows the other's.
  const auto known = [&](int band, std::span<float> pixels) {
    std::ranges::copy(whole.band(band), pixels.begin());
  };
  for (const int band : {0, 1}) {
    const SpectralImage again =
        form_image(scene, table, sensor, options, {}, nullptr, {band, band + 1, known});
    for (const int other : {0, 1})
      EXPECT_TRUE(std::ranges::equal(again.band(other), whole.band(other))) << band << other;
  }
}

}  // namespace
}  // namespace petzval
