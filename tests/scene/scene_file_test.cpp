// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/spectral_exr.h>
#include <petzval/scene/formats/scene_exr.h>
#include <petzval/scene/scene_file.h>
#include <petzval/scene/wavelength_list.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/hostile.h"
#include "iset_fixture.h"

namespace petzval {
namespace {

using namespace test;

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string refusal(const std::string& scene, const SceneOptions& options = {}) {
  try {
    read_scene(scene, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

Scene ramp() {
  Scene scene(3, 2, {450, 587.5618}, 25, 1.25);
  for (int band = 0; band < 2; ++band)
    for (std::size_t i = 0; i < 6; ++i)
      scene.band(band)[i] = static_cast<float>(0.1 + 10.0 * band + static_cast<double>(i));
  scene.name = "ramp";
  scene.illuminant = Spectrum({400, 450.5, 700}, {0.1, 1.0 / 3, 12});
  return scene;
}

SpectralExr reflectances() {
  SpectralExr exr;
  exr.width = 2, exr.height = 1;
  exr.kind = SpectralExr::Kind::reflective;
  exr.wavelengths_nm = {500, 550, 600};
  exr.values = LargeFloats(std::vector<float>{0.5f, 1, 0.5f, 1, 0.25f, 1});
  return exr;
}

TEST(SceneExr, ComesBackAsItWent) {
  const Scratch scratch;
  const Scene scene = ramp();
  write_scene_exr(scratch.path("ramp.exr"), scene);
  const Scene back = read_scene(scratch.path("ramp.exr"));
  EXPECT_TRUE(std::ranges::equal(back.values(), scene.values()));
  EXPECT_EQ(back.wavelengths_nm(), scene.wavelengths_nm());
  EXPECT_EQ(back.horizontal_angle_deg(), 25);
  EXPECT_EQ(back.distance_m(), 1.25);
  EXPECT_EQ(back.name, "ramp");
  EXPECT_EQ(back.illuminant->wavelengths_nm(), scene.illuminant->wavelengths_nm());
  EXPECT_EQ(back.illuminant->values(), scene.illuminant->values());
}

TEST(SceneExr, PanoramaComesBackAsOne) {
  const Scratch scratch;
  Scene scene(4, 2, {450, 550}, 25, std::nullopt);
  scene.make_panorama({30, -12.5});
  write_scene_exr(scratch.path("all.exr"), scene);
  const Scene back = read_scene(scratch.path("all.exr"));
  ASSERT_TRUE(back.is_panorama());
  EXPECT_EQ(back.view().yaw_deg, 30);
  EXPECT_EQ(back.view().pitch_deg, -12.5);
  EXPECT_EQ(back.horizontal_angle_deg(), 360);
  SceneOptions options;
  options.panorama = PanoramaView{5, 0};
  EXPECT_EQ(read_scene(scratch.path("all.exr"), options).view().yaw_deg, 5);
  options.horizontal_angle_deg = 40;
  EXPECT_TRUE(says(refusal(scratch.path("all.exr"), options), "`scene.horizontal_angle_deg`"));
  options = {};
  options.distance_m = 3;
  EXPECT_TRUE(says(refusal(scratch.path("all.exr"), options), "infinity"));
}

TEST(SceneExr, SceneAtInfinityComesBackFromThere) {
  const Scratch scratch;
  Scene scene = ramp();
  scene.set_distance_m(std::nullopt);
  scene.illuminant.reset();
  write_scene_exr(scratch.path("ramp.exr"), scene);
  const Scene back = read_scene(scratch.path("ramp.exr"));
  EXPECT_FALSE(back.distance_m().has_value());
  EXPECT_FALSE(back.illuminant.has_value());
}

TEST(SceneExr, FilesOfOtherProgramsNeedAnAngle) {
  const Scratch scratch;
  SpectralExr exr = reflectances();
  exr.kind = SpectralExr::Kind::emissive;
  for (const char* units : {"W.m^-2.sr^-1.nm^-1", "W.m^-2.sr^-1", ""}) {
    exr.units = units;
    write_spectral_exr(scratch.path("other.exr"), exr);
    EXPECT_TRUE(says(refusal(scratch.path("other.exr")), "`scene.horizontal_angle_deg`"));
    SceneOptions options;
    options.horizontal_angle_deg = 20;
    const Scene scene = read_scene(scratch.path("other.exr"), options);
    EXPECT_EQ(scene.band(2)[0], 0.25f);
    EXPECT_EQ(scene.name, "other");
  }
}

TEST(SceneExr, IrradianceIsNoScene) {
  const Scratch scratch;
  SpectralExr exr = reflectances();
  exr.kind = SpectralExr::Kind::emissive;
  exr.units = spectral_irradiance_units;
  write_spectral_exr(scratch.path("sensor.exr"), exr);
  SceneOptions options;
  options.horizontal_angle_deg = 20;
  EXPECT_TRUE(says(refusal(scratch.path("sensor.exr"), options), " (irradiance); a scene is radiance"));
}

TEST(SceneExr, ReflectancesNeedLight) {
  const Scratch scratch;
  write_spectral_exr(scratch.path("chart.exr"), reflectances());
  SceneOptions options;
  options.horizontal_angle_deg = 20;
  EXPECT_TRUE(says(refusal(scratch.path("chart.exr"), options), "`scene.illuminant`"));
  options.illuminant = "E";
  const Scene scene = read_scene(scratch.path("chart.exr"), options);
  EXPECT_NEAR(scene.mean_luminance_cd_m2(), 100, 1e-4);
  EXPECT_NEAR(scene.band(2)[0] / scene.band(2)[1], 0.25, 1e-6);
  EXPECT_NEAR(scene.band(2)[1] / scene.illuminant->at(600), 1, 1e-6) << "a reflectance of 1";
}

TEST(SceneExr, RadianceHasItsLightAlready) {
  const Scratch scratch;
  Scene scene = ramp();
  scene.illuminant.reset();
  write_scene_exr(scratch.path("ramp.exr"), scene);
  SceneOptions options;
  options.illuminant = "A";
  EXPECT_TRUE(says(refusal(scratch.path("ramp.exr"), options), "`scene.illuminant`"));
}

TEST(SceneExr, ImpossibleValuesAreNamed) {
  const Scratch scratch;
  for (const float bad :
       {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Scene scene = ramp();
    scene.band(1)[4] = bad;
    write_scene_exr(scratch.path("bad.exr"), scene);
    const std::string message = refusal(scratch.path("bad.exr"));
    EXPECT_TRUE(says(message, "bad.exr") && says(message, "row 1, column 1")) << message;
  }
}

TEST(SceneExr, BadAttributesAreRefused) {
  const Scratch scratch;
  SpectralExr exr = reflectances();
  exr.kind = SpectralExr::Kind::emissive;
  exr.numbers["sceneAngle_deg"] = 20;
  for (const char* text :
       {"x", "400", "400:", "400:1,500:2", "400:1 400:2", "400:1 ", ":", "400:nan", "500:1 400:1"}) {
    exr.strings["sceneIlluminant"] = text;
    write_spectral_exr(scratch.path("bad.exr"), exr);
    if (std::string(text) == "400:1 ") continue;  // a trailing blank does no harm
    EXPECT_TRUE(says(refusal(scratch.path("bad.exr")), "bad.exr")) << text;
  }
  exr.strings.clear();
  for (const double angle : {0.0, 200.0, std::nan("")}) {
    exr.numbers["sceneAngle_deg"] = angle;
    write_spectral_exr(scratch.path("bad.exr"), exr);
    EXPECT_TRUE(says(refusal(scratch.path("bad.exr")), "degrees")) << angle;
  }
}

TEST(SceneExr, DamagedFilesAreErrorsOrScenes) {
  const Scratch scratch;
  write_scene_exr(scratch.path("ramp.exr"), ramp());
  const std::string bytes = read_whole_file(scratch.path("ramp.exr"));
  const auto read = [](const std::string& path) { read_scene_exr(path); };
  refuses_truncations(scratch, bytes, read);
  survives_flips(scratch, bytes, 0, read);
}

TEST(ReadScene, OptionsReplaceWhatTheFileSays) {
  const Scratch scratch;
  write_mat(scratch.path("scene.MAT"), iset_scene(), false);
  SceneOptions options;
  options.horizontal_angle_deg = 50;
  options.distance_m = std::numeric_limits<double>::infinity();
  options.mean_luminance_cd_m2 = 7;
  const Scene scene = read_scene(scratch.path("scene.MAT"), options);
  EXPECT_EQ(scene.horizontal_angle_deg(), 50);
  EXPECT_FALSE(scene.distance_m().has_value());
  EXPECT_NEAR(scene.mean_luminance_cd_m2(), 7, 1e-5);
}

TEST(ReadScene, WavelengthsDoNotChangeTheLevel) {
  const Scratch scratch;
  write_mat(scratch.path("scene.mat"), iset_scene(), false);
  SceneOptions options;
  options.mean_luminance_cd_m2 = 7;
  const Scene all = read_scene(scratch.path("scene.mat"), options);
  options.wavelengths_nm = {550};
  const Scene one = read_scene(scratch.path("scene.mat"), options);
  ASSERT_EQ(one.bands(), 1);
  EXPECT_NEAR(one.band(0)[3] / (0.5 * (all.band(0)[3] + all.band(1)[3])), 1, 1e-6);
}

TEST(ReadScene, OptionsThatDoNotApplyAreRefused) {
  const Scratch scratch;
  write_mat(scratch.path("scene.mat"), iset_scene(), false);
  SceneOptions options;
  options.columns = 10;
  EXPECT_TRUE(says(refusal(scratch.path("scene.mat"), options), "size"));
  options = {};
  options.illuminant = "D65";
  EXPECT_TRUE(says(refusal(scratch.path("scene.mat"), options), "`scene.illuminant`"));
  options = {};
  options.wavelengths_nm = {650};
  EXPECT_TRUE(says(refusal(scratch.path("scene.mat"), options), "650"));
  for (const double distance : {0.0, -1.0, std::nan(""), -std::numeric_limits<double>::infinity()}) {
    options = {};
    options.distance_m = distance;
    EXPECT_NE(refusal("wall", options), "no error") << distance;
  }
}

TEST(ReadScene, UnknownNamesAndBadParameters) {
  EXPECT_TRUE(says(refusal("studioo"), "studio"));
  for (const char* name : {"", "/", ".", "nowhere.mat", "nowhere.exr", "checkerboard:", "checkerboard:0",
                           "checkerboard:x", "checkerboard:2.5", "checkerboard:-4", "checkerboard:1e30",
                           "checkerboard:nan", "wall:3", "studio:", "slanted-edge:90", "points:100000"})
    EXPECT_NE(refusal(name), "no error") << name;
  const Scratch scratch;
  EXPECT_TRUE(says(refusal(scratch.with("picture.gif", "x")), ".exr"));
  EXPECT_TRUE(says(refusal(scratch.with("picture.jpg", "x")), "JPEG"));
}

TEST(ReadScene, EveryListedChartIsMade) {
  EXPECT_GE(builtin_scenes().size(), 6u);
  SceneOptions options;
  options.columns = 24, options.rows = 18;
  for (const BuiltinScene& chart : builtin_scenes()) {
    const std::string name = chart.name.substr(0, chart.name.find('['));
    EXPECT_TRUE(is_builtin_scene(name));
    EXPECT_TRUE(is_builtin_scene(name + ":5"));
    EXPECT_EQ(read_scene(name, options).name, name);
  }
  EXPECT_FALSE(is_builtin_scene("piano.mat"));
}

TEST(Wavelengths, AreWrittenAsRangesAndLists) {
  EXPECT_EQ(parse_wavelengths_nm("587.5618"), (std::vector<double>{587.5618}));
  EXPECT_EQ(parse_wavelengths_nm("450,550,650"), (std::vector<double>{450, 550, 650}));
  EXPECT_EQ(parse_wavelengths_nm("400:100:700"), (std::vector<double>{400, 500, 600, 700}));
  EXPECT_EQ(parse_wavelengths_nm("400:150:600,650"), (std::vector<double>{400, 550, 650}));
  EXPECT_EQ(parse_wavelengths_nm("400:10:700").size(), 31u);
  EXPECT_EQ(parse_wavelengths_nm("400:0.1:410").size(), 101u)
      << "the end, although 100 · 0.1 is not quite 10";
  EXPECT_EQ(parse_wavelengths_nm("500:10:500"), (std::vector<double>{500}));
}

TEST(Wavelengths, NonsenseIsRefused) {
  for (const char* text :
       {"",           ",",           "x",          "400:",         "400:10",  "400:10:", ":10:700",
        "400:0:700",  "400:-10:300", "700:10:400", "400:10:700:5", "500,400", "500,500", "nan",
        "inf",        "-5",          "0",          "400:1e-9:700", "400,",    "4 5",     "1:1e-300:2",
        "400:inf:700"})
    EXPECT_THROW(parse_wavelengths_nm(text), InputError) << text;
}

}  // namespace
}  // namespace petzval
