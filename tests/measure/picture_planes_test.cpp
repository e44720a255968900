// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/measure/sfr/picture_planes.h>

#include "scratch.h"

namespace petzval {
namespace {

/// The light that half of full scale is taken for in a TIFF with this description.
double light_of_half(const std::string& description) {
  const test::Scratch folder;
  TiffImage tiff;
  tiff.columns = 2, tiff.rows = 1, tiff.channels = 1;
  tiff.samples = std::vector<std::uint16_t>{32768, 32768};
  tiff.description = description;
  write_tiff(folder.path("half.tif"), tiff);
  return static_cast<double>(read_picture_planes(folder.path("half.tif")).luminance().values.front());
}

// IEC 61966-2-1 takes 0.5 for 0.214.
TEST(PicturePlanes, ATiffIsLinearWhereItsDescriptionSaysSo) {
  for (const char* linear : {"linear", "petzval target, linear", "scene (linear)"})
    EXPECT_NEAR(light_of_half(linear), 0.5, 1e-4) << linear;
  for (const char* encoded : {"", "petzval target, sRGB", "non-linear", "non linear", "not linear",
                              "nonlinear", "linearised by hand", "linear-ish"})
    EXPECT_NEAR(light_of_half(encoded), 0.2140, 1e-4) << encoded;
}

}  // namespace
}  // namespace petzval
