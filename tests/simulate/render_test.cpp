// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/render.h>
#include <scratch.h>

#include <filesystem>
#include <functional>

namespace petzval {
namespace {

/// A wall with a pattern 1.4 m in front of the film, under a sky.
constexpr const char* wall =
    "LookAt 0 0 -1  0 0 0  0 1 0\nCamera \"perspective\"\n"
    "Film \"rgb\" \"integer xresolution\" 96 \"integer yresolution\" 72 \"float diagonal\" 40\nWorldBegin\n"
    "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"
    "Texture \"t\" \"spectrum\" \"checkerboard\" \"float uscale\" 40 \"float vscale\" 40 "
    "\"rgb tex1\" [ .9 .9 .9 ] \"rgb tex2\" [ .1 .1 .1 ]\n"
    "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -2 -2 .4  2 -2 .4  -2 2 .4  2 2 .4 ]\n";

/// The camera of a scene, with a lens of its own.
std::string scene_with(const std::string& camera) {
  return "Camera \"realistic\" \"string lensfile\" \"" + std::string(PETZVAL_TEST_DATA) +
         "/../../data/lenses/dgauss-50mm.json\" " + camera +
         "\nFilm \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 12\nWorldBegin\n"
         "LightSource \"infinite\"\n";
}

struct Scenes {
  test::Scratch scratch;

