// SPDX-License-Identifier: BSD-3-Clause
// Pictures as a whole: the same bytes whoever computes them, interrupted or not.
#include <gtest/gtest.h>
#include <petzval/base/context.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/render/camera/lens_camera.h>
#include <petzval/render/camera/perspective_camera.h>
#include <petzval/render/film/noise.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "scene_text.h"
#include "scratch.h"

namespace petzval::render {
namespace {

/// A floor and a glass sphere that disperses, under a lamp and a sky.
constexpr const char* scene =
    "LightSource \"infinite\" \"rgb L\" [ .2 .3 .4 ]\n"
    "AttributeBegin\nAreaLightSource \"diffuse\" \"float scale\" 5\nTranslate 0 1 1\nRotate 90 1 0 0\nShape "
    "\"disk\" "
    "\"float radius\" 0.3\nAttributeEnd\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -2 -.1 0  2 -.1 0  -2 -.1 4  2 -.1 4 ]\n"
    "Material \"dielectric\" \"spectrum eta\" \"glass-SF11\"\nTranslate 0 0 1\nShape \"sphere\" \"float "
    "radius\" 0.08\n";

struct SmallPicture {
  explicit SmallPicture(const char* text = scene)
      : world(world_of(text, {420, 480, 520, 560, 600, 640, 660, 680, 700})) {}

  std::unique_ptr<const World> world;
  SensorGeometry film{40, 30, 150};
  LensCamera camera{read_lens("edmund-54852").lens, film, world->groups};

