// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/wave/cell_light.h>

#include <cmath>

namespace petzval {
namespace {

TEST(FinerSamples, MeetWavesOfTheirBand) {
  // Up to the band's edge, where samples `factor · step` of those that it just allows make half a turn.
  for (const double step : {0.1, 0.2, 0.26, 0.33, 0.4}) {
    const FinerSamples finer = FinerSamples::of_step(step);
    ASSERT_GT(finer.factor, 1) << step;
    ASSERT_LE(finer.factor * step, 0.8 + 1e-12) << step;
    for (double band = -1; band <= 1; band += 0.125)
      for (int phase = 1; phase < finer.factor; ++phase) {
        double re = 0, im = 0;
        for (int j = 0; j < 2 * finer.reach; ++j) {
          const double turn = pi * band * finer.factor * step * (j - (finer.reach - 1));
          const double weight = finer.weights[static_cast<std::size_t>((phase - 1) * 2 * finer.reach + j)];
          re += weight * std::cos(turn), im += weight * std::sin(turn);
        }
        const double turn = pi * band * step * phase;
        EXPECT_NEAR(re, std::cos(turn), 1e-4) << step << ", band " << band;
        EXPECT_NEAR(im, std::sin(turn), 1e-4) << step << ", band " << band;
      }
  }
}

TEST(FinerSamples, StayAsTheyAreWhereTheyAreFewEnough) {
  const FinerSamples same = FinerSamples::of_step(0.45);
  EXPECT_EQ(same.factor, 1);
  EXPECT_EQ(same.needed(17), 17);
  EXPECT_EQ(same.before(), 0);
}

}  // namespace
}  // namespace petzval
