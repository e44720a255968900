// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/simulate/focus.h>

#include <cmath>

namespace petzval {
namespace {

TEST(Focus, IsReadAsItIsWritten) {
  for (const char* text : {"auto", "design", "infinity", "best-spot", "best-mtf@40", "1.2m", "250mm",
                           "paraxial", "1.2m+best-spot", "250mm+best-mtf@40", "infinity+paraxial"})
    EXPECT_EQ(Focus::parse(text).text(), text);
  EXPECT_EQ(Focus::parse("inf"), Focus::infinity());
  EXPECT_EQ(Focus::parse("1200mm"), Focus::parse("1.2m"));
}

TEST(Focus, RefusesWhatCouldMeanTwoThings) {
  for (const char* wrong : {"500", "0m", "-1m", "best-mtf@", "best-mtf@0", "1m+2m", "design+best-spot",
                            "best-spot+1m", "sharp", "", "autofocus"})
    EXPECT_THROW(Focus::parse(wrong), InputError) << wrong;
  EXPECT_THROW(Focus::at_m(0), InputError);
  EXPECT_THROW(Focus::at_m(NAN), InputError);
}

TEST(Focus, AsksForADistanceOrForNone) {
  EXPECT_EQ(asked_distance_m(Focus::at_m(1.5)), 1.5);
  EXPECT_EQ(asked_distance_m(Focus::infinity()), INFINITY);
  EXPECT_EQ(asked_distance_m(Focus::parse("1.5m+best-spot")), 1.5);
  EXPECT_FALSE(asked_distance_m(Focus::parse("best-spot")));
  EXPECT_FALSE(asked_distance_m(Focus::design()));
  EXPECT_FALSE(asked_distance_m(Focus::automatic()));
}

}  // namespace
}  // namespace petzval
