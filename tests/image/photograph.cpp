// SPDX-License-Identifier: BSD-3-Clause
// Picture files of other programs' making, as linear light.
#include <gtest/gtest.h>
#include <lcms2.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/colour/rec2100.h>
#include <petzval/image/formats/jpeg.h>
#include <petzval/image/formats/png.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/image/photograph.h>
#include <tiffio.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "hostile.h"
#include "jpeg_bytes.h"

namespace petzval {
namespace {

using test::jpeg_bytes;
using test::Scratch;

/// An Exif segment with one tag, little- or big-endian.
std::string exif(int orientation, bool big_endian) {
  std::string bytes("Exif\0\0", 6);
  const auto put = [&](unsigned value, int size) {
    for (int i = 0; i < size; ++i)
      bytes += static_cast<char>(value >> (8 * (big_endian ? size - 1 - i : i)) & 0xFF);
  };
  bytes += big_endian ? "MM" : "II";
  put(42, 2), put(8, 4), put(1, 2);      // the first directory, of one entry
  put(0x0112, 2), put(3, 2), put(1, 4);  // Orientation, SHORT, one value
  put(static_cast<unsigned>(orientation), 2), put(0, 2), put(0, 4);
  return bytes;
}

/// Six flat blocks of 8 x 8, ABC above DEF, as Exif's eight orientations turn them.
constexpr const char* turned[8] = {"ABC/DEF",  "CBA/FED",  "FED/CBA",  "DEF/ABC",
                                   "AD/BE/CF", "DA/EB/FC", "FC/EB/DA", "CF/BE/AD"};

std::vector<std::uint8_t> blocks() {
  std::vector<std::uint8_t> samples;
  for (int row = 0; row < 16; ++row)
    for (int column = 0; column < 24; ++column)
      samples.push_back(static_cast<std::uint8_t>(40 * (1 + column / 8 + 3 * (row / 8))));
  return samples;
}

/// The letters of a picture of such blocks.
std::string letters(const Photograph& picture) {
  std::string text;
  for (int row = 4; row < picture.rows; row += 8) {
    if (row > 4) text += '/';
    for (int column = 4; column < picture.columns; column += 8) {
      const double code = 255 * picture.row(row)[static_cast<std::size_t>(3 * column)];
      text += static_cast<char>('A' + std::lround(code / 40) - 1);
    }
  }
  return text;
}

TEST(PhotographFile, JpegIsTurnedUprightByItsExif) {
  const Scratch scratch;
  for (int orientation = 1; orientation <= 8; ++orientation)
    for (const bool big_endian : {false, true}) {
      scratch.with("a.jpg", jpeg_bytes(24, 16, 1, blocks(), {}, exif(orientation, big_endian)));
      EXPECT_EQ(letters(read_photograph(scratch.path("a.jpg"), PhotographEncoding::linear)),
                turned[orientation - 1]);
    }
  for (const int nonsense : {0, 9, 65535}) {
    scratch.with("a.jpg", jpeg_bytes(24, 16, 1, blocks(), {}, exif(nonsense, true)));
    EXPECT_EQ(letters(read_photograph(scratch.path("a.jpg"), PhotographEncoding::linear)), turned[0]);
  }
}

TEST(PhotographFile, DamagedExifIsPassedOver) {
  const std::string whole = exif(6, false);
  EXPECT_EQ(exif_orientation(whole), 6);
  for (std::size_t size = 0; size + 6 < whole.size(); ++size)
    EXPECT_EQ(exif_orientation(whole.substr(0, size)), 1) << size;
  std::string far = whole;
  far[10] = far[11] = far[12] = far[13] = '\xFF';
  EXPECT_EQ(exif_orientation(far), 1);
}

TEST(PhotographFile, TiffIsTurnedUprightByItsTag) {
  const Scratch scratch;
  std::vector<std::uint8_t> samples = blocks();
  for (int orientation = 1; orientation <= 8; ++orientation) {
    TIFF* tiff = TIFFOpen(scratch.path("a.tif").c_str(), "w");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 24);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 16);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 16);
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, orientation);
    TIFFWriteEncodedStrip(tiff, 0, samples.data(), static_cast<tmsize_t>(samples.size()));
    TIFFClose(tiff);
    EXPECT_EQ(letters(read_photograph(scratch.path("a.tif"), PhotographEncoding::linear)),
              turned[orientation - 1]);
  }
}

