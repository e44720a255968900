// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/sensor/lamp_flicker.h>

#include <cmath>

namespace petzval {
namespace {

/// Sums of many thin slices, the second way to the same integrals.
LampFlicker::Moments by_slices(const LampFlicker& flicker, double from_s, double to_s) {
  constexpr int slices = 400000;
  const double width = (to_s - from_s) / slices;
  LampFlicker::Moments sum;
  for (int i = 0; i < slices; ++i) {
    const double after = (i + 0.5) * width, light = flicker.at(from_s + after) * width;
    sum.light += light;
    sum.light_time += light * after;
  }
  return sum;
}

// A slice in which a switched lamp goes on or off is off by at most itself: two in a period, of 5 periods.
TEST(LampFlicker, MomentsAreTheSumsOfThinSlices) {
  const double from_s = 0.0123, to_s = 0.0623, length = to_s - from_s, slice = length / 400000;
  for (const LampFlicker& flicker :
       {LampFlicker(), LampFlicker::mains(50, 0.4), LampFlicker::mains(60, 1, 0.3),
        LampFlicker::pwm(100, 0.25), LampFlicker::pwm(93, 0.6, 0.7), LampFlicker::pwm(100, 1)}) {
    const LampFlicker::Moments exact = flicker.moments(from_s, to_s),
                               sliced = by_slices(flicker, from_s, to_s);
    const double bound = 12 * 4 * slice;
    EXPECT_NEAR(exact.light, sliced.light, bound);
    EXPECT_NEAR(exact.light_time, sliced.light_time, bound * length);
  }
}

TEST(LampFlicker, HasAMeanOfOneOverWholePeriods) {
  EXPECT_NEAR(LampFlicker::mains(50, 0.9, 0.1).moments(0.5, 0.53).light, 0.03, 1e-15);
  EXPECT_NEAR(LampFlicker::pwm(200, 0.1, 0.4).moments(0.7, 0.72).light, 0.02, 1e-15);
}

TEST(LampFlicker, LosesNoDigitsLateInALongClip) {
  const LampFlicker flicker = LampFlicker::pwm(1000, 0.3);
  const LampFlicker::Moments early = flicker.moments(0.0001, 0.0007),
                             late = flicker.moments(5000.0001, 5000.0007);
  // The times themselves are rounded to 5000 · 2^−53 s.
  EXPECT_NEAR(late.light, early.light, 1e-11);
  EXPECT_NEAR(late.light_time, early.light_time, 1e-14);
}

TEST(LampFlicker, IsReadFromWords) {
  EXPECT_TRUE(LampFlicker::parse("none").is_steady());
  EXPECT_DOUBLE_EQ(LampFlicker::parse("mains:50:0.4").frequency_hz(), 100);
  EXPECT_DOUBLE_EQ(LampFlicker::parse("pwm:1000:0.25:0.5").at(0.0006), 4);
  for (const char* wrong : {"", "mains", "mains:50", "mains:50:2", "pwm:0:0.5", "pwm:100:0", "pwm:100:x",
                            "pwm:100:0.5:0:1", "lamp:50:0.5", "mains:nan:0.4"})
    EXPECT_THROW(LampFlicker::parse(wrong), InputError) << wrong;
}

}  // namespace
}  // namespace petzval
