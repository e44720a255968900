// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/report/colours.h>
#include <petzval/report/data_uri.h>
#include <petzval/report/heat_map.h>
#include <petzval/report/psf_drawing.h>
#include <png.h>

#include <cmath>

#include "report/markup_checker.h"

namespace petzval {
namespace {

std::vector<Rgb8> decode(const std::string& png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, png.data(), png.size()), 0) << image.message;
  image.format = PNG_FORMAT_RGB;
  std::vector<Rgb8> pixels(std::size_t{image.width} * image.height);
  EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0) << image.message;
  return pixels;
}

TEST(Base64, TestVectorsOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfb"), "//77");
}

TEST(EncodePng, SurvivesDecoding) {
  const std::vector<Rgb8> pixels{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  const std::string png = encode_png(pixels, 3, 2);
  EXPECT_EQ(decode(png), pixels);
  EXPECT_EQ(png_size(png).columns, 3);
  EXPECT_EQ(png_size(png).rows, 2);
  EXPECT_EQ(png, encode_png(pixels, 3, 2));
  EXPECT_THROW(encode_png(pixels, 2, 2), InputError);
  EXPECT_THROW(encode_png({}, 0, 0), InputError);
  EXPECT_THROW(png_size("GIF89a"), InputError);
}

TEST(HeatMap, ShowsValuesWhereTheyAre) {
  const std::vector<float> values{0, 1, 2, NAN, 4, 2};
  const std::vector<Rgb8> pixels = decode(heat_map_png(values, 3, 2, {.map = ColourMap::grey}));
  const std::vector<Rgb8> expected{{0, 0, 0},       {64, 64, 64},    {128, 128, 128},
                                   {128, 128, 128}, {255, 255, 255}, {128, 128, 128}};
  EXPECT_EQ(pixels, expected);
  const std::vector<Rgb8> flipped =
      decode(heat_map_png(values, 3, 2, {.map = ColourMap::grey, .first_row_on_top = false}));
  EXPECT_EQ(flipped[1], (Rgb8{255, 255, 255}));
  EXPECT_EQ(flipped[3], (Rgb8{0, 0, 0}));
}

TEST(HeatMap, GammaLiftsTheFaint) {
  const std::vector<float> values{0.25F, 1};
  EXPECT_EQ(decode(heat_map_png(values, 2, 1, {.map = ColourMap::grey, .gamma = 2}))[0],
            (Rgb8{128, 128, 128}));
  EXPECT_THROW(heat_map_png(values, 2, 1, {.gamma = 0}), InputError);
  EXPECT_THROW(heat_map_png(values, 2, 2), InputError);
}

TEST(HeatMap, FlatMatricesAreNoHarm) {
  for (const float value : {0.0F, -1.0F, 3.0F, static_cast<float>(INFINITY)})
    EXPECT_EQ(decode(heat_map_png(std::vector<float>(4, value), 2, 2)).size(), 4u);
}

// Rec. 709 luma: what a grey printer makes of a colour.
double luma(Rgb8 c) {
  return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
}

TEST(ColourTable, GrowsInLightness) {
  for (const ColourMap map : {ColourMap::grey, ColourMap::viridis, ColourMap::inferno}) {
    const auto table = colour_table(map);
    // Half a level: the rounding of three 8-bit channels between anchors.
    for (std::size_t i = 1; i < table.size(); ++i) EXPECT_GT(luma(table[i]), luma(table[i - 1]) - 0.5) << i;
    EXPECT_GT(luma(table.back()) - luma(table.front()), 150);
  }
}

TEST(WavelengthColour, FollowsTheSpectrum) {
  const Rgb8 blue = wavelength_colour(460), green = wavelength_colour(546), red = wavelength_colour(650);
  EXPECT_TRUE(blue.b > blue.r && blue.b > blue.g);
  EXPECT_TRUE(green.g > green.r && green.g > green.b);
  EXPECT_TRUE(red.r > red.g && red.r > red.b);
  EXPECT_EQ(wavelength_colour(200), wavelength_colour(380));
  EXPECT_EQ(wavelength_colour(1550), wavelength_colour(780));
  EXPECT_EQ(wavelength_colour(NAN).hex(), "#7f7f7f");
  EXPECT_EQ(wavelength_colour(486).hex(), "#1f78d1");
}

/// A square of 5 × 5 equal samples in a window of 33: 99 % of it is in the fifth ring from the middle.
Psf square_of_light() {
  Psf psf{33, 2, std::vector<float>(33 * 33), 1};
  for (int i = 14; i <= 18; ++i)
    for (int j = 14; j <= 18; ++j) psf.values[static_cast<std::size_t>(33 * i + j)] = 1.0F / 25;
  return psf;
}

TEST(PsfDrawing, IsCutToWhatHoldsTheLight) {
  const Psf psf = square_of_light();
  EXPECT_DOUBLE_EQ(half_width_holding_um(psf), 5);            // 2.5 samples of 2 µm
  EXPECT_DOUBLE_EQ(half_width_holding_um(psf, 9.0 / 25), 3);  // the inner 3 × 3
  EXPECT_DOUBLE_EQ(half_width_holding_um(psf, 0.01), 1);
  const std::string strip = psf_strip_svg({{psf, "0 mm"}, {psf, "1 mm"}}, 1);
  EXPECT_EQ(test::markup_fault(strip), "");
  EXPECT_EQ(test::occurrences(strip, "<image "), 2);
  EXPECT_THROW(psf_strip_svg({}, 1), InputError);
}

TEST(PsfDrawing, MapsPlacesOfAFrame) {
  std::vector<PsfPlace> places = even_places(8, 6, 4);
  ASSERT_EQ(places.size(), 12u);
  EXPECT_DOUBLE_EQ(places[0].x_mm, -3);
  EXPECT_DOUBLE_EQ(places[0].y_mm, 2);
  EXPECT_DOUBLE_EQ(places[11].x_mm, 3);
  EXPECT_DOUBLE_EQ(places[11].y_mm, -2);
  EXPECT_THROW(psf_map_svg(places, 4, 8, "dark"), InputError);
  for (PsfPlace& place : places) place.light = {{square_of_light(), 550, 0}};
  const std::string map = psf_map_svg(places, 4, 8, "stars & light");
  EXPECT_EQ(test::markup_fault(map), "");
  EXPECT_EQ(test::occurrences(map, "<image "), 12);
  EXPECT_NE(map.find("5 µm"), std::string::npos);
  EXPECT_NE(map.find("200 times"), std::string::npos);  // a cell of 2 mm shows 10 µm
}

TEST(ImageStrip, HoldsEveryFrame) {
  const std::string png = heat_map_png(std::vector<float>{1, 2, 3, 4}, 2, 2);
  const std::vector<StripFrame> frames{{png, "0 mm\n< axis"}, {png, "1 mm"}, {png, ""}};
  const std::string svg =
      image_strip_svg(frames, {.frames_per_row = 2, .frame_width = 32, .unit = "µm"}, "PSFs");
  EXPECT_EQ(test::markup_fault(svg), "");
  EXPECT_EQ(test::occurrences(svg, "<image "), 3);
  EXPECT_EQ(test::occurrences(svg, "10 µm"), 1);
  EXPECT_NE(svg.find("&lt; axis"), std::string::npos);
  EXPECT_EQ(test::markup_fault(image_strip_svg({}, {}, "none")), "");
}

}  // namespace
}  // namespace petzval
