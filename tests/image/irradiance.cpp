// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/image/formats/irradiance.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/spectral_exr.h>

#include <cmath>

#include "scratch.h"

namespace petzval {
namespace {

SpectralImage example() {
  SpectralImage image(4, 3, {450, 550.5}, 6.25, PixelAperture::point);
  for (int band = 0; band < 2; ++band)
    for (std::size_t i = 0; i < image.band_size(); ++i)
      image.band(band)[i] = 1e-3f * static_cast<float>(i) + static_cast<float>(band);
  image.provenance = "a lens and a scene";
  return image;
}

std::string message_of(const std::string& path) {
  try {
    read_irradiance(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Irradiance, RoundTripsThroughExrWithAllThatBelongsToIt) {
  const test::Scratch scratch;
  const SpectralImage image = example();
  write_irradiance(scratch.path("a.EXR"), image);
  const SpectralImage back = read_irradiance(scratch.path("a.EXR"));
  EXPECT_EQ(back.columns(), 4);
  EXPECT_EQ(back.rows(), 3);
  EXPECT_EQ(back.wavelengths_nm(), image.wavelengths_nm());
  EXPECT_EQ(back.pitch_um(), 6.25);
  EXPECT_EQ(back.pixel_aperture(), PixelAperture::point);
  EXPECT_EQ(back.provenance, image.provenance);
  EXPECT_TRUE(std::equal(back.values().begin(), back.values().end(), image.values().begin()));
  EXPECT_EQ(read_spectral_exr(scratch.path("a.EXR")).units, "W.m^-2.nm^-1");
}

TEST(Irradiance, NpyIsWrittenButCannotBeReadForWantOfUnits) {
  const test::Scratch scratch;
  write_irradiance(scratch.path("a.npy"), example());
  EXPECT_EQ(read_npy(scratch.path("a.npy")).shape, (std::vector<std::size_t>{3, 4, 2}));
  EXPECT_NE(message_of(scratch.path("a.npy")).find(".exr"), std::string::npos);
  EXPECT_THROW(write_irradiance(scratch.path("a.tiff"), example()), InputError);
}

TEST(Irradiance, CarriesLensLightAndPhotosite) {
  const test::Scratch scratch;
  SpectralImage image(2, 1, {450, 550}, 5, PixelAperture::photosite);
  image.photosite = "ellipse 0.7 x 0.7 pitches";
  image.lens = LensFacts{"a lens", 50, 2.8, -60};
  image.illuminant = Spectrum({400, 700}, {0.1, 0.3});
  write_irradiance(scratch.path("a.exr"), image);
  const SpectralImage back = read_irradiance(scratch.path("a.exr"));
  EXPECT_EQ(back.pixel_aperture(), PixelAperture::photosite);
  EXPECT_EQ(back.photosite, image.photosite);
  ASSERT_TRUE(back.lens && back.illuminant);
  EXPECT_EQ(back.lens->name, "a lens");
  EXPECT_EQ(back.lens->focal_length_mm, 50);
  EXPECT_EQ(back.lens->f_number, 2.8);
  EXPECT_EQ(back.lens->exit_pupil_mm, -60);
  EXPECT_EQ(back.illuminant->values(), image.illuminant->values());
}

TEST(Irradiance, IsNotConfusedWithAnythingElse) {
  const test::Scratch scratch;
  write_irradiance(scratch.path("a.exr"), example());
  const SpectralExr good = read_spectral_exr(scratch.path("a.exr"));
  const auto message_for = [&](const SpectralExr& exr) {
    write_spectral_exr(scratch.path("b.exr"), exr);
    return message_of(scratch.path("b.exr"));
  };
  EXPECT_EQ(message_for(good), "no error");
  SpectralExr exr = good;
  exr.units = spectral_radiance_units;
  EXPECT_NE(message_for(exr).find("sr^-1"), std::string::npos);
  exr = good;
  exr.kind = SpectralExr::Kind::reflective;
  EXPECT_NE(message_for(exr).find("reflectance"), std::string::npos);
  exr = good;
  exr.numbers.erase("pixelPitch_um");
  EXPECT_NE(message_for(exr).find("pitch"), std::string::npos);
  exr.numbers["pixelPitch_um"] = -1;
  EXPECT_NE(message_for(exr).find("positive"), std::string::npos);
  exr = good;
  exr.strings["pixelAperture"] = "round";
  EXPECT_NE(message_for(exr).find("pixelAperture"), std::string::npos);
  exr = good;
  exr.values.all()[5] = INFINITY;
  EXPECT_NE(message_for(exr).find("row 1, column 1"), std::string::npos);
}

}  // namespace
}  // namespace petzval
