// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <libraw/libraw.h>
#include <petzval/base/error.h>
#include <petzval/colour/display.h>
#include <petzval/numeric/random.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/sensor/formats/linear_dng.h>
#include <petzval/sensor/formats/original_raw.h>

namespace petzval {
namespace {

std::string picture_bytes() {
  LinearPicture picture{41, 30, std::vector<std::uint16_t>(3 * 41 * 30, 9), {}, {}, ""};
  const ColourMatrix matrix = srgb_from_xyz();
  for (std::size_t i = 0; i < 9; ++i) picture.rgb_from_xyz[i] = matrix[i / 3][i % 3];
  return linear_dng_bytes(picture, "l.dng");
}

/// More than two blocks of 64 KiB, which deflate little.
std::string noise() {
  std::string bytes;
  for (std::uint64_t i = 0; i < 150000; ++i) bytes += static_cast<char>(RandomStream(5, 0, i).bits() & 0x3f);
  return bytes;
}

TEST(OriginalRaw, ComesBackAndIsPassedOver) {
  const std::string picture = picture_bytes();
  EXPECT_FALSE(original_raw(picture));
  for (const std::string& original : {std::string(), std::string("a"), noise()}) {
    const std::string whole = with_original_raw(picture, original);
    EXPECT_EQ(original_raw(whole), original);
    LibRaw libraw;
    ASSERT_EQ(libraw.open_buffer(const_cast<char*>(whole.data()), whole.size()), LIBRAW_SUCCESS);
    ASSERT_EQ(libraw.unpack(), LIBRAW_SUCCESS);
    EXPECT_EQ(libraw.imgdata.sizes.width, 41);
    EXPECT_EQ(libraw.imgdata.idata.filters, 0u);
    const libraw_rawdata_t& planes = libraw.imgdata.rawdata;
    ASSERT_TRUE(planes.color3_image || planes.color4_image);
    EXPECT_EQ(planes.color3_image ? planes.color3_image[100][1] : planes.color4_image[100][1], 9);
  }
}

TEST(OriginalRaw, ReadsAsTheMosaicThatItIs) {
  RawImage raw;
  raw.columns = 8, raw.rows = 4;
  raw.channels = {"red", "green", "blue", "white"};
  raw.mosaic = {2, 4, {3, 0, 3, 1, 1, 3, 2, 3}};
  for (int i = 0; i < 32; ++i) raw.samples.push_back(static_cast<std::uint16_t>(i * i));
  const RawImage back = parse_dng(with_original_raw(picture_bytes(), dng_bytes(raw, "a.dng")), "a.dng");
  EXPECT_EQ(back.samples, raw.samples);
  EXPECT_EQ(back.mosaic, raw.mosaic);
  EXPECT_EQ(back.channels, raw.channels);
}

TEST(OriginalRaw, DamageIsRefused) {
  EXPECT_THROW(with_original_raw("no TIFF file", "a"), InputError);
  const std::string picture = picture_bytes(), whole = with_original_raw(picture, noise());
  EXPECT_THROW(original_raw(whole.substr(0, picture.size() + 1000)), InputError);
  const std::size_t fork = (picture.size() + 1) / 2 * 2;
  for (const std::size_t byte : {0u, 1u, 4u, 8u, 12u, 5000u}) {  // length, places, what is deflated
    std::string bad = whole;
    bad[fork + byte] = static_cast<char>(bad[fork + byte] ^ 0x55);
    EXPECT_THROW(original_raw(bad), InputError) << byte;
    EXPECT_THROW(parse_dng(bad, "a.dng"), InputError) << byte;
  }
}

}  // namespace
}  // namespace petzval
