// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/image/spectral_image.h>

#include <cmath>
#include <limits>
#include <utility>

namespace petzval {
namespace {

TEST(SpectralImage, HoldsPlanesRowByRow) {
  SpectralImage image(3, 2, {450, 550}, 6.25, PixelAperture::point);
  EXPECT_EQ(image.bands(), 2);
  EXPECT_EQ(image.values().size(), 12u);
  EXPECT_EQ(image.at(1, 1, 2), 0.0f);
  image.at(1, 0, 2) = 5;
  EXPECT_EQ(image.values()[6 + 2], 5.0f);
  EXPECT_EQ(image.band(1)[2], 5.0f);
  EXPECT_EQ(image.pixel_aperture(), PixelAperture::point);
  EXPECT_EQ(image.pitch_um(), 6.25);
}

TEST(SpectralImage, RefusesWhatIsNoImage) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_THROW(SpectralImage(0, 2, {450}, 1), InputError);
  EXPECT_THROW(SpectralImage(2, -1, {450}, 1), InputError);
  EXPECT_THROW(SpectralImage(2, 2, {}, 1), InputError);
  EXPECT_THROW(SpectralImage(2, 2, {450, 450}, 1), InputError);
  EXPECT_THROW(SpectralImage(2, 2, {550, 450}, 1), InputError);
  EXPECT_THROW(SpectralImage(2, 2, {std::nan("")}, 1), InputError);
  EXPECT_THROW(SpectralImage(2, 2, {450, inf}, 1), InputError);
  EXPECT_THROW(SpectralImage(2, 2, {450}, 0), InputError);
  EXPECT_THROW(SpectralImage(2, 2, {450}, inf), InputError);
  // Would be 2^64 bytes: refused before anything is allocated.
  EXPECT_THROW(SpectralImage(2147483647, 2147483647, {450}, 1), InputError);
}

TEST(SpectralImage, GivesUpNoBandThatItHasNot) {
  SpectralImage image(3, 4, {450, 550}, 6.25);
  EXPECT_NO_THROW(image.give_up_band(1));
  for (const int band : {-1, 2, 2147483647}) EXPECT_THROW(image.give_up_band(band), InputError) << band;
}

TEST(SpectralImage, SaysWhereItIsNotFinite) {
  SpectralImage image(3, 2, {450, 550}, 6.25);
  image.at(0, 1, 1) = -1e-9f;
  EXPECT_NO_THROW(image.validate());
  image.at(1, 1, 2) = std::nanf("");
  try {
    image.validate();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("550 nm, row 1, column 2"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace petzval
