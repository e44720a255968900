// SPDX-License-Identifier: BSD-3-Clause
// Scenes in the words of pbrt before version 4 are those of today's words; crop windows are cut out.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/render/camera/scene_camera.h>

#include "scene_text.h"

namespace petzval::render {
namespace {

constexpr const char* old_text =
    "LookAt 0 0.5 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" [40]\n"
    "Film \"image\" \"string filename\" [\"a.exr\"] \"integer xresolution\" [20] \"integer yresolution\" "
    "[10] \"bool "
    "premultiplyalpha\" [\"false\"]\n"
    "Sampler \"bestcandidate\" \"integer pixelsamples\" [4]\nPixelFilter \"mitchell\"\n"
    "SurfaceIntegrator \"path\" \"integer maxdepth\" [3]\nVolumeIntegrator \"emission\" \"float stepsize\" "
    "[1]\n"
    "WorldBegin\n"
    "Texture \"t\" \"color\" \"checkerboard\" \"color tex1\" [.8 .8 .8] \"color tex2\" [.2 .2 .2]\n"
    "AttributeBegin\nAreaLightSource \"area\" \"color L\" [9 9 9] \"integer nsamples\" [4]\nTranslate 0 2 "
    "0\nShape "
    "\"sphere\" \"float radius\" [.3]\nAttributeEnd\n"
    "LightSource \"distant\" \"point from\" [0 10 -4] \"point to\" [0 0 0] \"color L\" [.5 .5 .5]\n"
    "Material \"matte\" \"texture Kd\" \"t\" \"float sigma\" [0]\n"
    "Shape \"trianglemesh\" \"point P\" [-2 -.5 -2 2 -.5 -2 2 -.5 2 -2 -.5 2] \"integer indices\" [0 1 2 0 2 "
    "3]\n"
    "Material \"glass\" \"float index\" [1.4]\nShape \"sphere\" \"float radius\" [.3]\n"
    "Translate .8 0 0\nMaterial \"mirror\" \"color Kr\" [.9 .9 .9]\nShape \"sphere\" \"float radius\" [.3]\n"
    "Translate -1.6 0 0\nMaterial \"plastic\" \"color Kd\" [.1 .2 .6] \"float roughness\" [.1]\nShape "
    "\"sphere\" \"float "
    "radius\" [.3]\nWorldEnd\n";

constexpr const char* new_text =
    "LookAt 0 0.5 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
    "Film \"rgb\" \"integer xresolution\" 20 \"integer yresolution\" 10\nIntegrator \"path\" \"integer "
    "maxdepth\" 3\n"
    "WorldBegin\n"
    "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [.8 .8 .8] \"rgb tex2\" [.2 .2 .2]\n"
    "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [9 9 9]\nTranslate 0 2 0\nShape \"sphere\" "
    "\"float radius\" "
    ".3\nAttributeEnd\n"
    "LightSource \"distant\" \"point3 from\" [0 10 -4] \"point3 to\" [0 0 0] \"rgb L\" [.5 .5 .5]\n"
    "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
    "Shape \"trianglemesh\" \"point3 P\" [-2 -.5 -2 2 -.5 -2 2 -.5 2 -2 -.5 2] \"integer indices\" [0 1 2 0 "
    "2 3]\n"
    "Material \"dielectric\" \"float eta\" 1.4\nShape \"sphere\" \"float radius\" .3\n"
    "Translate .8 0 0\nMaterial \"conductor\" \"rgb reflectance\" [.9 .9 .9]\nShape \"sphere\" \"float "
    "radius\" .3\n"
    "Translate -1.6 0 0\nMaterial \"coateddiffuse\" \"rgb reflectance\" [.1 .2 .6] \"float roughness\" "
    ".1\nShape "
    "\"sphere\" \"float radius\" .3\n";

std::vector<float> picture(const SceneDescription& scene) {
  Unsupported unsupported;
  const auto world = build_world(scene, WavelengthGroups({450, 550, 650}), {}, unsupported);
  const SceneCamera camera = set_up_camera(scene, {}, unsupported);
  RenderOptions options;
  options.samples_per_pixel = 16;
  options.window = camera.crop;
  const Rendering rendering =
      render_picture(*world, *camera.make(world->groups), camera.world_from_camera, camera.film, options, {});
  return {rendering.irradiance.values().begin(), rendering.irradiance.values().end()};
}

SceneDescription parsed(const std::string& text) {
  Unsupported unsupported;
  return parse_scene_description(text, "old.pbrt", unsupported);
}

TEST(OldScene, IsThePictureOfTheSameSceneInTheWordsOfToday) {
  const SceneDescription old = parsed(old_text);
  ASSERT_EQ(old.notes.size(), 1u);
  EXPECT_EQ(old.integrator.parameters.integer("maxdepth", 0), 3);
  EXPECT_EQ(picture(old), picture(parsed(new_text)));
}

TEST(OldScene, StillRefusesWhatHasNoCounterpart) {
  for (const char* word :
       {"Material \"matte\" \"float sigma\" [20]\n", "Material \"glass\" \"color Kt\" [.5 .5 .5]\n",
        "Material \"translucent\"\n", "Volume \"homogeneous\"\n"}) {
    try {
      picture(parsed(std::string("Camera \"perspective\"\nWorldBegin\n") + word +
                     "Shape \"sphere\"\nWorldEnd\n"));
      ADD_FAILURE() << word;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("old.pbrt:3:"), std::string::npos) << error.what();
    }
  }
}

TEST(CropWindow, IsCutOutOfThePicture) {
  const std::string whole_text = new_text;
  const auto cropped = [&](const std::string& parameter) {
    std::string text = whole_text;
    return picture(parsed(text.insert(text.find("\nIntegrator"), " " + parameter)));
  };
  const std::vector<float> whole = picture(parsed(whole_text));
  for (const char* parameter :
       {"\"float cropwindow\" [0.25 0.75 0.2 0.6]", "\"integer pixelbounds\" [5 15 2 6]"}) {
    const std::vector<float> part = cropped(parameter);
    ASSERT_EQ(part.size(), 3u * 10 * 4);
    for (std::size_t band = 0; band < 3; ++band)
      for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 10; ++column)
          EXPECT_EQ(part[(band * 4 + row) * 10 + column], whole[(band * 10 + row + 2) * 20 + column + 5]);
  }
  for (const char* bad : {"\"float cropwindow\" [0.5 0.5 0 1]", "\"float cropwindow\" [0 1 0]",
                          "\"integer pixelbounds\" [30 40 0 10]"})
    EXPECT_THROW(cropped(bad), InputError) << bad;
}

}  // namespace
}  // namespace petzval::render
