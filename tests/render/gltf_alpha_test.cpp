// SPDX-License-Identifier: BSD-3-Clause
// Surfaces that are there in part, and colours of vertices: the light that passes and comes back by
// arithmetic, and the same in pbrt's words.
#include "gltf_scenes.h"

#include <petzval/base/units.h>

#include <cmath>

namespace petzval::render {
namespace {

constexpr int samples = 16384;

/// Radiance in the middle of what a pinhole 4 m before the origin sees, at 550 nm.
double radiance_of(const SceneDescription& scene) {
  Unsupported unsupported;
  CameraChoice choice;
  choice.columns = choice.rows = 1;
  const SceneCamera camera = set_up_camera(scene, choice, unsupported);
  const WavelengthGroups groups({550});
  const auto world = build_world(scene, groups, {}, unsupported);
  RenderOptions options;
  options.samples_per_pixel = samples;
  options.path.max_depth = 1;
  return static_cast<double>(
      render_picture(*world, *camera.make(groups), camera.world_from_camera, camera.film, options)
          .irradiance.band(0)[0]);
}

/// A grey wall at z = 0, a lamp of 300 cd before it, and, between it and both lamp and camera, a black sheet.
struct Sheet {
  GltfText gltf = wall(0.5);
  int material = 0, mesh = 0;