  RenderRequest request(const std::string& text = wall) const {
    RenderRequest request{.scene = scratch.with("scene.pbrt", text)};
    request.camera.lens = read_lens("dgauss-50mm").lens;
    request.camera.focus = Focus::at_m(1.4);
    request.columns = 32, request.rows = 24;
    request.wavelengths_nm = {500, 600};
    request.samples_per_pixel = 8;
    return request;
  }
  RenderRequest as_in_scene(const std::string& camera) const {
    RenderRequest request{.scene = scratch.with("scene.pbrt", scene_with(camera)), .focus_as_in_scene = true};
    request.wavelengths_nm = {550};
    return request;
  }
};

std::vector<float> values(const Rendering& rendering) {
  return {rendering.irradiance.values().begin(), rendering.irradiance.values().end()};
}

TEST(RenderScene, SaysWhereItsLightComesFrom) {
  const Scenes scenes;
  Context context;
  context.seed = 7;
  const Rendering picture = render_scene(scenes.request(), context);
  EXPECT_EQ(picture.irradiance.columns(), 32);
  ASSERT_TRUE(picture.irradiance.lens);
  EXPECT_EQ(picture.irradiance.lens->name, read_lens("dgauss-50mm").lens.name);
  const std::string& said = picture.irradiance.provenance;
  EXPECT_NE(said.find("scene.pbrt through Double Gauss"), std::string::npos) << said;
  EXPECT_NE(said.find("8 samples a pixel, seed 7"), std::string::npos) << said;
}

TEST(RenderScene, SaysThatItsLightIsDenoised) {
  const Scenes scenes;
  RenderRequest request = scenes.request();
  request.denoise_light = true;
  const Rendering picture = render_scene(request);
  EXPECT_TRUE(picture.denoised);
  EXPECT_NE(picture.irradiance.provenance.find("denoised by non-local means"), std::string::npos);
  EXPECT_FALSE(picture.first_surfaces);  // which nobody asked for
}

TEST(RenderScene, GivesTheSameBytesInOneStepAndInTwoOnAnyThreads) {
  const Scenes scenes;
  Context one, two;
  one.threads = 1, two.threads = 2;
  const PreparedScene prepared = prepare_scene(scenes.request(), one);
  EXPECT_EQ(values(render_scene(prepared, one)), values(render_scene(scenes.request(), two)));
}

TEST(RenderScene, TakesAnotherLensWithoutReadingTheSceneAgain) {
  const Scenes scenes;
  PreparedScene moved = prepare_scene(scenes.request());
  RenderRequest far = scenes.request();
  far.camera.focus = Focus::at_m(3);
  const PreparedScene there = prepare_scene(far);
  EXPECT_LT(there.film_distance_mm(), moved.film_distance_mm());
  moved.lens = there.lens;
  EXPECT_EQ(values(render_scene(moved)), values(render_scene(there)));
}

TEST(RenderScene, FocusesAsItsFileSaysOrAsItIsAsked) {
  const Scenes scenes;
  // The assignment of 2006 places the film, pbrt says what is sharp, in scene units of 1 m.
  EXPECT_EQ(prepare_scene(scenes.as_in_scene("\"float filmdistance\" 39.5")).film_distance_mm(), 39.5);
  const double at_2_m = prepare_scene(scenes.as_in_scene("\"float focusdistance\" 2")).film_distance_mm();
  RenderRequest asked = scenes.as_in_scene("\"float filmdistance\" 39.5");
  asked.focus_as_in_scene = false;
  asked.camera.focus = Focus::at_m(2);
  EXPECT_EQ(prepare_scene(asked).film_distance_mm(), at_2_m);
  asked.camera.focus = Focus::design();
  EXPECT_EQ(prepare_scene(asked).film_distance_mm(),
            read_lens("dgauss-50mm").lens.surfaces.back().thickness_mm);
  asked.camera.image_distance_mm = 40;
  EXPECT_EQ(prepare_scene(asked).film_distance_mm(), 40);
}

TEST(RenderScene, RefusesWhatPlacesTheFilmTwice) {
  const Scenes scenes;
  RenderRequest twice = scenes.request();
  twice.camera.image_distance_mm = 40;
  EXPECT_THROW(prepare_scene(twice), InputError);
  RenderRequest zone = scenes.request();
  zone.autofocus.zones = {{0, 1, 0, 1}};
  EXPECT_THROW(prepare_scene(zone), InputError);
  RenderRequest stop = scenes.request();
  stop.camera.f_number = 4, stop.aperture_diameter_mm = 3;
  EXPECT_THROW(prepare_scene(stop), InputError);
}

TEST(RenderScene, NamesWhatBelongsToALens) {
  const Scenes scenes;
  const auto refusal = [&](const std::function<void(RenderRequest&)>& set) -> std::string {
    RenderRequest request = scenes.request();
    request.camera = {};
    set(request);
    try {
      prepare_scene(request);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal([](RenderRequest&) {}), "") << "an ideal camera has no focus to be automatic";
  EXPECT_NE(refusal([](RenderRequest& r) { r.camera.focus = Focus::at_m(1); }).find("`focus`"),
            std::string::npos);
  EXPECT_NE(refusal([](RenderRequest& r) { r.camera.f_number = 4; }).find("`f_number`"), std::string::npos);
  EXPECT_NE(refusal([](RenderRequest& r) { r.camera.losses.fresnel = true; }).find("`losses`"),
            std::string::npos);
}

TEST(RenderScene, ListsWhatItDoesNotKnowWithItsPlace) {
  const Scenes scenes;
  const std::vector<UnsupportedFeature> list =
      unsupported_features(scenes.request("WorldBegin\nMaterial \"hair\"\nShape \"nurbs\"\n"));
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].line, 2);
  EXPECT_EQ(list[1].line, 3);
  EXPECT_FALSE(list[0].path);
  EXPECT_NE(list[0].place.find("scene.pbrt:2:1"), std::string::npos);
  EXPECT_NE(list[0].what.find("hair"), std::string::npos);
}

TEST(Autofocus, FindsTheParaxialFocusOfAWallAndPlacesTheFilmThere) {
  const Scenes scenes;
  RenderRequest request = scenes.request();
  request.columns = 96, request.rows = 72;
  const double exact_mm = prepare_scene(request).film_distance_mm();
  request.camera.focus = Focus::automatic();
  PreparedScene scene = prepare_scene(request);
  ASSERT_TRUE(scene.wants_autofocus());
  const FocusRun run = autofocus(scene);
  EXPECT_FALSE(scene.wants_autofocus());
  EXPECT_EQ(scene.film_distance_mm(), run.result.film_distance_mm);
  // Within the depth of focus, which spherical aberration at f/2 shares.
  EXPECT_NEAR(run.result.film_distance_mm, exact_mm, run.depth_mm);
  EXPECT_LE(run.result.evaluations.size(), 12U);
  // Rendering focuses by itself where nobody has, to the same place.
  request.samples_per_pixel = 1;
  EXPECT_EQ(values(render_scene(request)), values([&] {
              PreparedScene few = scene;
              few.request.samples_per_pixel = 1;
              return render_scene(few);
            }()));
}

TEST(Autofocus, RefusesIdealCamerasAndFilmsThatArePlaced) {
  const Scenes scenes;
  RenderRequest request = scenes.request();
  request.camera.image_distance_mm = 38;
  request.camera.focus = Focus::automatic();
  EXPECT_THROW(autofocus(request), InputError);
  request.camera = {};
  EXPECT_THROW(autofocus(request), InputError);
}

/// Stops at the given question.
Context stopping(int at, int& questions) {
  Context context;
  questions = 0;
  context.progress = [at, &questions](double, const std::string&) { return ++questions < at; };
  return context;
}

TEST(RenderScene, StopsWhereverItIsAskedAndLeavesNothing) {
  const Scenes scenes;
  RenderRequest request = scenes.request();
  request.checkpoint = scenes.scratch.path("checkpoint");
  int questions = 0;
  for (const int at : {1, 2, 3}) {
    EXPECT_THROW(render_scene(request, stopping(at, questions)), Cancelled) << at;
    EXPECT_GE(questions, at);
  }
  request.camera.focus = Focus::automatic();
  EXPECT_THROW(autofocus(request, stopping(4, questions)), Cancelled);
  std::filesystem::remove(request.scene);
  EXPECT_TRUE(scenes.scratch.is_empty());
}

TEST(RenderScene, GivesThePictureSoFarWhenItIsStopped) {
  const Scenes scenes;
  RenderRequest request = scenes.request();
  request.checkpoint = scenes.scratch.path("checkpoint");
  request.checkpoint_seconds = 0;
  request.samples_per_pixel = 64;
  const PreparedScene scene = prepare_scene(request);
  Context context;
  // The first pass of sixteen is done when the second has begun.
  context.progress = [](double fraction, const std::string&) { return fraction < 1.5 / 16; };
  std::optional<Rendering> so_far;
  PictureWatch watch;
  watch.show = [&](const Rendering& picture, bool stopped) {
    EXPECT_TRUE(stopped);
    so_far = picture;
  };
  EXPECT_THROW(render_scene(scene, context, watch), Cancelled);
  ASSERT_TRUE(so_far);
  EXPECT_EQ(so_far->samples_per_pixel, 4);
  EXPECT_NE(so_far->irradiance.provenance.find("4 samples a pixel"), std::string::npos);
  const Rendering resumed = render_scene(scene);
  request.checkpoint.clear();
  EXPECT_EQ(values(resumed), values(render_scene(request)));
}

}  // namespace
}  // namespace petzval
