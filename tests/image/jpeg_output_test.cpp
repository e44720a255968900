// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/jpeg_output.h>

#include <cmath>

#include "scratch.h"

namespace petzval {
namespace {

JpegImage gradient_picture(int channels) {
  JpegImage image{96, 64, channels, {}, {}};
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.columns; ++column)
      for (int k = 0; k < channels; ++k)
        image.samples.push_back(static_cast<std::uint8_t>(20 + column + row * (k + 1) / 2));
  return image;
}

// At quality 95 the coarsest step of a coefficient is 12, of a smooth picture's low ones 2: codes come back
// within 3.
TEST(JpegOutput, ReadsBackAsItWasWritten) {
  const test::Scratch scratch;
  for (const int channels : {1, 3}) {
    JpegImage image = gradient_picture(channels);
    image.icc_profile = std::string(70000, 'p');  // more than one segment holds
    write_jpeg(scratch.path("a.jpg"), image);
    const JpegImage back = read_jpeg(scratch.path("a.jpg"));
    EXPECT_EQ(back.columns, 96);
    EXPECT_EQ(back.rows, 64);
    EXPECT_EQ(back.channels, channels);
    EXPECT_EQ(back.icc_profile, image.icc_profile);
    ASSERT_EQ(back.samples.size(), image.samples.size());
    for (std::size_t i = 0; i < back.samples.size(); ++i)
      ASSERT_LE(std::abs(back.samples[i] - image.samples[i]), 3) << i;
  }
}

std::uint32_t number_at(const std::string& bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]))
             << 8 * i;
  return value;
}

/// The value of a tag of a directory, read by the letter of TIFF 6.0: a rational as a quotient.
double tag_of(const std::string& tiff, std::size_t directory, std::uint32_t tag) {
  const std::uint32_t entries = number_at(tiff, directory, 2);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t at = directory + 2 + 12 * i;
    if (number_at(tiff, at, 2) != tag) continue;
    const std::uint32_t type = number_at(tiff, at + 2, 2);
    if (type == 3) return number_at(tiff, at + 8, 2);
    if (type == 4) return number_at(tiff, at + 8, 4);
    const std::size_t value = number_at(tiff, at + 8, 4);
    return double(number_at(tiff, value, 4)) / number_at(tiff, value + 4, 4);
  }
  return NAN;
}

TEST(JpegOutput, SaysHowItWasTaken) {
  JpegOptions options;
  options.facts = {.exposure_s = 1.0 / 250,
                   .iso = 88.4,
                   .lens = {.name = "a lens", .focal_length_mm = 6.25, .f_number = 2.8},
                   .camera = "a sensor"};
  const JpegImage image = gradient_picture(3);
  const std::string tiff = exif_of(image.columns, image.rows, options);
  const auto exif = static_cast<std::size_t>(tag_of(tiff, 8, 0x8769));
  EXPECT_NEAR(tag_of(tiff, exif, 0x829a), 0.004, 1e-9);
  EXPECT_NEAR(tag_of(tiff, exif, 0x829d), 2.8, 1e-6);
  EXPECT_NEAR(tag_of(tiff, exif, 0x920a), 6.25, 1e-6);
  EXPECT_EQ(tag_of(tiff, exif, 0x8827), 88);
  EXPECT_EQ(tag_of(tiff, exif, 0xa001), 1);
  EXPECT_EQ(tag_of(tiff, exif, 0xa002), 96);
  EXPECT_NE(tiff.find("a lens"), std::string::npos);
  for (const double time : {1e-6, 0.0123, 0.7, 3.0, 120.5}) {
    options.facts.exposure_s = time;
    const std::string other = exif_of(image.columns, image.rows, options);
    EXPECT_NEAR(tag_of(other, static_cast<std::size_t>(tag_of(other, 8, 0x8769)), 0x829a) / time, 1, 1e-3);
  }
}

TEST(JpegOutput, RefusesWhatJpegDoesNotHave) {
  const test::Scratch scratch;
  EXPECT_THROW(write_jpeg(scratch.path("a.jpg"), gradient_picture(2)), InputError);
  EXPECT_THROW(write_jpeg(scratch.path("a.jpg"), gradient_picture(3), {.quality = 0}), InputError);
  JpegImage wide{70000, 1, 1, std::vector<std::uint8_t>(70000), {}};
  EXPECT_THROW(write_jpeg(scratch.path("a.jpg"), wide), InputError);
  EXPECT_TRUE(scratch.is_empty());
}

}  // namespace
}  // namespace petzval
