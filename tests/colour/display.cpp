// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/colour/display.h>

#include <cmath>

namespace petzval {
namespace {

TEST(Srgb, MatrixIsThePublishedOne) {
  // IEC 61966-2-1 prints four decimals.
  const double published[3][3] = {
      {3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};
  // The standard rounded the forward matrix to four decimals first and inverted that: its inverse differs
  // from the exact one by up to 5e-4.
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(srgb_from_xyz()[i][j], published[i][j], 5e-4);
  const double forward[3][3] = {{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(xyz_from_srgb()[i][j], forward[i][j], 1e-4);
}

TEST(Srgb, WhiteIsWhiteAndThereIsAWayBack) {
  const LinearRgb white = linear_srgb(display_white());
  EXPECT_NEAR(white.r, 1, 1e-14);
  EXPECT_NEAR(white.g, 1, 1e-14);
  EXPECT_NEAR(white.b, 1, 1e-14);
  const LinearRgb there = linear_srgb(xyz_of(LinearRgb{0.1, -0.2, 3}));
  EXPECT_NEAR(there.r, 0.1, 1e-14);
  EXPECT_NEAR(there.g, -0.2, 1e-14);
  EXPECT_NEAR(there.b, 3, 1e-14);
}

TEST(Srgb, CurveHasThePublishedPoints) {
  // Figures of the standard's formulas quoted widely: 18 % grey is code 117.65 of 255, half of the light
  // 187.5, code 128 of 255 is 21.586 % of the light.
  EXPECT_NEAR(255 * srgb_encoded(0.18), 117.65, 0.005);
  EXPECT_NEAR(255 * srgb_encoded(0.5), 187.516, 0.0005);
  EXPECT_NEAR(srgb_decoded(128.0 / 255), 0.215861, 5e-7);
  EXPECT_EQ(srgb_encoded(0), 0);
  EXPECT_NEAR(srgb_encoded(1), 1, 1e-15);
  EXPECT_NEAR(srgb_encoded(0.002), 0.02584, 1e-15);  // the straight part: 12.92 · 0.002
  EXPECT_NEAR(srgb_encoded(-0.5), -srgb_encoded(0.5), 1e-15);
  for (const double linear : {-0.3, 0.0, 0.001, 0.01, 0.2, 1.0, 4.0})
    EXPECT_NEAR(srgb_decoded(srgb_encoded(linear)), linear, 1e-12);
  // The two parts of the curve meet with a step of 1e-7 or less as the standard's constants have it.
  EXPECT_NEAR(srgb_encoded(0.0031308), srgb_encoded(std::nextafter(0.0031308, 1)), 1e-7);
}

TEST(Quantised, RoundsToNearestAndClips) {
  EXPECT_EQ(quantised_8(0.5), 128);
  EXPECT_EQ(quantised_8(0.4999 / 255), 0);
  EXPECT_EQ(quantised_8(0.5001 / 255), 1);
  EXPECT_EQ(quantised_8(-1), 0);
  EXPECT_EQ(quantised_8(7), 255);
  EXPECT_EQ(quantised_8(std::nan("")), 0);
  EXPECT_EQ(quantised_8(INFINITY), 255);
  EXPECT_EQ(quantised_16(1), 65535);
  EXPECT_EQ(quantised_16(0.25), 16384);
}

TEST(Bradford, TakesD50ToD65AsPublished) {
  // Lindbloom, "Chromatic Adaptation" (brucelindbloom.com), whites of ASTM E308.
  const double published[3][3] = {{0.9555766, -0.0230393, 0.0631636},
                                  {-0.0282895, 1.0099416, 0.0210077},
                                  {0.0122982, -0.0204830, 1.3299098}};
  const ColourMatrix matrix = bradford_adaptation({0.96422, 1, 0.82521}, {0.95047, 1, 1.08883});
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(matrix[i][j], published[i][j], 1e-7);
}

TEST(Bradford, MapsWhiteToWhiteAndRefusesLightThatIsNone) {
  const Xyz lamp{1.0985, 1, 0.3558};
  const Xyz white = bradford_adaptation(lamp, display_white()) * lamp;
  EXPECT_NEAR(white.x, display_white().x, 1e-14);
  EXPECT_NEAR(white.y, 1, 1e-14);
  EXPECT_NEAR(white.z, display_white().z, 1e-14);
  EXPECT_THROW(bradford_adaptation({0, 0, 0}, display_white()), InputError);
  EXPECT_THROW(bradford_adaptation({0.2, 1, std::nan("")}, display_white()), InputError);
}

}  // namespace
}  // namespace petzval
