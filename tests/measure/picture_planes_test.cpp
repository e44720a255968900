// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/measure/sfr/picture_planes.h>
#include <petzval/sensor/formats/dng.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "image/hostile.h"
#include "jpeg_bytes.h"
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

/// A grey ramp as another program would write it.
std::string jpeg_of_ramp(int columns, int rows) {
  std::vector<std::uint8_t> codes;
  for (int i = 0; i < columns * rows; ++i) codes.push_back(static_cast<std::uint8_t>(20 + 4 * (i % columns)));
  return test::jpeg_bytes(columns, rows, 1, codes);
}

// By the sRGB curve of IEC 61966-2-1, written here once more.
TEST(PicturePlanes, OfAJpegAreItsCodesAsLight) {
  const test::Scratch folder;
  const std::string path = folder.with("ramp.jpg", jpeg_of_ramp(48, 16));
  const PicturePlanes picture = read_picture_planes(path);
  ASSERT_EQ(picture.columns, 48);
  EXPECT_TRUE(picture.srgb && picture.assumed);
  EXPECT_EQ(picture.bits, 8);
  for (int column = 2; column < 46; ++column) {
    const double code = (20 + 4 * column) / 255.0, step = std::pow((code + 0.055) / 1.055, 1.4) * 2.4 / 1.055;
    const double light = std::pow((code + 0.055) / 1.055, 2.4);
    // A code or two from compression.
    EXPECT_NEAR(picture.luminance().values[static_cast<std::size_t>(8 * 48 + column)], light, 2 * step / 255)
        << column;
  }
  EXPECT_NEAR(read_picture_planes(path, PictureTransfer::linear).luminance().values[8 * 48 + 20], 100 / 255.0,
              2 / 255.0);
}

TEST(PicturePlanes, DamagedJpegsDoNoHarm) {
  const test::Scratch folder;
  const std::string bytes = jpeg_of_ramp(48, 16);
  std::mt19937 random(1850);
  std::uniform_int_distribution<std::size_t> at(0, bytes.size() - 1);
  const test::Read read = [](const std::string& path) { read_picture_planes(path); };
  for (int trial = 0; trial < 400; ++trial) {
    std::string damaged = bytes;
    for (int i = 0; i <= trial % 4; ++i) damaged[at(random)] = static_cast<char>(random());
    if (trial % 3 == 0) damaged.resize(at(random));
    test::taken(read, folder.with("damaged.jpg", damaged), "trial " + std::to_string(trial));
  }
}

RawImage raw_of(const std::vector<std::string>& channels) {
  RawImage raw;
  raw.columns = 8, raw.rows = 6;
  raw.mosaic = channels.size() == 1 ? Mosaic{1, 1, {0}} : Mosaic{2, 2, {0, 1, 1, 2}};
  raw.channels = channels;
  raw.black_level = 64, raw.white_level = 1023;
  for (int i = 0; i < 48; ++i) raw.samples.push_back(static_cast<std::uint16_t>(64 + 19 * i));
  return raw;
}

// Black is 0, white is 1, and a Bayer mosaic stays as the sensor has it.
TEST(PicturePlanes, OfADngAreLinearAndSayTheirMosaic) {
  const test::Scratch folder;
  write_dng(folder.path("bayer.dng"), raw_of({"red", "green", "blue"}));
  const PicturePlanes mosaic = read_picture_planes(folder.path("bayer.dng"));
  EXPECT_EQ(mosaic.bayer, "rggb");
  ASSERT_EQ(mosaic.planes.size(), 1);
  for (std::size_t i = 0; i < 48; ++i)
    EXPECT_NEAR(mosaic.planes[0].values[i], 19.0 * double(i) / (1023 - 64), 1e-6);
  const PicturePlanes full = read_picture_planes(folder.path("bayer.dng"), PictureTransfer::stated, true);
  EXPECT_TRUE(full.rgb && full.bayer.empty());
  EXPECT_NEAR(full.planes[0].values[0], 0, 1e-6);                       // a red sample keeps its light
  EXPECT_NEAR(full.planes[2].values[9], 19.0 * 9 / (1023 - 64), 1e-6);  // and a blue one
}

}  // namespace
}  // namespace petzval
