// SPDX-License-Identifier: BSD-3-Clause
// Frames that share their paths: the light of frames that do not.
#include <gtest/gtest.h>
#include <petzval/base/context.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/lens/lens_file.h>
#include <petzval/render/camera/pupil_etendue.h>
#include <petzval/render/shared_frames.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "scene_text.h"

namespace petzval::render {
namespace {

/// A glowing disk and a glass ball that disperses before a sky, 0.4 to 1 m away.
const char* const still_life =
    "LightSource \"infinite\" \"spectrum L\" [ 300 .5 900 1 ]\n"
    "AttributeBegin\nAreaLightSource \"diffuse\" \"spectrum L\" [ 300 3 900 2 ] \"bool twosided\" true\n"
    "Translate .05 .02 1\nShape \"disk\" \"float radius\" 0.1\nAttributeEnd\n"
    "AttributeBegin\nMaterial \"dielectric\" \"spectrum eta\" \"glass-SF11\"\nTranslate -.05 0 .4\n"
    "Shape \"sphere\" \"float radius\" .04\nAttributeEnd\n"
    "Material \"diffuse\" \"rgb reflectance\" [ .6 .3 .1 ]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -1 -.08 .2  1 -.08 .2  -1 -.08 3  1 -.08 3 ]\n";

struct Pull {
  std::unique_ptr<const World> world;
  SensorGeometry film{24, 16, 1500};
  std::vector<LensCamera> cameras;
  RenderOptions options;

  /// Films from the one that is in focus at infinity on.
  Pull(const std::string& lens_name, const std::string& scene, int frames, double step_mm,
       const LensCameraOptions& given = {})
      : world(world_of(scene)) {
    Lens lens = read_lens(lens_name).lens;
    LensCameraOptions camera = given;
    camera.lands = true;
    const double first = lens.image_distance_mm();
    for (int i = 0; i < frames; ++i) {
      lens.surfaces.back().thickness_mm = first + i * step_mm;
      cameras.emplace_back(lens, film, world->groups, camera);
    }
    options.samples_per_pixel = 16;
  }
  std::vector<Rendering> together(std::uint64_t seed = 1) const {
    RenderOptions with = options;
    with.seed = seed;
    return render_shared_frames(*world, cameras, Transform(), film, with);
  }
};

/// In a uniform field every path carries the same light: each pixel is what the lens gathers there, which no
/// noise is left of. Rings where vignetting sets in are not corrected.
TEST(SharedFrames, AFurnaceIsAsBrightAsThePupilsAreWide) {
  for (const char* lens : {"dgauss-50mm", "double-gauss"}) {
    Pull pull(lens, white_furnace, 5, 0.4);
    const std::vector<Rendering> frames = pull.together();
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const PupilEtendue etendue(pull.cameras[i], pull.world->groups, pull.film.half_diagonal_mm());
      std::size_t known = 0;
      for (int row = 0; row < pull.film.rows; ++row)
        for (int column = 0; column < pull.film.columns; ++column) {
          const double x = pull.film.x_mm(column + 0.5), y = pull.film.y_mm(row + 0.5);
          const PupilEtendue::Value field = etendue.at(0, 1, etendue.place(x, y));
          // An independent count of rays, sixteen times as many.
          const double counted = pull.cameras[i].etendue_sr(0, 1, x, y, 8192);
          if (!field.exact || counted == 0) continue;
          ++known;
          const float pixel =
              frames[i].irradiance.band(1)[static_cast<std::size_t>(row * pull.film.columns + column)];
          EXPECT_NEAR(pixel, counted, 6e-3 * counted) << lens << " " << i << " " << column << " " << row;
        }
      EXPECT_GT(known, pull.film.columns * pull.film.rows / 2u) << lens;
    }
  }
}

/// Pictures of one frame with different seeds.
struct Seeds {
  int count = 0;
  std::vector<double> sum, square;
  double all = 0, all_square = 0;  ///< of all pixels together

