// SPDX-License-Identifier: BSD-3-Clause
// Charge that flows along columns: by hand, by what it adds up to, and through a whole exposure.
#include <gtest/gtest.h>
#include <petzval/base/parallel.h>
#include <petzval/numeric/random.h>
#include <petzval/sensor/blooming.h>
#include <petzval/sensor/capture.h>
#include <petzval/sensor/photo_current.h>

#include <algorithm>
#include <numeric>

#include "flat_sensor.h"

namespace petzval {
namespace {

TEST(Blooming, APixelFillsItsColumnEvenlyBothWays) {
  std::vector<double> column(21, 0.0);
  column[10] = 7.5 * 1000;  // itself, three more each way, and a quarter
  bloom_column(column, 1000);
  for (int i = 0; i < 21; ++i) {
    const int away = std::abs(i - 10);
    EXPECT_DOUBLE_EQ(column[static_cast<std::size_t>(i)], away <= 3 ? 1000 : away == 4 ? 250 : 0) << i;
  }
}

TEST(Blooming, RunsPastWhatIsFullAndOutAtTheEnds) {
  std::vector<double> column{0, 1000, 1000, 5000, 1000, 400};
  bloom_column(column, 1000);
  // Upwards 2000, of which one pixel takes 1000; downwards 2000, of which one takes 600.
  EXPECT_EQ(column, std::vector<double>(6, 1000.0));
}

TEST(Blooming, KeepsCharge) {
  RandomStream random(3, 0, 0);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> column(400, 0.0);
    for (std::size_t i = 100; i < 300; ++i)
      column[i] = random.uniform() < 0.05 ? 20000 * random.uniform() : 900 * random.uniform();
    const double before = std::accumulate(column.begin(), column.end(), 0.0);
    bloom_column(column, 1000);
    EXPECT_NEAR(std::accumulate(column.begin(), column.end(), 0.0) / before, 1, 1e-12);
    EXPECT_LE(*std::ranges::max_element(column), 1000);
  }
}

/// A lamp of so many full wells in the middle of a frame that is dark.
RawImage lamp(double full_wells, double onset, const CaptureOptions& options = {}) {
  Sensor sensor = test::mono_sensor(9, 41);
  sensor.electronics->blooming_onset = onset;
  PhotoCurrent current = photo_current(test::uniform_light(9, 41, 0), sensor, {});
  current.e_per_s[20 * 9 + 4] = static_cast<float>(full_wells * 100000);
  return capture(current, sensor, 1, options);
}

int saturated(const RawImage& raw, int column) {
  int count = 0;
  for (int row = 0; row < raw.rows; ++row) count += raw.pixel(row, column) >= raw.white_level ? 1 : 0;
  return count;
}

TEST(Blooming, MakesAStreakInTheColumnOfALamp) {
  CaptureOptions still;
  still.without = {NoiseSource::shot};
  EXPECT_EQ(saturated(lamp(11, 0, still), 4), 1);
  EXPECT_EQ(saturated(lamp(11, 1, still), 4), 11);
  EXPECT_EQ(saturated(lamp(11, 1, still), 3), 0);
  // A drain that takes three full wells, in each pixel on the way.
  EXPECT_EQ(saturated(lamp(12, 4, still), 4), 3);
  still.without.insert(NoiseSource::blooming);
  EXPECT_EQ(saturated(lamp(11, 1, still), 4), 1);
}

TEST(Blooming, DoesNotDependOnThreads) {
  const auto with = [](int threads) {
    const ThreadLimit limit(threads);
    CaptureOptions options;
    options.frames = 2;
    return lamp(11.3, 1, options).samples;
  };
  EXPECT_EQ(with(1), with(2));
}

}  // namespace
}  // namespace petzval
