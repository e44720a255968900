// SPDX-License-Identifier: BSD-3-Clause
// Materials and textures of glTF.
#include "gltf_scenes.h"

#include <petzval/render/materials/fresnel.h>
#include <petzval/render/pbrt/entity_maker.h>

#include <cmath>

namespace petzval::render {
namespace {

using nlohmann::json;

/// What a material gives back of light from one direction: the mean weight of its samples.
double albedo_of(const SceneDescription& scene, double cos) {
  Unsupported unsupported;
  const WavelengthGroups groups({550});
  const auto world = build_world(scene, groups, {}, unsupported);
  const Material& material = world->materials.back();
  const Bsdf bsdf = material.bsdf({}, 0, 0);
  double sum = 0;
  constexpr std::uint32_t samples = 1 << 14;
  for (std::uint32_t i = 0; i < samples; ++i) {
    SobolSample sample(3, i);
    const auto [choice, u, v, none] = sample.next4();
    (void)none;
    const auto chosen = bsdf.sample({std::sqrt(1 - cos * cos), 0, cos}, choice, u, v);
    if (chosen) sum += static_cast<double>(chosen->weight[0]) / samples;
  }
  return sum;
}

/// glTF 2.0, B.3.5: a dielectric reflects F, and of the rest that enters the base colour comes back.
TEST(GltfMaterials, PaintGivesBackItsBaseColourOfWhatItsCoatingLetsIn) {
  for (const double ior : {1.5, 1.3})
    for (const double base : {0.1, 0.5, 1.0})
      for (const double cos : {1.0, 0.5, 0.2}) {
        GltfText gltf;
        const int paint = gltf.add_material(
            {{"pbrMetallicRoughness",
              {{"metallicFactor", 0}, {"roughnessFactor", 0}, {"baseColorFactor", {base, base, base, 1}}}},
             {"extensions", {{"KHR_materials_ior", {{"ior", ior}}}}}});
        gltf.add_node({{"mesh", gltf.add_mesh(gltf.square(paint))}});
        const double reflected = dielectric_reflectance(cos, ior);
        // 2^14 Sobol points, and the smooth spectrum of a grey to a few in a thousand.
        EXPECT_NEAR(albedo_of(read_gltf(gltf.text()), cos), reflected + (1 - reflected) * base, 4e-3)
            << ior << " " << base << " " << cos;
      }
}

/// A coat of lacquer on half of a metal: its mirror over the metal's, as light goes through them to and fro.
TEST(GltfMaterials, AClearCoatLiesOnAsMuchAsItsFactorSays) {
  for (const double factor : {1.0, 0.5})
    for (const double cos : {1.0, 0.3}) {
      GltfText gltf;
      const int metal = gltf.add_material(
          {{"pbrMetallicRoughness", {{"roughnessFactor", 0}, {"baseColorFactor", {0.5, 0.5, 0.5, 1}}}},
           {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", factor}}}}}});
      gltf.add_node({{"mesh", gltf.add_mesh(gltf.square(metal))}});
      Unsupported unsupported;
      const auto world = build_world(read_gltf(gltf.text()), WavelengthGroups({550}), {}, unsupported);
      const Vector3 wo{std::sqrt(1 - cos * cos), 0, cos};
      double sum = 0;
      for (int i = 0; i < 100; ++i)
        sum +=
            static_cast<double>(material_at(world->materials, static_cast<int>(world->materials.size()) - 1,
                                            {}, 0, (i + 0.5) / 100)
                                    .bsdf({}, 0, 0)
                                    .sample(wo, 0.5, 0.5, 0.5)
                                    ->weight[0]) /
            100;
      // Half at normal incidence: n = 1, k = 2 (pbrt-v4).
      const double front = dielectric_reflectance(cos, 1.5);
      const double base = conductor_reflectance(std::sqrt(1 - (1 - cos * cos) / 2.25), 1 / 1.5, 2 / 1.5);
      const double coated = front + (1 - front) * (1 - front) * base / (1 - front * base);
      EXPECT_NEAR(sum, factor * coated + (1 - factor) * conductor_reflectance(cos, 1.0, 2.0), 5e-3);
    }
}

TEST(GltfMaterials, AClearCoatHasItsOwnRoughnessAndTextures) {
  GltfText gltf;
  const int texture = gltf.add_texture(png_of(1, 1, 3, {51, 102, 0}));
  const int paint =
      gltf.add_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.9}}},
                         {"extensions",
                          {{"KHR_materials_clearcoat",
                            {{"clearcoatFactor", 0.5},
                             {"clearcoatTexture", {{"index", texture}}},
                             {"clearcoatRoughnessFactor", 0.5},
                             {"clearcoatRoughnessTexture", {{"index", texture}}}}}}}});
  gltf.add_node({{"mesh", gltf.add_mesh(gltf.square(paint))}});
  Unsupported unsupported;
  const auto world = build_world(read_gltf(gltf.text()), WavelengthGroups({550}), {}, unsupported);
  const Material& mix = world->materials.back();
  ASSERT_EQ(mix.kind, Material::Kind::mix);
  EXPECT_NEAR(mix.mix_amount->at({}, 0), 0.5 * 51 / 255, 1e-6);
  EXPECT_NEAR(world->materials[static_cast<std::size_t>(mix.mixed[0])].roughness_u->at({}, 0), 0.81, 1e-6);
  EXPECT_NEAR(world->materials[static_cast<std::size_t>(mix.mixed[1])].roughness_u->at({}, 0),
              std::pow(0.5 * 102 / 255, 2), 1e-6);
  gltf.json["materials"][0]["extensions"]["KHR_materials_clearcoat"]["clearcoatNormalTexture"] = {
      {"index", texture}};
  Unsupported list(true);
  parse_gltf_scene(gltf.text(), "s.gltf", list);
  ASSERT_EQ(list.list().size(), 1u);
  EXPECT_EQ(list.list()[0].at.text() + ": " + list.list()[0].what,
            "s.gltf: materials[0].extensions.KHR_materials_clearcoat.clearcoatNormalTexture: a coat whose "
            "normals are not those of what it covers");
  gltf.json["materials"][0]["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatTexture", 3}};
  EXPECT_THROW(read_gltf(gltf.text()), InputError);
}

