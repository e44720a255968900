// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/spectral_exr.h>
#include <petzval/scene/formats/envi.h>
#include <petzval/scene/formats/npy_scene.h>
#include <petzval/scene/formats/scene_exr.h>
#include <petzval/scene/spectral_cube.h>

#include <filesystem>
#include <functional>

#include "scratch.h"

namespace petzval {
namespace {

SpectralCube two_bands() {
  SpectralCube cube;
  cube.columns = 3, cube.rows = 2, cube.bands = 2;
  return cube;
}

CubeOptions all_answers() {
  CubeOptions options;
  options.quantity = SceneQuantity::radiance;
  options.file_bands_nm = {500, 600};
  options.horizontal_angle_deg = 20;
  return options;
}

/// What check_cube says to a cube that has no values yet, and nothing that says what they are.
std::string complaint(const std::function<void(CubeOptions&)>& change) {
  CubeOptions options = all_answers();
  change(options);
  try {
    check_cube(two_bands(), options);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(SpectralCube, IsRefusedBeforeItHasValues) {
  EXPECT_EQ(complaint([](CubeOptions&) {}), "");
  const std::pair<const char*, std::function<void(CubeOptions&)>> wrong[] = {
      {"`scene.quantity`", [](CubeOptions& options) { options.quantity.reset(); }},
      {"`scene.file_bands_nm`", [](CubeOptions& options) { options.file_bands_nm.clear(); }},
      {"2 bands, but 3",
       [](CubeOptions& options) {
         options.file_bands_nm = {400, 500, 600};
       }},
      {"`scene.horizontal_angle_deg`", [](CubeOptions& options) { options.horizontal_angle_deg.reset(); }},
      {"a scale of -1", [](CubeOptions& options) { options.scale = -1; }},
      {"irradiance", [](CubeOptions& options) { options.radiance_unit = "W.m^-2.nm^-1"; }},
      {"`scene.illuminant` D65", [](CubeOptions& options) { options.quantity = SceneQuantity::reflectance; }},
      {"no light in the bands",
       [](CubeOptions& options) {
         options.quantity = SceneQuantity::reflectance;
         options.illuminant = Spectrum({700, 800}, {1, 1});
       }},
      {"`scene.temperature_k`", [](CubeOptions& options) { options.quantity = SceneQuantity::emissivity; }},
      {"own warmth",
       [](CubeOptions& options) {
         options.quantity = SceneQuantity::emissivity;
         options.thermal.temperature_k = 300;
         options.illuminant = Spectrum({400, 700}, {1, 1});
       }},
      {"a map of temperatures with 2 bands",
       [](CubeOptions& options) { options.quantity = SceneQuantity::temperature; }},
  };
  for (const auto& [part, change] : wrong)
    EXPECT_NE(complaint(change).find(part), std::string::npos) << part << ": " << complaint(change);
}

/// Files whose numbers are many and whose words are few: a reader that has the numbers when it is asked
/// whether to go on has read them for nothing.
TEST(SpectralCube, ReadersAskBeforeTheyReadValues) {
  const test::Scratch scratch;
  const std::string npy = scratch.path("a.npy");
  write_npy(npy, std::vector<std::size_t>{2, 3, 2}, std::vector<float>(12));
  scratch.with("a.json", R"({"scale": 2})");
  scratch.with("b.img", std::string(12 * sizeof(float), 0));
  const std::string envi = scratch.with(
      "b.hdr", "ENVI\nsamples = 3\nlines = 2\nbands = 2\ndata type = 4\ninterleave = bsq\nbyte order = 0\n");
  SpectralExr exr;
  exr.width = 3, exr.height = 2;
  exr.wavelengths_nm = {500, 600};
  exr.values = LargeFloats(12);
  write_spectral_exr(scratch.path("c.exr"), exr);

  bool asked = false;
  const CubeCheck check = [&](const SpectralCube& cube) {
    EXPECT_EQ(cube.values.size(), 0u);
    EXPECT_EQ(cube.columns, 3);
    EXPECT_EQ(cube.rows, 2);
    EXPECT_EQ(cube.bands, 2);
    asked = true;
    throw InputError("enough");
  };
  for (const std::function<SpectralCube(const CubeCheck&)>& read :
       {std::function([&](const CubeCheck& c) { return read_npy_scene(npy, c); }),
        std::function([&](const CubeCheck& c) { return read_envi(envi, c); }),
        std::function([&](const CubeCheck& c) { return read_scene_exr(scratch.path("c.exr"), c); })}) {
    asked = false;
    EXPECT_THROW(read(check), InputError);
    EXPECT_TRUE(asked);
    EXPECT_EQ(read({}).values.size(), 12u);
  }
  EXPECT_EQ(read_npy_scene(npy).scale, 2) << "of the file beside it";
}

}  // namespace
}  // namespace petzval
