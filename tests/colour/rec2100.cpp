// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/colour/rec2100.h>

#include <cmath>

namespace petzval {
namespace {

// 100 cd/m²: as colour-science gives it; 203: 58 % in ITU-R BT.2408-7, table 1.
TEST(Rec2100, PerceptualQuantisationIsThatOfSt2084) {
  EXPECT_NEAR(pq_encoded(100), 0.508078421517399, 1e-12);
  EXPECT_NEAR(pq_encoded(203), 0.58, 0.005);
  EXPECT_EQ(pq_encoded(10000), 1);
  for (const double luminance : {0.01, 1.0, 203.0, 9000.0})
    EXPECT_NEAR(pq_decoded(pq_encoded(luminance)) / luminance, 1, 1e-9);
}

// Diffuse white and 18 % grey are 75 % and 38 % of HLG, 203 and 26 cd/m² on a display of 1000 cd/m² (ITU-R
// BT.2408-7, table 1); half of the code is a twelfth of the light (BT.2100).
TEST(Rec2100, HybridLogGammaShowsWhatBt2408States) {
  const auto grey = [](double encoded) {
    const double light = hlg_decoded(encoded);
    return hlg_displayed({light, light, light});
  };
  EXPECT_NEAR(hlg_decoded(0.5), 1.0 / 12, 1e-12);
  EXPECT_NEAR(hlg_decoded(1), 1, 1e-6);
  EXPECT_NEAR(grey(0.75).g, 203, 1);
  EXPECT_NEAR(grey(0.38).g, 26, 0.5);
  EXPECT_NEAR(grey(1).r, 1000, 1e-2);
  // Blue weighs 0.0593 in the luminance of BT.2020.
  EXPECT_NEAR(hlg_displayed({0, 0, 1}).b, 1000 * std::pow(0.0593, 0.2), 0.1);
}

}  // namespace
}  // namespace petzval
