// SPDX-License-Identifier: BSD-3-Clause
// Scenes in glTF: the same pictures as pbrt's words for them, and the light that its units promise.
#include "gltf_scenes.h"

#include <petzval/base/units.h>
#include <petzval/colour/observer.h>

#include <cmath>

namespace petzval::render {
namespace {

using nlohmann::json;

SpectralImage picture_of(const SceneDescription& scene, int columns, int rows, int samples,
                         std::vector<double> wavelengths_nm) {
  Unsupported unsupported;
  CameraChoice choice;
  choice.columns = columns, choice.rows = rows;
  const SceneCamera camera = set_up_camera(scene, choice, unsupported);
  const WavelengthGroups groups(std::move(wavelengths_nm));
  const auto world = build_world(scene, groups, {}, unsupported);
  RenderOptions options;
  options.samples_per_pixel = samples;
  return render_picture(*world, *camera.make(groups), camera.world_from_camera, camera.film, options)
      .irradiance;
}

/// The same, told by hand.
std::string room_in_pbrt(const std::string& texture) {
  const auto metres = [](const char* where, const char* what, const char* light = "") {
    return std::string("AttributeBegin\n") + light + where + "NamedMaterial \"" + what + "\"\n" +
           "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0 1 1 0 ] \"integer indices\" [ 0 1 3 "
           "0 3 2 ]\n"
           "\"point2 uv\" [ 0 0 1 0 0 1 1 1 ]\nAttributeEnd\n";
  };
  std::string text = "Scale 1 1 -1\nTranslate 0 0 -6\nCamera \"perspective\" \"float fov\" " +
                     std::to_string(degrees(2 * half_view)) + "\nWorldBegin\n";
  text += "Texture \"picture\" \"spectrum\" \"imagemap\" \"string filename\" \"" + texture + "\"\n";
  text += R"(MakeNamedMaterial "floor" "string type" "diffuse" "texture reflectance" "picture"
MakeNamedMaterial "metal" "string type" "conductor" "rgb reflectance" [ 0.9 0.6 0.3 ] "float roughness" 0.25 "bool remaproughness" false
MakeNamedMaterial "paint" "string type" "coateddiffuse" "rgb reflectance" [ 0.2 0.3 0.7 ] "float roughness" 0.16 "bool remaproughness" false
  "bool throughcoating" true
MakeNamedMaterial "foil" "string type" "conductor" "rgb reflectance" [ 0.2 0.3 0.7 ] "float roughness" 0.16 "bool remaproughness" false
MakeNamedMaterial "glossy" "string type" "mix" "string materials" [ "paint" "foil" ] "float amount" 0.25
MakeNamedMaterial "lamp" "string type" "conductor" "rgb reflectance" [ 1 1 1 ] "float roughness" 1 "bool remaproughness" false
)";
  text += metres("Scale 1.5 1.25 1\n", "floor") + metres("Translate 0 -1 1 Scale .5 .5 .5\n", "metal");
  text += metres("Translate -1 0 1 Scale .5 .5 .5\n", "glossy") +
          metres("Translate 1 .5 .5 Scale .5 .25 .5\n", "glossy");
  return text +
         metres("Translate 0 0 7 Scale .5 -.5 -1\n", "lamp",
                "AreaLightSource \"diffuse\" \"rgb L\" [ 1 .8 .6 ] \"float scale\" 5.856515373352855\n");
}

TEST(GltfScene, IsThePictureThatPbrtMakesOfIt) {
  // The texture of the pbrt scene has the factor in its numbers: blue at half its light.
  const test::Scratch scratch;
  const std::string path = scratch.path("tiles.png");
  PngImage tiles;
  tiles.columns = 2, tiles.rows = 2, tiles.channels = 3, tiles.bits = 16,
  tiles.transfer = PngTransfer::linear;
  const GltfText gltf = room();
  for (const int level : {255, 0, 0, 40, 200, 40, 90, 90, 255, 240, 240, 240}) {
    const double x = level / 255.0, light = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    const double factor = tiles.samples.size() % 3 == 2 ? 0.5 : 1;
    tiles.samples.push_back(static_cast<std::uint16_t>(std::lround(65535 * factor * light)));
  }
  write_png(path, tiles);
  Unsupported unsupported;
  const SceneDescription pbrt = parse_scene_description(room_in_pbrt(path), "test.pbrt", unsupported);
  const std::vector<double> nm{450, 550, 650};
  const SpectralImage wanted = picture_of(pbrt, 24, 24, 64, nm);
  for (const std::string& bytes : {gltf.text(), gltf.binary()}) {
    const SpectralImage got = picture_of(read_gltf(bytes), 24, 24, 64, nm);
    double mean = 0, apart = 0;
    for (std::size_t i = 0; i < wanted.values().size(); ++i) {
      mean += static_cast<double>(wanted.values()[i]);
      apart += std::abs(static_cast<double>(got.values()[i] - wanted.values()[i]));
    }
    ASSERT_GT(mean, 0);
    // The same samples on the same surfaces: what is left are the 16 bits of the texture, and the few paths
    // that the last digit of the field of view and of instances sends elsewhere.
    EXPECT_LT(apart / mean, 2e-3);
  }
}

// ---- light in glTF's units

std::vector<double> visible_nm() {
  std::vector<double> nm;
  for (int each = 380; each <= 780; each += 10) nm.push_back(each);
  return nm;
}

/// cd/m² in the middle of what a pinhole 4 m before a white wall sees; its picture is radiance times 1 sr.
double luminance_of(GltfText gltf, int samples = 256) {
  gltf.add_node({{"camera", 0}, {"translation", {0, 0, 4}}});
  gltf.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.001}, {"aspectRatio", 1}, {"znear", 0.1}}}}};
  const std::vector<double> nm = visible_nm();
  const SpectralImage picture = picture_of(read_gltf(gltf.text()), 1, 1, samples, nm);
  const std::vector<Xyz> weights = Observer::cie_1931().weights(nm);
  double y = 0;
  for (int band = 0; band < picture.bands(); ++band)
    y += static_cast<double>(picture.band(band)[0]) * weights[static_cast<std::size_t>(band)].y;
  return 683 * y;
}

