// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/render/textures/picture_texture.h>

#include <memory>

namespace petzval::render {
namespace {

/// One row whose pixels are as bright as their number, from 0 to width − 1.
std::shared_ptr<const PictureFile> ramp_of_pixels(int width) {
  auto picture = std::make_shared<PictureFile>(PictureFile{width, 1, 1, {}});
  for (int i = 0; i < width; ++i) picture->values.push_back(static_cast<float>(i));
  return picture;
}

TEST(PictureSampler, WrapsFarOutsideOfAWidePictureToo) {
  // 8192 pixels a unit: beyond 262144 units the number of the pixel is more than an int holds. Both numbers
  // are exact in binary, and the middle of a pixel has no share of the next.
  constexpr int width = 8192;
  constexpr double far = 600000, place = far + (5 + 0.5) / width;
  const auto at = [&](PictureWrap wrap, double s) {
    return PictureSampler(ramp_of_pixels(width), wrap, true).at(s, 0.5)[0];
  };
  EXPECT_EQ(at(PictureWrap::repeat, place), 5);
  EXPECT_EQ(at(PictureWrap::repeat, -place), width - 6);
  EXPECT_EQ(at(PictureWrap::mirror, place), 5);
  EXPECT_EQ(at(PictureWrap::mirror, place + 1), width - 6);
  EXPECT_EQ(at(PictureWrap::clamp, place), width - 1);
  EXPECT_EQ(at(PictureWrap::clamp, -place), 0);
  EXPECT_EQ(at(PictureWrap::black, place), 0);
}

}  // namespace
}  // namespace petzval::render