TEST(GltfMaterials, SheenHasColourAndRoughnessOfItsOwn) {
  GltfText gltf;
  const int colour = gltf.add_texture(png_of(1, 1, 3, {255, 255, 255})),
            alpha = gltf.add_texture(png_of(1, 1, 4, {0, 0, 0, 102}));
  const int cloth = gltf.add_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                                       {"extensions",
                                        {{"KHR_materials_sheen",
                                          {{"sheenColorFactor", {0.5, 0.5, 0.5}},
                                           {"sheenColorTexture", {{"index", colour}}},
                                           {"sheenRoughnessFactor", 0.5},
                                           {"sheenRoughnessTexture", {{"index", alpha}}}}}}}});
  gltf.add_node({{"mesh", gltf.add_mesh(gltf.square(cloth))}});
  Unsupported unsupported;
  const auto world = build_world(read_gltf(gltf.text()), WavelengthGroups({550}), {}, unsupported);
  const Material& material = world->materials.back();
  ASSERT_TRUE(material.sheen);
  EXPECT_NEAR(static_cast<double>(material.sheen_colour->at({}, 0)[0]), 0.5, 2e-3);
  EXPECT_NEAR(material.sheen_roughness->at({}, 0), 0.5 * 102 / 255, 1e-6);
  nlohmann::json& extensions = gltf.json["materials"][0]["extensions"];
  extensions["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1}};
  Unsupported list(true);
  parse_gltf_scene(gltf.text(), "s.gltf", list);
  ASSERT_EQ(list.list().size(), 1u);
  EXPECT_EQ(list.list()[0].what, "sheen below a clear coat");
  extensions["KHR_materials_sheen"]["sheenColorFactor"] = {2, 0, 0};
  EXPECT_THROW(read_gltf(gltf.text()), InputError);
}

TEST(GltfMaterials, MetalnessAndRoughnessComeFromBlueAndGreen) {
  GltfText gltf;
  const int texture = gltf.add_texture(png_of(1, 1, 3, {9, 128, 64}));
  const int material = gltf.add_material({{"pbrMetallicRoughness",
                                           {{"roughnessFactor", 0.5},
                                            {"metallicFactor", 0.5},
                                            {"metallicRoughnessTexture", {{"index", texture}}}}}});
  gltf.add_node({{"mesh", gltf.add_mesh(gltf.square(material))}});
  Unsupported unsupported;
  const auto world = build_world(read_gltf(gltf.text()), WavelengthGroups({550}), {}, unsupported);
  const Material& mix = world->materials.back();
  ASSERT_EQ(mix.kind, Material::Kind::mix);
  EXPECT_NEAR(mix.mix_amount->at({}, 0), 0.5 * 64 / 255, 1e-6);
  const Material& metal = world->materials[static_cast<std::size_t>(mix.mixed[1])];
  ASSERT_EQ(metal.kind, Material::Kind::conductor);
  EXPECT_FALSE(metal.remap_roughness);
  EXPECT_NEAR(metal.roughness_u->at({}, 0), std::pow(0.5 * 128 / 255, 2), 1e-6);
}