  Rendering render(const RenderOptions& options = {}) const { return render_surfaces(options, 24); }
  Rendering render_surfaces(RenderOptions options, int samples, const ProgressCallback& progress = {}) const {
    options.first_surfaces = true;
    return render_with(options, samples, progress);
  }
  Rendering render_with(RenderOptions options, int samples, const ProgressCallback& progress = {}) const {
    options.samples_per_pixel = samples;
    return render_picture(*world, camera, Transform(), film, options, progress);
  }
};

std::vector<float> values(const Rendering& rendering) {
  return {rendering.irradiance.values().begin(), rendering.irradiance.values().end()};
}

TEST(Renderer, GivesTheSameBytesOnAnyNumberOfThreads) {
  const SmallPicture small;
  std::vector<float> one, two;
  {
    const ThreadLimit limit(1);
    one = values(small.render());
  }
  {
    const ThreadLimit limit(2);
    two = values(small.render());
  }
  EXPECT_EQ(one, two);
  RenderOptions other;
  other.seed = 2;
  EXPECT_NE(one, values(small.render(other)));
}

TEST(Renderer, LightGroupsAddUpToThePicture) {
  const SmallPicture small;
  const test::Scratch scratch;
  RenderOptions options;
  const std::vector<float> plain = values(small.render(options));
  options.light_groups = true;
  options.checkpoint = scratch.path("checkpoint");
  options.after_pass = [](int done, int) { return done < 2; };
  small.render(options);
  options.after_pass = nullptr;
  const Rendering picture = small.render(options);  // which goes on from there
  EXPECT_EQ(values(picture), plain);
  ASSERT_EQ(picture.light_groups.size(), 2u);
  EXPECT_EQ(small.world->lights.sources, (std::vector<std::string>{"0 infinite", "1 area diffuse"}));
  const std::span<const float> sky = picture.light_groups[0].values(),
                               lamp = picture.light_groups[1].values();
  double of_sky = 0, of_lamp = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    // Roundings of floats along a path.
    EXPECT_NEAR(sky[i] + lamp[i], plain[i], 1e-5f * plain[i] + 1e-9f) << i;
    of_sky += static_cast<double>(sky[i]), of_lamp += static_cast<double>(lamp[i]);
  }
  // And each is the picture of that light alone, whose paths ask for no other: 1 % of scatter in the sum.
  std::string dark = scene;
  dark.replace(dark.find("\"float scale\" 5"), 15, "\"float scale\" 0");
  double alone = 0;
  for (const float value : values(SmallPicture(dark.c_str()).render())) alone += static_cast<double>(value);
  EXPECT_NEAR(of_sky, alone, 0.02 * alone);
  EXPECT_GT(of_lamp, 0.1 * of_sky);
}

/// RMS relative error; of dark pixels, relative to a tenth of the picture's mean.
double error_of(const Rendering& picture, const std::vector<float>& truth) {
  double sum = 0, squares = 0;
  for (const float value : truth) sum += static_cast<double>(value);
  const double least = 0.1 * sum / static_cast<double>(truth.size());
  const std::vector<float> light = values(picture);
  for (std::size_t i = 0; i < truth.size(); ++i)
    squares += std::pow(
        static_cast<double>(light[i] - truth[i]) / std::hypot(static_cast<double>(truth[i]), least), 2);
  return std::sqrt(squares / static_cast<double>(truth.size()));
}

TEST(Renderer, DenoisesToASmallerErrorThatSamplesMakeSmallerStill) {
  const SmallPicture small;
  RenderOptions options;
  options.seed = 99;
  const std::vector<float> truth = values(small.render_with(options, 2048));
  options.seed = 1;
  const double raw = error_of(small.render_with(options, 16), truth);
  options.denoise = true;
  const Rendering few = small.render_with(options, 16), more = small.render_with(options, 256);
  EXPECT_TRUE(few.denoised);
  EXPECT_EQ(few.samples_per_pixel, 16);
  // As good as twice the samples, of a picture of 40 x 30 pixels that is mostly edges.
  EXPECT_LT(error_of(few, truth), raw / std::sqrt(2.0));
  EXPECT_LT(error_of(more, truth), error_of(few, truth) / 2);
  // What the checkpoint keeps is the light as it was: it goes on to the bytes of all samples at once.
  const test::Scratch scratch;
  options.checkpoint = scratch.path("checkpoint");
  EXPECT_EQ(values(small.render_with(options, 16)), values(few));
  EXPECT_EQ(values(small.render_with(options, 256)), values(more));
}

TEST(Renderer, DenoisesWholePicturesAlone) {
  const SmallPicture small;
  RenderOptions options;
  options.denoise = true;
  options.light_groups = true;
  EXPECT_THROW(small.render_with(options, 16), InputError);
  options.light_groups = false;
  options.piece.region = PixelWindow{0, 0, 8, 8};
  EXPECT_THROW(small.render_with(options, 16), InputError);
}

TEST(Renderer, GoesOnFromACheckpointToTheSameBytes) {
  const SmallPicture small;
  const test::Scratch scratch;
  const std::string path = scratch.path("checkpoint");
  RenderOptions options;
  options.checkpoint = path;
  options.fingerprint = "this picture";
  int passes = 0;
  options.after_pass = [&](int done, int all) {
    passes = all;
    return done < 2;  // "killed" after the second pass
  };
  const Rendering part = small.render(options);
  ASSERT_GT(passes, 2);
  EXPECT_FALSE(part.complete);
  ASSERT_TRUE(std::filesystem::exists(path));
  options.after_pass = nullptr;
  const Rendering resumed = small.render(options), whole = small.render();
  EXPECT_TRUE(resumed.complete);
  EXPECT_EQ(values(resumed), values(whole));
  EXPECT_EQ(resumed.first_surfaces->depth, whole.first_surfaces->depth);
  EXPECT_EQ(resumed.rays, whole.rays);

  options.fingerprint = "another picture";
  EXPECT_THROW(small.render(options), InputError);
  options.fingerprint = "this picture";
  // One bit anywhere: in the sums, which any bits are numbers of, and in what stands about them.
  const auto size = static_cast<std::size_t>(std::filesystem::file_size(path));
  for (const std::size_t at : {size / 100, size / 3, size / 2, size - 9, size - 1}) {
    const auto flip = [&] {
      std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
      file.seekg(static_cast<std::streamoff>(at));
      const char byte = static_cast<char>(file.get() ^ 4);
      file.seekp(static_cast<std::streamoff>(at));
      file.put(byte);
    };
    flip();
    EXPECT_THROW(small.render(options), InputError) << at;
    flip();
  }
  EXPECT_EQ(values(small.render(options)), values(whole));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  EXPECT_THROW(small.render(options), InputError);
  std::ofstream(path) << "something else";
  EXPECT_THROW(small.render(options), InputError);
}

TEST(Renderer, SavesWhatThereIsWhenItIsStopped) {
  const SmallPicture small;
  const test::Scratch scratch;
  RenderOptions options;
  options.checkpoint = scratch.path("checkpoint");
  std::optional<Rendering> so_far;
  options.so_far = [&](Rendering picture) { so_far = std::move(picture); };
  bool stop = false;
  options.after_pass = [&](int done, int) {
    stop = done == 2;
    return true;
  };
  Context context;
  context.progress = [&](double, const std::string&) { return !stop; };
  EXPECT_THROW(
      run_within(context,
                 [&](const ProgressCallback& progress) { small.render_surfaces(options, 24, progress); }),
      Cancelled);
  ASSERT_TRUE(so_far);
  EXPECT_EQ(so_far->samples_per_pixel, 16);  // two passes of four for each of two groups
  options = {};
  EXPECT_EQ(values(*so_far), values(small.render_surfaces(options, 16)));
  options.checkpoint = scratch.path("checkpoint");
  EXPECT_EQ(values(small.render(options)), values(small.render()));
}

TEST(Renderer, LeavesNothingBehindWhenItIsStoppedAtOnce) {
  const SmallPicture small;
  const test::Scratch scratch;
  RenderOptions options;
  options.checkpoint = scratch.path("checkpoint");
  options.so_far = [](const Rendering&) { ADD_FAILURE() << "of no tile"; };
  Context context;
  int questions = 0;
  context.progress = [&](double, const std::string&) { return ++questions < 1; };
  EXPECT_THROW(
      run_within(context,
                 [&](const ProgressCallback& progress) { small.render_surfaces(options, 24, progress); }),
      Cancelled);
  EXPECT_TRUE(scratch.is_empty());
}

/// A picture whose k-th report of progress ends it.
Rendering stopped_at(const SmallPicture& small, int report) {
  const ThreadLimit limit(1);
  RenderOptions options;
  std::optional<Rendering> so_far;
  options.so_far = [&](Rendering picture) { so_far = std::move(picture); };
  Context context;
  int reports = 0;
  std::string last;
  bool stop = false;
  context.progress = [&](double, const std::string&) { return !stop; };
  EXPECT_THROW(run_within(context,
                          [&](const ProgressCallback& progress) {
                            small.render_with(options, 24, [&](double fraction, const std::string& what) {
                              stop = ++reports >= report;
                              progress(fraction, what);
                            });
                          }),
               Cancelled);
  EXPECT_TRUE(so_far);
  return so_far.value_or(Rendering());
}

/// The worst difference in a tile, away from its sides, over which colours stray. Tiles count from the upper
/// left, three a row.
float difference_in_tile(const Rendering& a, const Rendering& b, int tile) {
  float worst = 0;
  for (int band = 0; band < a.irradiance.bands(); ++band)
    for (int row = tile / 3 * 16 + 2; row < std::min(tile / 3 * 16 + 14, 30); ++row)
      for (int column = tile % 3 * 16 + 2; column < std::min(tile % 3 * 16 + 14, 40); ++column)
        worst = std::max(worst,
                         std::abs(a.irradiance.at(band, row, column) - b.irradiance.at(band, row, column)) /
                             b.irradiance.at(band, row, column));
  return worst;
}

TEST(Renderer, GivesTheTilesThatAreDoneWhenItIsStopped) {
  const SmallPicture small;
  const auto with = [&](int samples) { return small.render_with({}, samples); };
  const float rounding = 1e-6F;
  // Six tiles a pass; one thread does them one after the other. After two of the first pass:
  const Rendering first = stopped_at(small, 2), one_pass = with(8);
  EXPECT_FALSE(first.complete);
  EXPECT_LT(difference_in_tile(first, one_pass, 0), rounding);
  EXPECT_LT(difference_in_tile(first, one_pass, 1), rounding);
  EXPECT_EQ(first.irradiance.at(0, 24, 24), 0);  // the fifth
  // After two tiles of the third pass.
  const Rendering third = stopped_at(small, 14), two_passes = with(16), three_passes = with(24);
  EXPECT_EQ(third.samples_per_pixel, 16);
  EXPECT_LT(difference_in_tile(third, three_passes, 0), rounding);
  EXPECT_GT(difference_in_tile(third, two_passes, 0), 100 * rounding);
  EXPECT_LT(difference_in_tile(third, two_passes, 5), rounding);
}

TEST(Renderer, ShowsThePictureSoFar) {
  const SmallPicture small;
  RenderOptions options;
  std::vector<int> samples;
  std::vector<float> last;
  options.preview = [&](const Rendering& picture) {
    samples.push_back(picture.samples_per_pixel);
    last = values(picture);
  };
  options.preview_seconds = 0;
  small.render_with(options, 24);
  EXPECT_EQ(samples, (std::vector{8, 16}));  // the third pass is the picture itself
  EXPECT_EQ(last, values(small.render_with({}, 16)));
}

TEST(Renderer, KnowsTheLampsAndTheLightOfItsScene) {
  // A lamp of 3000 K in view, and a wall that it lights.
  const char* lit =
      "LookAt 0 0 -1  0 0 0  0 1 0\n"
      "AttributeBegin\nAreaLightSource \"diffuse\" \"blackbody L\" 3000 \"float scale\" 5\n"
      "Translate 0 .1 -.3\nShape \"sphere\" \"float radius\" 0.05\nAttributeEnd\n"
      "Material \"diffuse\" \"rgb reflectance\" [ .8 .1 .1 ]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [ -2 -2 .4  2 -2 .4  -2 2 .4  2 2 .4 ]\n";
  const auto world = world_of(lit, {450, 550, 650});
  const SensorGeometry film{40, 30, 600};
  PerspectiveOptions perspective;
  perspective.columns = 40, perspective.rows = 30;
  RenderOptions options;
  options.samples_per_pixel = 64;
  const Rendering picture = render_picture(*world, PerspectiveCamera(perspective, world->groups),
                                           Transform::translation({0, 0, -1}), film, options);
  const std::vector<std::uint8_t>& lamps = picture.irradiance.lamps;
  ASSERT_EQ(lamps.size(), 1200u);
  // A ball of 0.05 at 0.7 m, 0.1 m above the axis, where 15 pixels are a unit at a distance of 1: its middle
  // is 2.1 pixels above that of the picture, its radius 1.07 pixels.
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < lamps.size(); ++i)
    if (lamps[i] == 1) shown.push_back(i);
  ASSERT_FALSE(shown.empty());
  for (const std::size_t i : shown) {
    EXPECT_NEAR(static_cast<double>(i % 40) + 0.5, 20, 1.07 + 1);
    EXPECT_NEAR(static_cast<double>(i / 40) + 0.5, 15 - 2.1, 1.07 + 1);
  }
  // The light on the wall is that of the lamp, whatever the colour of the wall: Planck's ratios.
  ASSERT_TRUE(picture.irradiance.illuminant);
  const auto planck = [](double nm) { return std::pow(nm, -5) / std::expm1(1.438776877e7 / (nm * 3000)); };
  for (const double nm : {450.0, 650.0})
    EXPECT_NEAR(picture.irradiance.illuminant->at(nm) / picture.irradiance.illuminant->at(550),
                planck(nm) / planck(550), 1e-3 * planck(nm) / planck(550));
}

