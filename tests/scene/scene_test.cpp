// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/colour/spectra_files.h>
#include <petzval/scene/scene.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

TEST(SceneGeometry, IsThatOfAPlane) {
  // At 60 degrees across, half the width is tan 30° of the distance; a square sample grid of 4:3 then spans
  // 2 atan(3/4 · tan 30°) and 2 atan(5/4 · tan 30°).
  const Scene scene(400, 300, {550}, 60, 2.0);
  EXPECT_NEAR(scene.tangent_per_sample(), 2 / std::sqrt(3.0) / 400, 1e-15);
  EXPECT_NEAR(scene.vertical_angle_deg(), degrees(2 * std::atan(0.75 / std::sqrt(3.0))), 1e-12);
  EXPECT_NEAR(scene.diagonal_angle_deg(), degrees(2 * std::atan(1.25 / std::sqrt(3.0))), 1e-12);
}

TEST(SceneGeometry, NonsenseIsRefused) {
  for (const double angle : {0.0, 180.0, -10.0, nan, inf}) {
    EXPECT_THROW(Scene(2, 2, {550}, angle, std::nullopt), InputError) << angle;
    EXPECT_THROW(Scene(2, 2, {550}, 10, 1.0).set_horizontal_angle_deg(angle), InputError) << angle;
  }
  for (const double distance : {0.0, -1.0, nan, inf})
    EXPECT_THROW(Scene(2, 2, {550}, 10, distance), InputError) << distance;
  EXPECT_THROW(Scene(0, 2, {550}, 10, 1.0), InputError);
  EXPECT_THROW(Scene(2, -1, {550}, 10, 1.0), InputError);
  for (const std::vector<double>& wavelengths :
       std::vector<std::vector<double>>{{}, {0}, {-5}, {nan}, {inf}, {500, 500}, {500, 400}})
    EXPECT_THROW(Scene(2, 2, wavelengths, 10, 1.0), InputError);
}

TEST(SceneGeometry, AbsurdSizesAreRefusedBeforeTheyAreAllocated) {
  EXPECT_THROW(Scene(2000000000, 2000000000, {550}, 10, 1.0), InputError);
  EXPECT_THROW(Scene(65536, 65536, {500, 600}, 10, 1.0), InputError);
}

TEST(SceneLuminance, OfOneWattAt555NanometresIs683) {
  // The definition of the candela: 683 lm/W at 555 nm (540 THz), where ȳ = 1; one sample stands for 1 nm.
  Scene scene(3, 2, {555}, 10, std::nullopt);
  std::ranges::fill(scene.band(0), 2.0f);
  EXPECT_NEAR(scene.mean_luminance_cd_m2(), 2 * 683, 1e-3 * 2 * 683);
}

TEST(SceneLuminance, OfEqualEnergyIsTheIntegralOfTheObserver) {
  // ∫ȳ dλ of the CIE 1931 observer is 106.8566 nm (CIE 15, sums of the 1 nm table). The bundled table ends at
  // 370 and 730 nm, beyond which there is less than 4e-4 of it.
  std::vector<double> wavelengths;
  for (int nm = 370; nm <= 730; ++nm) wavelengths.push_back(nm);
  Scene scene(2, 1, wavelengths, 10, std::nullopt);
  for (int band = 0; band < scene.bands(); ++band) {
    scene.band(band)[0] = 0.5f;
    scene.band(band)[1] = 1.5f;
  }
  EXPECT_NEAR(scene.mean_luminance_cd_m2() / (683 * 106.8566), 1, 4e-4);
}