json light_of(int index) {
  return {{"KHR_lights_punctual", {{"light", index}}}};
}

// Sums over bands of 10 nm from 380 to 780 nm hold D65's luminance to 0.1 %; light of points has no noise.
constexpr double photometric = 2e-3;

TEST(GltfScene, CandelasLightAWallByTheSquareOfTheDistance) {
  GltfText gltf = wall(0.5);
  const int lamp = gltf.add_light({{"type", "point"}, {"intensity", 300}});
  gltf.add_node({{"translation", {1.5, 0, 2}}, {"extensions", light_of(lamp)}});
  const double cos = 0.8, distance2 = 6.25;
  const double wanted = 0.5 / pi * 300 * cos / distance2;
  EXPECT_NEAR(luminance_of(gltf) / wanted, 1, photometric);
}

TEST(GltfScene, ASpotShinesAlongItsNodesMinusZ) {
  GltfText gltf = wall(0.5);
  const int lamp =
      gltf.add_light({{"type", "spot"}, {"intensity", 300}, {"spot", {{"outerConeAngle", 0.1}}}});
  gltf.add_node({{"translation", {0, 0, 2}}, {"extensions", light_of(lamp)}});
  EXPECT_NEAR(luminance_of(gltf) / (0.5 / pi * 300 / 4), 1, photometric);
  gltf.json["nodes"].back()["rotation"] = {0, 1, 0, 0};  // half a turn about y: away from the wall
  EXPECT_EQ(luminance_of(gltf), 0);
  gltf.json["nodes"].back()["rotation"] = {0, std::sin(0.1), 0, std::cos(0.1)};  // 0.2: beside the cone
  EXPECT_EQ(luminance_of(gltf), 0);
}

TEST(GltfScene, LuxFallFromAfar) {
  GltfText gltf = wall(0.5);
  const int sun = gltf.add_light({{"type", "directional"}, {"intensity", 1000}});
  gltf.add_node(
      {{"rotation", {std::sin(radians(30)), 0, 0, std::cos(radians(30))}}, {"extensions", light_of(sun)}});
  // Turned by 60 degrees about x; the node's place does not matter.
  EXPECT_NEAR(luminance_of(gltf) / (0.5 / pi * 1000 * 0.5), 1, photometric);
}

TEST(GltfScene, EmissionIsInNits) {
  GltfText gltf;
  const int glowing =
      gltf.add_material({{"emissiveFactor", {0.5, 0.5, 0.5}},
                         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 200}}}}}});
  gltf.add_node({{"mesh", gltf.add_mesh(gltf.square(glowing))}});
  EXPECT_NEAR(luminance_of(gltf) / 100, 1, photometric);
  gltf.json["nodes"][0]["rotation"] = {0, 1, 0, 0};  // its back is dark, unless it has two sides
  EXPECT_EQ(luminance_of(gltf), 0);
  gltf.json["materials"][0]["doubleSided"] = true;
  EXPECT_NEAR(luminance_of(gltf) / 100, 1, photometric);
}

}  // namespace
}  // namespace petzval::render