TEST(Renderer, AddsSamplesToThoseOfAFinishedPicture) {
  const SmallPicture small;
  const test::Scratch scratch;
  RenderOptions options;
  options.checkpoint = scratch.path("checkpoint");
  // Two groups of wavelengths take four samples each in a pass: 10 end amid the second one.
  for (const int samples : {10, 16, 30})
    EXPECT_EQ(values(small.render_surfaces(options, samples)), values(small.render_surfaces({}, samples)));
  EXPECT_THROW(small.render_surfaces(options, 16), InputError);
}

std::vector<double> summed_over_bands(const Rendering& rendering) {
  const SpectralImage& image = rendering.irradiance;
  std::vector<double> sums(image.band_size(), 0.0);
  for (int band = 0; band < image.bands(); ++band)
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += static_cast<double>(image.band(band)[i]);
  return sums;
}

/// The same without glass, whose caustics are so rare that a few hundred samples know nothing of most.
constexpr const char* scene_without_caustics =
    "LightSource \"infinite\" \"rgb L\" [ .2 .3 .4 ]\n"
    "AttributeBegin\nAreaLightSource \"diffuse\" \"float scale\" 5\nTranslate 0 1 1\nRotate 90 1 0 0\nShape "
    "\"disk\" \"float radius\" 0.3\nAttributeEnd\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -2 -.1 0  2 -.1 0  -2 -.1 4  2 -.1 4 ]\n"
    "Material \"diffuse\"\nTranslate 0 0 1\nShape \"sphere\" \"float radius\" 0.08\n";