TEST(SceneLuminance, ScalesAsOurOwnSumSays) {
  // Trapezoids over ȳ as tabulated, done here; 5 nm apart they are within 1e-3 of the exact integral of a
  // slope.
  std::vector<double> wavelengths;
  for (int nm = 380; nm <= 720; nm += 5) wavelengths.push_back(nm);
  Scene scene(4, 3, wavelengths, 10, std::nullopt);
  for (int band = 0; band < scene.bands(); ++band)
    for (std::size_t i = 0; i < scene.band_size(); ++i)
      scene.band(band)[i] = static_cast<float>(1e-3 * (band + 1) * static_cast<double>(i));
  scene.illuminant = Spectrum({400, 700}, {1, 2});
  const float before = scene.band(7)[5];
  scene.set_mean_luminance_cd_m2(250);
  const Spectrum y_bar = read_spectrum_set("cie_1931_xyz").find("y_bar");
  double luminance = 0;
  for (int band = 0; band < scene.bands(); ++band) {
    double mean = 0;
    for (const float value : scene.band(band)) mean += value / 12.0;
    luminance += 683 * mean * y_bar.at(380 + 5 * band) * 5;
  }
  EXPECT_NEAR(luminance, 250, 0.25);
  EXPECT_NEAR(scene.mean_luminance_cd_m2(), 250, 1e-4) << "single precision";
  EXPECT_NEAR(scene.illuminant->at(700) / 2, scene.band(7)[5] / before, 1e-6) << "the light is scaled alike";
}

TEST(SceneLuminance, CannotBeGivenToTheBlack) {
  Scene black(2, 2, {550}, 10, std::nullopt);
  EXPECT_THROW(black.set_mean_luminance_cd_m2(100), InputError);
  Scene infrared(2, 2, {950}, 10, std::nullopt);
  std::ranges::fill(infrared.band(0), 1.0f);
  EXPECT_THROW(infrared.set_mean_luminance_cd_m2(100), InputError);
  Scene green(2, 2, {550}, 10, std::nullopt);
  std::ranges::fill(green.band(0), 1.0f);
  for (const double bad : {0.0, -1.0, nan, inf})
    EXPECT_THROW(green.set_mean_luminance_cd_m2(bad), InputError);
}

TEST(SceneResampling, IsLinearAndKeepsWhatElseThereIs) {
  Scene scene(2, 1, {400, 500, 700}, 12, 3.0);
  for (int band = 0; band < 3; ++band) {
    scene.band(band)[0] = static_cast<float>(scene.wavelengths_nm()[static_cast<std::size_t>(band)]);
    scene.band(band)[1] = 1;
  }
  scene.name = "ramp";
  scene.depth_m = {1, 2};
  scene.illuminant = Spectrum({400, 700}, {1, 1});
  const Scene result = scene.resampled(std::vector<double>{400, 450, 500, 600, 650, 700});
  ASSERT_EQ(result.bands(), 6);
  for (int band = 0; band < 6; ++band) {
    // A straight line is reproduced, up to single precision at 700.
    EXPECT_NEAR(result.band(band)[0], result.wavelengths_nm()[static_cast<std::size_t>(band)], 1e-4);
    EXPECT_EQ(result.band(band)[1], 1);
  }
  EXPECT_EQ(result.name, "ramp");
  EXPECT_EQ(result.depth_m, scene.depth_m);
  EXPECT_EQ(result.distance_m(), 3.0);
  EXPECT_EQ(result.horizontal_angle_deg(), 12);
  EXPECT_TRUE(result.illuminant.has_value());
}

TEST(SceneResampling, DoesNotExtrapolate) {
  const Scene scene(2, 1, {400, 500}, 12, 3.0), single(2, 1, {587.5618}, 12, 3.0);
  EXPECT_THROW(scene.resampled(std::vector<double>{399}), InputError);
  EXPECT_THROW(scene.resampled(std::vector<double>{450, 501}), InputError);
  EXPECT_THROW(scene.resampled(std::vector<double>{nan}), InputError);
  EXPECT_THROW(scene.resampled(std::vector<double>{}), InputError);
  EXPECT_THROW(single.resampled(std::vector<double>{588}), InputError);
  EXPECT_EQ(single.resampled(std::vector<double>{587.5618}).bands(), 1);
}

TEST(SceneValidation, NamesTheFirstImpossibleRadiance) {
  for (const double bad : {nan, inf, -inf, -1e-6}) {
    Scene scene(4, 3, {500, 600}, 12, 3.0);
    EXPECT_NO_THROW(scene.validate());
    scene.band(1)[9] = static_cast<float>(bad);
    try {
      scene.validate();
      FAIL() << bad;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("600 nm at row 2, column 1"), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace petzval