  void add(std::span<const float> picture) {
    ++count;
    double light = 0;
    for (const float value : picture) light += static_cast<double>(value);
    all += light, all_square += light * light;
    sum.resize(picture.size()), square.resize(picture.size());
    for (std::size_t k = 0; k < picture.size(); ++k) {
      const auto value = static_cast<double>(picture[k]);
      sum[k] += value, square[k] += value * value;
    }
  }
  double mean(std::size_t k) const { return sum[k] / count; }
  /// Of the mean.
  double variance(std::size_t k) const {
    return std::max(0.0, square[k] / count - mean(k) * mean(k)) / (count - 1);
  }
  double variance_of_all() const { return (all_square / count - all * all / count / count) / (count - 1); }
};

/// Means over many seeds against frames of their own paths, pixel by pixel, in standard errors of both; with
/// dark corners, and glass that leaves one wavelength to a path.
void expect_the_light_of_single_frames(Pull& pull) {
  std::vector<Seeds> shared(pull.cameras.size());
  for (std::uint64_t seed = 1; seed <= 48; ++seed) {
    const std::vector<Rendering> frames = pull.together(seed);
    for (std::size_t i = 0; i < frames.size(); ++i) shared[i].add(frames[i].irradiance.values());
  }
  for (const std::size_t i : {std::size_t{0}, pull.cameras.size() - 1}) {
    Seeds single;
    RenderOptions alone = pull.options;
    alone.samples_per_pixel = 128;
    for (alone.seed = 1; alone.seed <= 48; ++alone.seed)
      single.add(
          render_picture(*pull.world, pull.cameras[i], Transform(), pull.film, alone).irradiance.values());
    double all = 0, expected = 0, far_off = 0, lit = 0, squares = 0;
    for (std::size_t k = 0; k < single.sum.size(); ++k) {
      const double mean = shared[i].mean(k), right = single.mean(k);
      EXPECT_GE(mean, 0);
      all += mean, expected += right;
      if (!(right > 0)) continue;
      // The table of pupils errs by 2e-3.
      const double off =
          (mean - right) / std::sqrt(shared[i].variance(k) + single.variance(k) + 4e-6 * right * right);
      ++lit, squares += off * off;
      far_off += std::abs(off) > 4 ? 1 : 0;
    }
    const double deviation = std::sqrt(shared[i].variance_of_all() + single.variance_of_all());
    EXPECT_NEAR(all, expected, 2e-3 * expected + 3 * deviation) << i;
    EXPECT_LT(deviation, 1e-3 * expected) << "or the line before says nothing";
    EXPECT_LE(far_off, 0.003 * lit) << i;  // Student's t of 94: 1.3e-4 beyond 4, if light had no rare paths
    EXPECT_NEAR(squares, lit, 0.2 * lit) << i;
  }
}

TEST(SharedFrames, MeansAreThoseOfFramesThatShareNothing) {
  Pull pull("dgauss-50mm", still_life, 6, 0.6);
  expect_the_light_of_single_frames(pull);
}

TEST(SharedFrames, AlsoWhereALensPartsWavelengthsAndLosesLight) {
  LensCameraOptions options;
  options.losses.fresnel = true;
  Pull pull("double-gauss", still_life, 5, 0.5, options);
  expect_the_light_of_single_frames(pull);
}

TEST(SharedFrames, AlsoWithLampsThatGuideDirections) {
  LensCameraOptions options;
  options.lamps.push_back({{.05, .02, 1}, 0.02, 30});
  std::string scene = still_life;
  scene.replace(scene.find("radius\" 0.1"), 11, "radius\" .02");
  Pull pull("dgauss-50mm", scene, 6, 0.6, options);
  expect_the_light_of_single_frames(pull);
}

TEST(SharedFrames, BytesDoNotDependOnThreads) {
  const Pull pull("double-gauss", still_life, 5, 0.5);
  std::vector<std::vector<float>> before;
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    std::vector<std::vector<float>> bytes;
    for (const Rendering& frame : pull.together(3))
      bytes.emplace_back(frame.irradiance.values().begin(), frame.irradiance.values().end());
    if (!before.empty()) {
      EXPECT_EQ(bytes, before) << threads;
    }
    before = bytes;
  }
}

TEST(SharedFrames, NumbersOfPaths) {
  const WavelengthGroups four_groups([] {
    std::vector<double> nm;
    for (int i = 400; i <= 700; i += 10) nm.push_back(i);
    return nm;
  }());
  const auto expect = [&](int spp, int frames, int own, int every) {
    const SharedPaths paths = shared_paths(four_groups, spp, frames);
    EXPECT_EQ(paths.own, own) << spp << " " << frames;
    EXPECT_EQ(paths.every, every) << spp << " " << frames;
  };
  expect(32, 12, 1, 2);
  expect(64, 12, 1, 1);
  expect(640, 12, 10, 1);
  expect(1, 12, 1, 4);
}

TEST(SharedFrames, RefusesWhatFramesCannotShare) {
  Pull pull("dgauss-50mm", white_furnace, 4, 0.4);
  const auto refuses = [&](const std::string& word) {
    try {
      pull.together();
      ADD_FAILURE() << word;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
    pull.options = {};
  };
  pull.options.noise = 0.1;
  refuses("`noise`");
  pull.options.denoise = true;
  refuses("`denoise_light`");
  pull.options.checkpoint = "x";
  refuses("`checkpoint`");
}

}  // namespace
}  // namespace petzval::render