TEST(PhotographFile, JpegColoursBaselineAndProgressive) {
  const Scratch scratch;
  std::vector<std::uint8_t> samples;
  for (int i = 0; i < 64 * 48; ++i)
    for (const int code : {200, 100, 50}) samples.push_back(static_cast<std::uint8_t>(code));
  const auto progressive = [](jpeg_compress_struct& jpeg) { jpeg_simple_progression(&jpeg); };
  for (const std::string& bytes :
       {jpeg_bytes(64, 48, 3, samples), jpeg_bytes(64, 48, 3, samples, progressive)}) {
    const Photograph picture = read_photograph(scratch.with("a.jpeg", bytes));
    ASSERT_EQ(picture.columns, 64);
    ASSERT_EQ(picture.rows, 48);
    const double expected[3] = {0.577580, 0.127438, 0.031896};  // IEC 61966-2-1 of 200, 100, 50
    // Steps of YCbCr are a code wide.
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(picture.rgb[c], expected[c], 0.02 * expected[c] + 1e-3);
  }
}

TEST(PhotographFile, CmykAndLiesAreRefused) {
  const Scratch scratch;
  const auto refusal = [&](const std::string& bytes) -> std::string {
    try {
      read_photograph(scratch.with("a.jpg", bytes));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(refusal(jpeg_bytes(8, 8, 4, std::vector<std::uint8_t>(256))).find("CMYK"), std::string::npos);
  std::string lie = jpeg_bytes(24, 16, 1, blocks());
  const std::size_t frame = lie.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  for (const std::size_t at : {5u, 6u, 7u, 8u}) lie[frame + at] = '\xF0';  // 61680 x 61680
  EXPECT_NE(refusal(lie).find("too short"), std::string::npos);
  EXPECT_NE(refusal(""), "no error");
}

TEST(PhotographFile, DamagedJpegsDoNoHarm) {
  const Scratch scratch;
  const std::string bytes = jpeg_bytes(24, 16, 1, blocks(), {}, exif(3, true));
  const auto read = [](const std::string& path) { read_jpeg(path); };
  // The last two bytes are the end marker; data may end before it without a loss.
  const std::size_t step = 3;
  for (std::size_t length = 0; length + 8 < bytes.size(); length += step)
    EXPECT_FALSE(test::taken(read, scratch.with("short", bytes.substr(0, length)), std::to_string(length)))
        << length;
  test::survives_flips(scratch, bytes, 0, read);
}

/// Adobe RGB (1998) by its definition, with a gamma of 2.2 (563/256 there).
std::string adobe_profile() {
  const cmsCIExyY white{0.3127, 0.3290, 1};
  const cmsCIExyYTRIPLE primaries{{0.64, 0.33, 1}, {0.21, 0.71, 1}, {0.15, 0.06, 1}};
  cmsToneCurve* curve = cmsBuildGamma(nullptr, 2.2);
  cmsToneCurve* curves[] = {curve, curve, curve};
  cmsHPROFILE profile = cmsCreateRGBProfile(&white, &primaries, curves);
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::string bytes(size, '\0');
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  cmsFreeToneCurve(curve);
  return bytes;
}

TEST(PhotographFile, ColourProfilesAreObeyed) {
  const Scratch scratch;
  const std::uint16_t codes[3] = {20000, 45000, 30000};
  TiffImage tiff{1, 1, 3, std::vector<std::uint16_t>(codes, codes + 3), adobe_profile(), {}};
  write_tiff(scratch.path("a.tif"), tiff);
  PngImage png;
  png.columns = png.rows = 1, png.channels = 3, png.bits = 16;
  png.icc_profile = adobe_profile();
  png.samples.assign(codes, codes + 3);
  write_png(scratch.path("a.png"), png);

  // Both spaces have the same white, red and blue up to scale: linear Adobe RGB to linear sRGB is this
  // matrix.
  double v[3];
  for (int i = 0; i < 3; ++i) v[i] = std::pow(codes[i] / 65535.0, 2.2);
  const double expected[3] = {1.39836 * v[0] - 0.39836 * v[1], v[1], -0.04293 * v[1] + 1.04293 * v[2]};
  for (const char* name : {"a.tif", "a.png"}) {
    const Photograph picture = read_photograph(scratch.path(name));
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(picture.rgb[c], expected[c], 1e-3) << name << ' ' << c;  // profiles hold 16 bits a number
    const Photograph as_srgb = read_photograph(scratch.path(name), PhotographEncoding::srgb);
    EXPECT_NEAR(as_srgb.rgb[0], std::pow((20000 / 65535.0 + 0.055) / 1.055, 2.4), 1e-6);
  }
  tiff.icc_profile = "no profile";
  write_tiff(scratch.path("bad.tif"), tiff);
  EXPECT_THROW(read_photograph(scratch.path("bad.tif")), InputError);
  EXPECT_NO_THROW(read_photograph(scratch.path("bad.tif"), PhotographEncoding::srgb));
}

TEST(PhotographFile, FloatingPointIsLinearAndAlphaIsLeftAside) {
  const Scratch scratch;
  write_tiff(scratch.path("a.tif"), {1, 1, 4, std::vector<float>{0.25f, 3, 0.5f, 0}, {}, {}});
  EXPECT_EQ(read_photograph(scratch.path("a.tif")).rgb, (std::vector<float>{0.25f, 3, 0.5f}));
  PngImage png;
  png.columns = 2, png.rows = 1, png.channels = 2, png.transfer = PngTransfer::linear;
  png.samples = {51, 0, 255, 128};
  write_png(scratch.path("a.png"), png);
  EXPECT_EQ(read_photograph(scratch.path("a.png")).rgb, (std::vector<float>{0.2f, 0.2f, 0.2f, 1, 1, 1}));
}

// BT.2020's red and white in sRGB's primaries: from the chromaticities of both (ITU-R BT.2087, inverted).
TEST(PhotographFile, HighDynamicRangeIsReadAsItsChunkSays) {
  const Scratch scratch;
  PngImage png;
  png.columns = 3, png.rows = 1, png.bits = 16, png.transfer = PngTransfer::rec2100_pq;
  const auto white = static_cast<std::uint16_t>(std::lround(65535 * pq_encoded(203))),
             light = static_cast<std::uint16_t>(std::lround(65535 * pq_encoded(812)));
  png.samples = {white, white, white, light, light, light, white, 0, 0};
  write_png(scratch.path("pq.png"), png);
  const Photograph pq = read_photograph(scratch.path("pq.png"));
  const std::vector<double> expected{1, 1, 1, 4, 4, 4, 1.6605, -0.1246, -0.0182};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(pq.rgb[i], expected[i], 1e-3) << i;

  png.transfer = PngTransfer::rec2100_hlg;
  const auto three_quarters = static_cast<std::uint16_t>(std::lround(65535 * 0.75));
  png.samples.assign(9, three_quarters);
  write_png(scratch.path("hlg.png"), png);
  for (const float value : read_photograph(scratch.path("hlg.png")).rgb) EXPECT_NEAR(value, 1, 0.005);

  // In sRGB if so asked; a picture for measuring is refused, and so is a coding that nobody here knows.
  EXPECT_NEAR(read_photograph(scratch.path("hlg.png"), PhotographEncoding::srgb).rgb[0], 0.5225, 1e-3);
  EXPECT_THROW(read_standard_png(scratch.path("hlg.png")), InputError);
  std::string bytes = read_whole_file(scratch.path("hlg.png"));
  bytes[bytes.find("cICP") + 4] = 12;  // Display P3
  std::ofstream(scratch.path("p3.png"), std::ios::binary) << bytes;
  EXPECT_THROW(read_photograph(scratch.path("p3.png")), InputError);
}

}  // namespace
}  // namespace petzval
