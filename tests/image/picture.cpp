// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/whole_file.h>
#include <petzval/colour/colour_map.h>
#include <petzval/colour/illuminants.h>
#include <petzval/image/picture.h>

#include <array>
#include <cmath>

#include "scratch.h"

namespace petzval {
namespace {

std::vector<double> bands_of_31() {
  std::vector<double> bands;
  for (double nm = 400; nm <= 700; nm += 10) bands.push_back(nm);
  return bands;
}

/// A ramp in the light of an illuminant: pixel i of n has the reflectance (i + 1)/n.
SpectralImage ramp(const Spectrum& light, int columns = 20, int rows = 5,
                   std::vector<double> bands = bands_of_31()) {
  SpectralImage image(columns, rows, std::move(bands), 5);
  for (int band = 0; band < image.bands(); ++band)
    for (std::size_t i = 0; i < image.band_size(); ++i)
      image.band(band)[i] =
          static_cast<float>(light.at(image.wavelengths_nm()[static_cast<std::size_t>(band)]) *
                             static_cast<double>(i + 1) / static_cast<double>(image.band_size()));
  return image;
}

std::array<int, 3> pixel(const PngImage& picture, std::size_t index) {
  return {picture.samples[3 * index], picture.samples[3 * index + 1], picture.samples[3 * index + 2]};
}

TEST(Picture, WhiteIsThePercentileOfTheLevels) {
  const SpectralImage image = ramp(illuminant("D65"));  // 100 levels, 1 % to 100 %
  PictureOptions options;
  options.percentile = 80;
  const PictureRenderer renderer(image, options);
  std::vector<LinearRgb> row(20);
  renderer.linear_row(3, row);      // ends with the 80th pixel
  EXPECT_NEAR(row[19].g, 1, 0.02);  // green: little moved by the bands that are cut off at 400 and 700 nm
  const Spectrum light = illuminant("D65");
  std::vector<double> sampled;
  for (const double nm : image.wavelengths_nm()) sampled.push_back(light.at(nm));
  const double lux = 0.8 * luminance(Spectrum(image.wavelengths_nm(), sampled));
  EXPECT_NEAR(renderer.white_level(), lux, 1e-6 * lux);  // float pixels
}

// Values of a picture are even in the logarithm: a third of the way up for each decade. The square root of a
// level is what a display shows of it under `gamma`, and white stays white.
TEST(Picture, LightsMayBeShownByRootOrLogarithm) {
  SpectralImage image(5, 1, {550}, 10);
  const std::vector<float> values{1, 0.1F, 0.01F, 0.001F, 0};
  std::copy(values.begin(), values.end(), image.band(0).begin());
  PictureOptions options;
  options.percentile = 100;
  options.display = PictureOptions::Display::log;
  const PngImage decades = srgb_picture(image, options);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(pixel(decades, i)[1], i < 4 ? 255 - 85 * static_cast<int>(i) : 0, 1) << i;
  options.display = PictureOptions::Display::gamma;
  const PictureRenderer renderer(image, options);
  std::vector<LinearRgb> row(5);
  renderer.linear_row(0, row);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(row[i].g, std::sqrt(static_cast<double>(values[i])), 1e-6) << i;
  EXPECT_NE(renderer.description().find("square roots"), std::string::npos);
}

// Stars fill a twentieth of the picture: white goes by them. With a dim ground, or more of it lit, by all.
TEST(Picture, LightsInDarknessAreMeteredByThemselves) {
  const auto level = [](float ground, int stars, double dark_share = 1e-5) {
    SpectralImage image(20, 20, {550}, 10);
    std::vector<float> values(400, ground);
    for (int i = 0; i < stars; ++i) values[static_cast<std::size_t>(i)] = static_cast<float>(1 + i % 20);
    image.store_band(0, values);
    PictureOptions options;
    options.percentile = 50;
    options.dark_share = dark_share;
    return PictureRenderer(image, options).white_level();
  };
  const double of_all = level(1, 0);  // one unit of light everywhere
  EXPECT_NEAR(level(0, 20) / of_all, 10, 1e-6);
  EXPECT_NEAR(level(1e-4F, 20) / of_all, 10, 1e-6);  // within 10⁻⁵ of the brightest
  EXPECT_NEAR(level(1e-2F, 20) / of_all, 1e-2, 1e-8);
  EXPECT_NEAR(level(1e-2F, 20, 1e-3) / of_all, 10, 1e-6);  // a sky that is known to be one
  EXPECT_NEAR(level(1e-2F, 300) / of_all, 7, 1.01);
}

TEST(Picture, WithTheSceneWhiteGreysAreNeutralUnderAnyLampOnAnyBands) {
  for (const char* name : {"D65", "A", "F11"})
    for (const std::vector<double>& bands : {bands_of_31(), std::vector<double>{450, 550, 650}}) {
      const SpectralImage image = ramp(illuminant(name), 20, 5, bands);
      PictureOptions options;
      options.percentile = 100;
      options.scene_white = illuminant(name);
      const PngImage picture = srgb_picture(image, options);
      for (std::size_t i = 0; i < image.band_size(); ++i) {
        const auto [r, g, b] = pixel(picture, i);
        // The sRGB curve, independently: reflectance to code value. Rounding may differ by one code.
        const int want = static_cast<int>(std::lround(255 * srgb_encoded(static_cast<double>(i + 1) / 100)));
        EXPECT_NEAR(r, want, 1) << name << ' ' << i;
        EXPECT_NEAR(g, want, 1) << name << ' ' << i;
        EXPECT_NEAR(b, want, 1) << name << ' ' << i;
      }
    }
}

TEST(Picture, WithoutASceneWhiteALampKeepsItsColour) {
  PictureOptions options;
  options.percentile = 100;
  const auto [r, g, b] = pixel(srgb_picture(ramp(illuminant("A")), options), 49);
  EXPECT_GT(r, g);
  EXPECT_GT(g, b);
}

TEST(Picture, MeanGreyAndAFixedLevelAreKept) {
  const SpectralImage image = ramp(illuminant("D65"));
  PictureOptions options;
  options.exposure = PictureOptions::Exposure::mean_grey;
  const PictureRenderer grey(image, options);
  double mean = 0;
  for (int row = 0; row < 5; ++row) {
    std::vector<LinearRgb> pixels(20);
    grey.linear_row(row, pixels);
    for (const LinearRgb& p : pixels) mean += xyz_of(p).y / 100;
  }
  EXPECT_NEAR(mean, 0.18, 1e-6);  // float levels

  options.exposure = PictureOptions::Exposure::fixed;
  options.white_level = 2 * grey.white_level();
  EXPECT_EQ(PictureRenderer(image, options).white_level(), 2 * grey.white_level());
}

TEST(Picture, FewBrightPointsOnBlackAreNotLost) {
  SpectralImage image(100, 100, {550}, 5);
  image.at(0, 50, 50) = 3;  // one pixel in 10,000: the 99.5th percentile is black
  const PngImage picture = srgb_picture(image);
  EXPECT_EQ(pixel(picture, 50 * 100 + 50), (std::array<int, 3>{255, 255, 255}));
  EXPECT_EQ(pixel(picture, 0), (std::array<int, 3>{0, 0, 0}));
}

TEST(Picture, ASingleWavelengthIsGreyUnlessAskedForInColour) {
  SpectralImage image(2, 1, {589}, 5);
  image.at(0, 0, 0) = 1, image.at(0, 0, 1) = 0.5f;
  PictureOptions options;
  options.percentile = 100;
  const PngImage grey = srgb_picture(image, options);
  EXPECT_EQ(pixel(grey, 0), (std::array<int, 3>{255, 255, 255}));
  EXPECT_EQ(pixel(grey, 1), (std::array<int, 3>{188, 188, 188}));  // half the light
  options.monochrome_in_colour = true;
  const auto [r, g, b] = pixel(srgb_picture(image, options), 1);
  EXPECT_GT(r, g);  // sodium yellow lies outside sRGB on the side of no blue
  EXPECT_GT(g, 100);
  EXPECT_EQ(b, 0);
}

TEST(Picture, InfraredIsShownInGreyByItsIrradiance) {
  SpectralImage image(2, 1, {850, 950}, 5);
  image.at(0, 0, 0) = 2, image.at(1, 0, 1) = 1;
  PictureOptions options;
  options.percentile = 100;
  const PictureRenderer renderer(image, options);
  EXPECT_DOUBLE_EQ(renderer.white_level(), 100);  // W/m²: 2 · 50 nm
  const PngImage picture = srgb_picture(image, options);
  EXPECT_EQ(pixel(picture, 0), (std::array<int, 3>{255, 255, 255}));
  EXPECT_EQ(pixel(picture, 1), (std::array<int, 3>{188, 188, 188}));
}

TEST(Picture, BlackIsBlack) {
  const PngImage picture = srgb_picture(SpectralImage(3, 2, {450, 550}, 5));
  EXPECT_EQ(picture.samples, std::vector<std::uint16_t>(18, 0));
  EXPECT_EQ(picture.text.at("Exposure"), "no light");
}

TEST(Picture, IsTheSameWhetherStreamedOrNotAndForAnyNumberOfThreads) {
  const test::Scratch scratch;
  SpectralImage image = ramp(illuminant("A"), 37, 41);
  image.provenance = "a ramp";
  std::vector<std::string> bytes;
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    write_picture(scratch.path("a.png"), image, {}, 16);
    bytes.push_back(read_whole_file(scratch.path("a.png")));
    EXPECT_EQ(bytes.back(), bytes.front());
    EXPECT_EQ(read_png(scratch.path("a.png")).samples, srgb_picture(image, {}, 16).samples);
  }
  EXPECT_EQ(read_png(scratch.path("a.png")).text.at("Description"), "a ramp");
}

TEST(Picture, RefusesNanAndSenselessOptions) {
  SpectralImage image = ramp(illuminant("D65"));
  PictureOptions options;
  options.percentile = 0;
  EXPECT_THROW(srgb_picture(image, options), InputError);
  options = {};
  options.exposure = PictureOptions::Exposure::fixed;
  EXPECT_THROW(srgb_picture(image, options), InputError);
  options = {};
  options.exposure = PictureOptions::Exposure::mean_grey;
  options.grey = std::nan("");
  EXPECT_THROW(srgb_picture(image, options), InputError);
  options = {};
  options.scene_white = Spectrum({1000, 1100}, {1, 1});
  EXPECT_THROW(srgb_picture(image, options), InputError);
  EXPECT_THROW(srgb_picture(image, {}, 12), InputError);
  image.at(3, 2, 1) = std::nanf("");
  EXPECT_THROW(srgb_picture(image), InputError);
}

TEST(Picture, WarmthIsShownInFalseColours) {
  SpectralImage image(5, 1, {9000, 10000, 11000}, 10);
  const float levels[] = {4, 4.25f, 4.5f, 4.75f, 5};
  for (int band = 0; band < 3; ++band) std::copy(levels, levels + 5, image.band(band).begin());
  PictureOptions options;
  options.percentile = 100;
  options.false_colour = true;
  const PngImage picture = srgb_picture(image, options);
  const std::array<Rgb8, 256> map = colour_table(ColourMap::inferno);
  for (std::size_t i = 0; i < 5; ++i) {
    // The darkest pixel is the map's first colour, the brightest its last, those between at even places.
    const Rgb8 colour = map[(255 * i + 2) / 4];
    EXPECT_EQ(picture.samples[3 * i], colour.r) << i;
    EXPECT_EQ(picture.samples[3 * i + 1], colour.g) << i;
    EXPECT_EQ(picture.samples[3 * i + 2], colour.b) << i;
  }
  // 2000 nm wide: 4 and 5 W/m2/nm are 8000 and 10000 W/m2.
  EXPECT_EQ(PictureRenderer(image, options).description(),
            "false colours from 8000 to 1e+04 W/m2, the 100th percentile");
  // Visible light is not touched.
  SpectralImage visible(1, 1, {500, 550, 600}, 10);
  for (int band = 0; band < 3; ++band) visible.band(band)[0] = 1;
  PictureOptions plain;
  plain.percentile = 100;
  EXPECT_EQ(srgb_picture(visible, options).samples, srgb_picture(visible, plain).samples);
}

}  // namespace
}  // namespace petzval