  Sheet() {
    material = gltf.add_material(
        {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {0, 0, 0, 1}}}},
         {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
    mesh = gltf.add_mesh(gltf.square(material));
    gltf.add_node({{"mesh", mesh}, {"translation", {0, 0, 1}}, {"scale", {3, 3, 1}}});
    const int lamp = gltf.add_light({{"type", "point"}, {"intensity", 300}});
    gltf.add_node(
        {{"translation", {1.5, 0, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", lamp}}}}}});
    gltf.add_node({{"camera", 0}, {"translation", {0, 0, 4}}});
    gltf.json["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.001}, {"aspectRatio", 1}, {"znear", 0.1}}}}};
  }
  nlohmann::json& surface() { return gltf.json["materials"][static_cast<std::size_t>(material)]; }
  nlohmann::json& primitive() { return gltf.json["meshes"][static_cast<std::size_t>(mesh)]["primitives"][0]; }
  double radiance() const { return radiance_of(read_gltf(gltf.text())); }
};

double without_sheet() {
  Sheet sheet;
  sheet.gltf.json["nodes"][1]["translation"] = {0, 0, -1};
  return sheet.radiance();
}

/// Two ways through the sheet, each with probability 1 − a: three standard errors of the share p = (1 − a)²
/// are 3 √(p(1 − p)/16384).
void expect_share(double radiance, double opacity) {
  const double p = std::pow(1 - opacity, 2), error = 3 * std::sqrt(p * (1 - p) / samples);
  EXPECT_NEAR(radiance / without_sheet(), p, error + 1e-6) << opacity;
}

TEST(GltfAlpha, BlendedSheetsPassTheirShareOnBothWays) {
  for (const double opacity : {0.25, 0.6}) {
    Sheet sheet;
    sheet.surface()["alphaMode"] = "BLEND";
    sheet.surface()["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, opacity};
    expect_share(sheet.radiance(), opacity);
  }
  Sheet opaque;  // whose alpha counts for nothing
  opaque.surface()["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, 0.25};
  EXPECT_EQ(opaque.radiance(), 0);
}

TEST(GltfAlpha, MasksAreAllOrNothing) {
  for (const auto& [opacity, cutoff, passes] :
       {std::tuple{0.49, 0.5, true}, {0.51, 0.5, false}, {0.3, 0.2, false}, {1.0, 1.5, true}}) {
    Sheet sheet;
    sheet.surface()["alphaMode"] = "MASK";
    sheet.surface()["alphaCutoff"] = cutoff;
    sheet.surface()["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, opacity};
    // Not a single ray is left to chance.
    EXPECT_NEAR(sheet.radiance() / without_sheet(), passes ? 1 : 0, 1e-6) << opacity << " " << cutoff;
  }
}

TEST(GltfAlpha, PicturesAndVerticesHaveOpacityToo) {
  Sheet sheet;
  const int picture = sheet.gltf.add_texture(png_of(1, 1, 4, {0, 0, 0, 128}));
  sheet.surface()["alphaMode"] = "BLEND";
  sheet.surface()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", picture}};
  expect_share(sheet.radiance(), 128 / 255.0);
  sheet.surface()["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, 0.5};
  const double both = 0.5 * 128 / 255;
  expect_share(sheet.radiance(), both);
  sheet.primitive()["attributes"]["COLOR_0"] =
      sheet.gltf.add_floats({1, 1, 1, .5f, 1, 1, 1, .5f, 1, 1, 1, .5f, 1, 1, 1, .5f}, "VEC4");
  expect_share(sheet.radiance(), 0.5 * both);
}

/// COLOR_0 multiplies the base colour, and is linear between vertices.
TEST(GltfAlpha, ColoursOfVerticesTintTheBaseColour) {
  const auto tinted = [](const std::vector<float>& colours, const char* type) {
    Sheet sheet;
    sheet.gltf.json["nodes"][1]["translation"] = {0, 0, -1};
    sheet.gltf.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        sheet.gltf.add_floats(colours, type);
    return sheet.radiance() / without_sheet();
  };
  // A grey's smooth spectrum is a grey to a few in a thousand.
  EXPECT_NEAR(tinted({.4f, .4f, .4f, .4f, .4f, .4f, .4f, .4f, .4f, .4f, .4f, .4f}, "VEC3"), 0.4, 4e-3);
  EXPECT_NEAR(tinted({.4f, .4f, .4f, 0, .4f, .4f, .4f, 0, .4f, .4f, .4f, 0, .4f, .4f, .4f, 0}, "VEC4"), 0.4,
              4e-3)
      << "opaque surfaces have no use for alpha";
  // The middle lies half way between the two vertices of the square's diagonal, dark and bright.
  EXPECT_NEAR(tinted({.2f, .2f, .2f, .2f, .2f, .2f, .8f, .8f, .8f, .8f, .8f, .8f}, "VEC3"), 0.5, 4e-3);
}

/// pbrt says "alpha" of a shape; shadows fall through it as sight does, and what is no boundary casts none.
TEST(Alpha, ShapesOfPbrtAreThereInPart) {
  const auto radiance = [](const std::string& sheet) {
    Unsupported unsupported;
    return radiance_of(parse_scene_description(
        "Scale 1 1 -1\nTranslate 0 0 -4\nCamera \"perspective\" \"float fov\" 0.06\nWorldBegin\n"
        "LightSource \"point\" \"rgb I\" [ 1 1 1 ] \"point3 from\" [ 1.5 0 2 ]\n"
        "Shape \"trianglemesh\" \"point3 P\" [ -2 -2 0  2 -2 0  0 4 0 ] \"integer indices\" [ 0 1 2 ]\n" +
            sheet,
        "test.pbrt", unsupported));
  };
  const std::string mesh =
      "Shape \"trianglemesh\" \"point3 P\" [ -9 -9 1  9 -9 1  0 19 1 ] "
      "\"integer indices\" [ 0 1 2 ] ";
  const std::string black = "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n";
  const double free = radiance("");
  ASSERT_GT(free, 0);
  EXPECT_EQ(radiance(black + mesh), 0);
  // Rays that set out anew from a surface differ in the last digits of a float.
  const double digits = 1e-5 * free;
  EXPECT_NEAR(radiance(black + mesh + "\"float alpha\" 0"), free, digits);
  const double p = 0.49, error = 3 * std::sqrt(p * (1 - p) / samples);
  EXPECT_NEAR(radiance(black + mesh + "\"float alpha\" 0.3") / free, p, error);
  const std::string nothing = "Material \"interface\"\n";
  EXPECT_NEAR(radiance(nothing + mesh), free, digits);
  EXPECT_NEAR(radiance(nothing + "Translate 0 0 1\nShape \"disk\" \"float radius\" 9\n"), free, digits);
}

}  // namespace
}  // namespace petzval::render
