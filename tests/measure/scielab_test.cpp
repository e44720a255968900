// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/colour/cielab.h>
#include <petzval/colour/display.h>
#include <petzval/measure/scielab.h>

#include <cmath>

namespace petzval {
namespace {

ViewedPicture uniform(Xyz colour) {
  return {96, 64, std::vector<Xyz>(96 * 64, colour)};
}

/// Stripes of one pixel of two colours.
ViewedPicture stripes(Xyz a, Xyz b) {
  ViewedPicture picture = uniform(a);
  for (std::size_t i = 1; i < picture.pixels.size(); i += 2) picture.pixels[i] = b;
  return picture;
}

TEST(Scielab, OfUniformPicturesIsCielab) {
  const Xyz a{0.3, 0.32, 0.28}, b{0.32, 0.3, 0.35};
  const double expected = delta_e_ab(cielab(a, display_white()), cielab(b, display_white()));
  // The filters sum to 1; planes are float: 1e-3 of ΔE.
  EXPECT_NEAR(scielab(uniform(a), uniform(b), 30).mean, expected, 2e-3);
  EXPECT_EQ(scielab(uniform(a), uniform(a), 30).max, 0);
}

TEST(Scielab, FineStripesVanishAtADistance) {
  const Xyz light{0.5, 0.5, 0.5}, dark{0.3, 0.3, 0.3};
  const ViewedPicture even = uniform({0.4, 0.4, 0.4}), striped = stripes(light, dark);
  const double near = scielab(striped, even, 8).mean, middle = scielab(striped, even, 40).mean,
               far = scielab(striped, even, 200).mean;
  EXPECT_GT(near, 5);
  EXPECT_LT(middle, near / 2);
  EXPECT_LT(far, 0.3);
}

TEST(Scielab, ColoursVanishBeforeLightness) {
  // Red-green stripes of one lightness: the eye resolves them less than light and dark ones of the same ΔE.
  const Lab grey{60, 0, 0}, red{60, 20, 0}, green{60, -20, 0}, light{80, 0, 0}, dark{40, 0, 0};
  const auto xyz = [](Lab lab) { return xyz_of(lab, display_white()); };
  const double chromatic = scielab(stripes(xyz(red), xyz(green)), uniform(xyz(grey)), 25).mean;
  const double achromatic = scielab(stripes(xyz(light), xyz(dark)), uniform(xyz(grey)), 25).mean;
  EXPECT_LT(chromatic, 0.7 * achromatic);
}

TEST(Scielab, KnowsItsLimits) {
  EXPECT_NEAR(pixels_per_degree(500, 250), 34.9, 0.05);  // 500 mm · 0.017454 / 0.25 mm
  EXPECT_THROW(scielab(uniform({1, 1, 1}), uniform({1, 1, 1}), 1), InputError);
  EXPECT_THROW(scielab(uniform({1, 1, 1}), {2, 2, std::vector<Xyz>(4)}, 30), InputError);
}

}  // namespace
}  // namespace petzval