TEST(GltfMaterials, GlassIsASheetOrABody) {
  GltfText gltf;
  gltf.add_node({{"mesh", gltf.add_mesh(gltf.square(gltf.add_material(
                              {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
                               {"extensions",
                                {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                 {"KHR_materials_ior", {{"ior", 1.7}}}}}})))}});
  EXPECT_EQ(read_gltf(gltf.text()).materials.back().type, "thindielectric");
  gltf.json["materials"][0]["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0.1}};
  const SceneDescription body = read_gltf(gltf.text());
  EXPECT_EQ(body.materials.back().type, "dielectric");
  EXPECT_EQ(body.materials.back().parameters.number("eta", 0), 1.7);
}

/// A pane of index 1, two squares that look away from each other, `thick` apart, before an even sky.
PathLight through_pane(json volume, double thick, double ior = 1) {
  GltfText gltf;
  const int glass =
      gltf.add_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
                         {"extensions",
                          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                           {"KHR_materials_ior", {{"ior", ior}}},
                           {"KHR_materials_volume", std::move(volume)}}}});
  const int square = gltf.add_mesh(gltf.square(glass));
  // Twice as large than written: distances are those of the world.
  gltf.add_node({{"mesh", square}, {"scale", {2, 2, 2}}, {"translation", {0, 0, thick / 2}}});
  gltf.add_node({{"mesh", square}, {"rotation", {1, 0, 0, 0}}, {"translation", {0, 0, -thick / 2}}});
  SceneDescription scene = read_gltf(gltf.text());
  scene.lights.push_back({EntityMaker("infinite", {}).made(), {}});
  Unsupported unsupported;
  const auto world = build_world(scene, WavelengthGroups({450, 550, 650}), {}, unsupported);
  SobolSample sample(1, 0);
  PathLight light = PathTracer(*world, {}).trace({0.1, 0.2, 5}, {0, 0, -1}, 0, 0, sample);
  const Lanes sky = world->lights.sky({}, {0, 0, -1}, 0);
  for (int lane = 0; lane < lane_count; ++lane) light.shared[lane] /= sky[lane];
  return light;
}

TEST(GltfMaterials, ABodyTakesLightByItsDepth) {
  constexpr double smooth_grey = 5e-3;  // of the spectrum that stands for a grey
  const auto grey = [](double distance, double thick, double factor = 0.1) {
    return static_cast<double>(through_pane({{"thicknessFactor", factor},
                                             {"attenuationColor", {0.5, 0.5, 0.5}},
                                             {"attenuationDistance", distance}},
                                            thick)
                                   .shared[1]);
  };
  EXPECT_NEAR(grey(2, 2), 0.5, smooth_grey);
  EXPECT_NEAR(grey(2, 1), std::sqrt(0.5), smooth_grey);
  EXPECT_NEAR(grey(0.5, 1), 0.25, smooth_grey);
  EXPECT_NEAR(grey(2, 2, 0), 1, 1e-6);  // a sheet without thickness
  const PathLight amber = through_pane(
      {{"thicknessFactor", 1}, {"attenuationColor", {0.9, 0.5, 0.05}}, {"attenuationDistance", 1}}, 1);
  EXPECT_GT(amber.shared[2], 0.8f);
  EXPECT_LT(amber.shared[0], 0.15f);
  EXPECT_NEAR(static_cast<double>(
                  through_pane({{"thicknessFactor", 1}, {"attenuationColor", {0.5, 0.5, 0.5}}}, 1).shared[1]),
              1,
              1e-6);  // an infinite distance
}

TEST(GltfMaterials, TexturesLieWhereTheirTransformPutsThem) {
  // Four columns, dark to bright, in the upper row; white below.
  const std::string png = png_of(4, 2, 1, {20, 80, 140, 200, 255, 255, 255, 255});
  GltfText gltf;
  const int texture = gltf.add_texture(png);
  gltf.json["samplers"] = {{{"magFilter", 9728}, {"wrapS", 33648}, {"wrapT", 33648}}};
  gltf.json["textures"][0]["sampler"] = 0;
  const json transform{{"KHR_texture_transform", {{"offset", {0.25, 0.125}}, {"scale", {0.5, 0.25}}}}};
  gltf.add_material(
      {{"pbrMetallicRoughness",
        {{"metallicFactor", 0}, {"baseColorTexture", {{"index", texture}, {"extensions", transform}}}}}});
  gltf.add_node({{"mesh", gltf.add_mesh(gltf.square(0))}});
  Unsupported unsupported;
  const SceneDescription scene = read_gltf(gltf.text());
  const WavelengthGroups groups({550});
  const TextureLibrary library(scene, groups, unsupported);
  const auto at = [&](double u, double v_down) {
    const SpectrumTexture texture_of =
        library.spectrum_parameter(scene.materials.back().parameters, "reflectance", SpectrumRole::albedo);
    return static_cast<double>(texture_of->at({{}, u, 1 - v_down}, 0)[0]);
  };
  const auto level = [](int sample) { return std::pow((sample / 255.0 + 0.055) / 1.055, 2.4); };
  constexpr double smooth_grey = 5e-3;                 // of the spectrum that stands for a grey
  EXPECT_NEAR(at(0, 0), level(80), smooth_grey);       // 0.25 → column 1
  EXPECT_NEAR(at(0.6, 0.5), level(140), smooth_grey);  // 0.55 → column 2
  EXPECT_NEAR(at(-0.9, 0), level(20), smooth_grey);    // −0.2: column 0, mirrored
  EXPECT_NEAR(at(-1.1, 0), level(80), smooth_grey);    // −0.3: column 1
  EXPECT_NEAR(at(0, 1.6), 1, smooth_grey);             // 0.525 → the lower row
}

}  // namespace
}  // namespace petzval::render
