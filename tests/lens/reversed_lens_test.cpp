// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/reversed_lens.h>

namespace petzval {
namespace {

/// A lens between two media of one index has one focal length both ways, and its focal points change places.
TEST(ReversedLens, HasItsFocalPointsTheOtherWayRound) {
  for (const char* name : {"cooke-triplet", "double-gauss", "tessar"}) {
    const Lens lens = read_lens(name).lens, turned = reversed_lens(lens);
    const FirstOrder before = first_order(lens), after = first_order(turned);
    EXPECT_NEAR(after.efl_mm / before.efl_mm, 1, 1e-9) << name;
    EXPECT_NEAR(after.bfl_mm, -before.ffl_mm, 1e-9 * before.efl_mm) << name;
    EXPECT_NEAR(after.ffl_mm, -before.bfl_mm, 1e-9 * before.efl_mm) << name;
    EXPECT_NEAR(after.petzval_radius_mm / before.petzval_radius_mm, 1, 1e-9) << name;
    EXPECT_NEAR(turned.surfaces.back().thickness_mm, after.bfl_mm, 1e-9 * before.efl_mm) << name;
  }
}

TEST(ReversedLens, TurnedTwiceIsWhatItWas) {
  const Lens lens = read_lens("tessar").lens, twice = reversed_lens(reversed_lens(lens));
  ASSERT_EQ(twice.surfaces.size(), lens.surfaces.size());
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    EXPECT_EQ(twice.surfaces[i].curvature_per_mm, lens.surfaces[i].curvature_per_mm) << i;
    EXPECT_EQ(twice.surfaces[i].stop, lens.surfaces[i].stop) << i;
    EXPECT_EQ(twice.surfaces[i].material.description(), lens.surfaces[i].material.description()) << i;
    if (i + 1 < lens.surfaces.size()) {
      EXPECT_EQ(twice.surfaces[i].thickness_mm, lens.surfaces[i].thickness_mm) << i;
    }
  }
  EXPECT_NEAR(first_order(twice).f_number / first_order(lens).f_number, 1, 1e-9);
}

TEST(ReversedLens, RefusesGlassUpToTheSensor) {
  Lens lens = read_lens("tessar").lens;
  lens.surfaces.back().material = Material(Material::Constant{1.5});
  EXPECT_THROW(reversed_lens(lens), InputError);
}

}  // namespace
}  // namespace petzval