TEST(Renderer, EndsAtTheNoiseThatIsAskedAndIsRightAboutIt) {
  const SmallPicture small(scene_without_caustics);
  RenderOptions options;
  options.seed = 77;
  const std::vector<double> truth = summed_over_bands(small.render_with(options, 4096));
  int before = 0;
  for (const double wanted : {0.08, 0.04, 0.02}) {
    options.noise = wanted;
    constexpr int seeds = 16;
    double ratio = 0;
    int samples = 0;
    for (options.seed = 1; options.seed <= seeds; ++options.seed) {
      const Rendering picture = small.render_with(options, 4096);
      ASSERT_TRUE(picture.noise);
      EXPECT_LE(*picture.noise, wanted);
      EXPECT_GT(*picture.noise, wanted / 2) << "or it went on for too long";
      samples += picture.samples_per_pixel;
      std::vector<double> squared;
      const std::vector<double> light = summed_over_bands(picture);
      for (std::size_t i = 0; i < light.size(); ++i)
        squared.push_back((light[i] - truth[i]) * (light[i] - truth[i]));
      ratio += noise_of({0, 0, 40, 30}, squared, truth) / *picture.noise / seeds;
    }
    EXPECT_GT(samples, before);
    before = samples;
    // Estimate and error are each the noise of one tile of 256 pixels, known to 1/√512 = 4 % of themselves.
    EXPECT_NEAR(ratio, 1, 3 * 0.06 / std::sqrt(seeds));
  }
}

