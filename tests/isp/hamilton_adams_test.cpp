// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/isp/demosaic.h>

#include <cmath>

#include "mosaic_samples.h"

namespace petzval {
namespace {

// Along a grey edge nothing changes, and the method looks along it: what varies in one direction alone,
// however abruptly, comes back exactly. (1e-6: floats.)
TEST(HamiltonAdams, GreyEdgesAlongTheGridAreExact) {
  const auto profile = [](int i) { return i < 17 ? 0.2 : i < 30 ? 0.9 : 0.3 + 0.2 * std::sin(1.7 * i); };
  for (const char* order : {"RGGB", "BGGR", "GRBG", "GBRG"})
    for (const test::Picture& picture : {test::Picture([&](int, int, int c) { return profile(c); }),
                                         test::Picture([&](int, int r, int) { return profile(r); })})
      EXPECT_LT(
          test::rms_error(demosaiced(test::bayer(48, 48, order, picture), "hamilton-adams"), picture, 3),
          1e-6)
          << order;
}

// What it was invented for: the detail of a grey zone plate up to 0.35 cycles a pixel, better by a fifth at
// least.
TEST(HamiltonAdams, BeatsBilinear) {
  const test::Picture picture = [](int channel, int r, int c) {
    const double y = r - 100, x = c - 100;
    return 0.5 + 0.3 * std::cos(3.14159265 * 0.35 / 100 * (x * x + y * y) / 2) +
           0.1 * std::sin(0.05 * c + 2 * channel);
  };
  const LinearMosaic mosaic = test::bayer(200, 200, "GRBG", picture);
  EXPECT_LT(test::rms_error(demosaiced(mosaic, "hamilton-adams"), picture, 10),
            0.8 * test::rms_error(demosaiced(mosaic, "bilinear"), picture, 10));
}

}  // namespace
}  // namespace petzval
