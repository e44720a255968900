// SPDX-License-Identifier: BSD-3-Clause
// What is assumed of a scene's file, or looks like a mistake, is said.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/image/formats/npy.h>
#include <petzval/scene/scene_file.h>

#include <string>
#include <vector>

#include "scratch.h"

namespace petzval {
namespace {

bool has_note(const std::vector<std::string>& notes, const std::string& words) {
  for (const std::string& note : notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

class SceneNotes : public ::testing::Test {
 protected:
  /// A scene of 2 x 2 samples in one band, of which one has this value and the others are small.
  Scene scene_of_one(float value, SceneQuantity quantity, SceneOptions options = {}) const {
    const std::string path = scratch_.path("one.npy");
    write_npy(path, std::vector<std::size_t>{2, 2, 1}, std::vector<float>{0.1F, value, 0.2F, 0.1F});
    options.quantity = quantity;
    options.horizontal_angle_deg = 20;
    if (quantity == SceneQuantity::temperature)
      options.wavelengths_nm = {9000, 11000};
    else
      options.file_bands_nm = {550};
    if (quantity == SceneQuantity::reflectance) options.illuminant = "D65";
    return read_scene(path, options);
  }

  std::string refusal_of(float value, const SceneOptions& options = {}) const {
    try {
      scene_of_one(value, SceneQuantity::reflectance, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

  test::Scratch scratch_;
};

TEST_F(SceneNotes, ReflectancesInPerCentOrCountsAreRefused) {
  EXPECT_EQ(refusal_of(1), "");
  EXPECT_EQ(refusal_of(2), "");
  EXPECT_NE(refusal_of(80).find("up to 80"), std::string::npos) << refusal_of(80);
  EXPECT_NE(refusal_of(80).find("`scene.scale` 0.01 "), std::string::npos) << refusal_of(80);
  EXPECT_NE(refusal_of(3).find("`scene.scale` 0.01 "), std::string::npos) << "3 % is a dark thing";
  EXPECT_NE(refusal_of(8000).find("`scene.scale` 0.0001 "), std::string::npos) << refusal_of(8000);
  // What is proposed is right, whatever the numbers are multiplied by already.
  SceneOptions options;
  options.scale = 0.5;
  EXPECT_NE(refusal_of(80, options).find("`scene.scale` 0.005 "), std::string::npos)
      << refusal_of(80, options);
  options.scale = 0.01;
  EXPECT_EQ(refusal_of(80, options), "");
}

TEST_F(SceneNotes, ReflectancesAboveOneAreNoted) {
  EXPECT_FALSE(has_note(scene_of_one(1.15F, SceneQuantity::reflectance).notes, "per cent"));
  EXPECT_TRUE(has_note(scene_of_one(1.4F, SceneQuantity::reflectance).notes, "up to 1.4"));
}

TEST_F(SceneNotes, TheLevelOfReflectancesIsSaidWhereItIsMadeUp) {
  const Scene lit = scene_of_one(0.8F, SceneQuantity::reflectance);
  EXPECT_TRUE(has_note(lit.notes, "mean luminance of 100 cd/m2"));
  EXPECT_NEAR(lit.mean_luminance_cd_m2(), 100, 1e-4);  // single precision
  SceneOptions options;
  options.mean_luminance_cd_m2 = 30;
  const Scene told = scene_of_one(0.8F, SceneQuantity::reflectance, options);
  EXPECT_FALSE(has_note(told.notes, "mean luminance"));
  EXPECT_NEAR(told.mean_luminance_cd_m2(), 30, 1e-4);
}

TEST_F(SceneNotes, AUnitThatNobodySaidIsSaid) {
  EXPECT_TRUE(has_note(scene_of_one(1, SceneQuantity::radiance).notes, "`scene.radiance_unit`"));
  SceneOptions options;
  options.radiance_unit = "W/m2/sr/nm";
  EXPECT_FALSE(has_note(scene_of_one(1, SceneQuantity::radiance, options).notes, "`scene.radiance_unit`"));
}

TEST_F(SceneNotes, TemperaturesInDegreesCelsiusAreNoted) {
  EXPECT_TRUE(has_note(scene_of_one(37, SceneQuantity::temperature).notes, "37 K"));
  EXPECT_TRUE(scene_of_one(310, SceneQuantity::temperature).notes.empty());
}

TEST_F(SceneNotes, OptionsOfTheOtherKindOfWarmSceneAreRefused) {
  SceneOptions options;
  options.thermal.temperature_k = 300;
  EXPECT_THROW(scene_of_one(310, SceneQuantity::temperature, options), InputError);
  EXPECT_NO_THROW(scene_of_one(0.5F, SceneQuantity::emissivity, options));
  options.thermal.emissivity = 0.9;
  EXPECT_THROW(scene_of_one(0.5F, SceneQuantity::emissivity, options), InputError);
}

/// Charts are lit by D65, from 300 to 830 nm; F11 is known from 380 to 780.
TEST_F(SceneNotes, BandsBeyondTheIlluminantAreNamed) {
  SceneOptions options;
  options.wavelengths_nm = {300, 500, 600, 830};
  Scene lit = read_scene("wall", options);
  EXPECT_TRUE(lit.notes.empty());
  EXPECT_GT(lit.band(0)[0], 0);
  EXPECT_GT(lit.band(3)[0], 0);
  options.wavelengths_nm = {350, 380, 600, 780, 830, 840, 850};
  EXPECT_TRUE(has_note(read_scene("wall", options).notes, "no light reaches 840 to 850 nm"));
  options.illuminant = "F11";
  EXPECT_TRUE(has_note(read_scene("wall", options).notes, "no light reaches 350, 830 to 850 nm"));
}

/// The patches of the ColorChecker were measured from 380 to 1068 nm.
TEST_F(SceneNotes, BandsBeyondMeasuredReflectancesAreNamed) {
  SceneOptions options;
  options.wavelengths_nm = {340, 360, 380, 400, 600, 830};
  for (const char* chart : {"colorchecker", "studio"})
    EXPECT_TRUE(has_note(read_scene(chart, options).notes, "measured from 380 to 1068 nm; at 340 to 360 nm"));
  for (const char* chart : {"wall", "checkerboard", "slanted-edge"})
    EXPECT_TRUE(read_scene(chart, options).notes.empty()) << chart;
  options.wavelengths_nm = {380, 830};
  EXPECT_TRUE(read_scene("colorchecker", options).notes.empty());
  options.illuminant = "F11";  // where it is dark, reflectances are of no account
  options.wavelengths_nm = {360, 500};
  EXPECT_FALSE(has_note(read_scene("colorchecker", options).notes, "measured"));
}

}  // namespace
}  // namespace petzval