TEST(Renderer, EndsAtTheSameNoiseOnAnyThreadsAndAfterAnInterruption) {
  const SmallPicture small;
  RenderOptions options;
  options.noise = 0.07;
  const Rendering whole = small.render_with(options, 2000);
  ASSERT_GT(whole.samples_per_pixel, 32);
  {
    const ThreadLimit limit(1);
    const Rendering again = small.render_with(options, 2000);
    EXPECT_EQ(values(again), values(whole));
    EXPECT_EQ(again.noise, whole.noise);
  }
  const test::Scratch scratch;
  const std::string path = scratch.path("checkpoint");
  options.checkpoint = path;
  options.after_pass = [](int done, int) { return done < 3; };
  EXPECT_FALSE(small.render_with(options, 2000).complete);
  options.after_pass = nullptr;
  EXPECT_EQ(values(small.render_with(options, 2000)), values(whole));
  // No more than is allowed, in whole pairs of passes: 2 groups × 4 samples × 2.
  options.checkpoint.clear();
  options.noise = 1e-6;
  const Rendering allowed = small.render_with(options, 40);
  EXPECT_TRUE(allowed.complete);
  EXPECT_EQ(allowed.samples_per_pixel, 48);
  EXPECT_GT(allowed.noise.value(), 1e-6);
}

}  // namespace
}  // namespace petzval::render
