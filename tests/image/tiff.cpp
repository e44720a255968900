// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/tiff.h>
#include <tiffio.h>

#include <cmath>

#include "hostile.h"

namespace petzval {
namespace {

template <typename Sample>
TiffImage counting(int columns, int rows, int channels) {
  TiffImage image{columns, rows, channels, std::vector<Sample>(), {}, {}};
  std::vector<Sample> samples(image.sample_count());
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<Sample>(i * 37 % 251);
  image.samples = samples;
  return image;
}

TEST(Tiff, RoundTripsEveryKind) {
  const test::Scratch scratch;
  for (int channels : {1, 2, 3, 4, 7})
    for (TiffImage image : {counting<std::uint8_t>(5, 700, channels),
                            counting<std::uint16_t>(300, 3, channels), counting<float>(1, 1, channels)}) {
      image.description = "how it came about";
      image.icc_profile = std::string("a\0profile", 9);
      write_tiff(scratch.path("a.tif"), image);
      const TiffImage back = read_tiff(scratch.path("a.tif"));
      EXPECT_EQ(back.columns, image.columns);
      EXPECT_EQ(back.rows, image.rows);
      EXPECT_EQ(back.channels, image.channels);
      EXPECT_EQ(back.samples, image.samples);
      EXPECT_EQ(back.description, image.description);
      EXPECT_EQ(back.icc_profile, image.icc_profile);
    }
}

TEST(Tiff, FloatsKeepEveryBit) {
  const test::Scratch scratch;
  TiffImage image{3, 1, 1, std::vector<float>{-0.1f, 1e-38f, INFINITY}, {}, {}};
  write_tiff(scratch.path("f.tif"), image);
  EXPECT_EQ(read_tiff(scratch.path("f.tif")).samples, image.samples);
}

/// A file as libtiff itself writes it: 40 x 30, three channels, sample = column + 3 row + channel.
std::string foreign(const test::Scratch& scratch, const std::string& name, int compression, bool tiled,
                    int planes, int photometric, const char* mode) {
  constexpr int columns = 40, rows = 30, tile = 16;
  const int channels = photometric == PHOTOMETRIC_RGB ? 3 : 1;
  TIFF* tiff = TIFFOpen(scratch.path(name).c_str(), mode);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, columns);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, rows);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, channels);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, compression);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, planes);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, photometric);
  if (compression == COMPRESSION_LZW) TIFFSetField(tiff, TIFFTAG_PREDICTOR, 2);
  if (tiled) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, tile);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, tile);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 7);
  }
  const int width = tiled ? tile : columns, height = tiled ? tile : 1;
  const int inside = planes == PLANARCONFIG_CONTIG ? channels : 1;
  for (int plane = 0; plane < channels / inside; ++plane)
    for (int top = 0; top < rows; top += height)
      for (int left = 0; left < columns; left += width) {
        std::vector<std::uint16_t> block;
        for (int row = top; row < top + height; ++row)
          for (int column = left; column < left + width; ++column)
            for (int c = 0; c < inside; ++c)
              block.push_back(static_cast<std::uint16_t>(column + 3 * row + plane + c));
        if (tiled)
          TIFFWriteTile(tiff, block.data(), static_cast<std::uint32_t>(left), static_cast<std::uint32_t>(top),
                        0, static_cast<std::uint16_t>(plane));
        else
          TIFFWriteScanline(tiff, block.data(), static_cast<std::uint32_t>(top),
                            static_cast<std::uint16_t>(plane));
      }
  TIFFClose(tiff);
  return scratch.path(name);
}

TEST(Tiff, ReadsWhatLibtiffWrites) {
  const test::Scratch scratch;
  for (int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS})
    for (bool tiled : {false, true})
      for (int planes : {PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE})
        for (int photometric : {PHOTOMETRIC_RGB, PHOTOMETRIC_MINISBLACK, PHOTOMETRIC_MINISWHITE})
          for (const char* mode : {"wl", "wb", "w8"}) {
            const TiffImage image =
                read_tiff(foreign(scratch, "x.tif", compression, tiled, planes, photometric, mode));
            ASSERT_EQ(image.columns, 40);
            ASSERT_EQ(image.rows, 30);
            const auto& samples = std::get<std::vector<std::uint16_t>>(image.samples);
            const bool white_is_zero = photometric == PHOTOMETRIC_MINISWHITE;
            for (int row = 0; row < 30; ++row)
              for (int column = 0; column < 40; ++column)
                for (int c = 0; c < image.channels; ++c) {
                  const int value = column + 3 * row + c;
                  ASSERT_EQ(samples[static_cast<std::size_t>((row * 40 + column) * image.channels + c)],
                            white_is_zero ? 65535 - value : value);
                }
          }
}

TEST(Tiff, RefusesWhatItCannotHold) {
  const test::Scratch scratch;
  TiffImage image = counting<std::uint8_t>(4, 4, 3);
  image.columns = 5;
  EXPECT_THROW(write_tiff(scratch.path("a.tif"), image), InputError);
  image.columns = 0;
  EXPECT_THROW(write_tiff(scratch.path("a.tif"), image), InputError);
  EXPECT_THROW(write_tiff(scratch.path("none/a.tif"), counting<float>(4, 4, 3)), InputError);
  EXPECT_TRUE(scratch.is_empty());
  EXPECT_THROW(read_tiff(scratch.path("none.tif")), InputError);
  EXPECT_THROW(read_tiff(scratch.with("b.tif", "II*")), InputError);
}

TEST(Tiff, DamageIsRefusedOrHarmless) {
  const test::Scratch scratch;
  write_tiff(scratch.path("a.tif"), counting<std::uint16_t>(40, 30, 3));
  const std::string plain = read_whole_file(scratch.path("a.tif"));
  const std::string packed = read_whole_file(
      foreign(scratch, "b.tif", COMPRESSION_LZW, true, PLANARCONFIG_CONTIG, PHOTOMETRIC_RGB, "w"));
  test::refuses_truncations(scratch, plain, read_tiff);
  // The directory of our files is at their end; its bits are flipped one by one.
  for (std::size_t bit = 8 * (plain.size() - 200); bit < 8 * plain.size(); ++bit) {
    std::string damaged = plain;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    test::taken(read_tiff, scratch.with("flipped", damaged), "bit " + std::to_string(bit));
  }
  test::survives_flips(scratch, packed, 8, read_tiff);
}

}  // namespace
}  // namespace petzval
