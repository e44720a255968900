// SPDX-License-Identifier: BSD-3-Clause
// What is refused of glTF, and what is said of what is not supported.
#include "gltf_scenes.h"

#include <filesystem>

namespace petzval::render {
namespace {

using nlohmann::json;

std::vector<std::string> unsupported_in(const std::string& bytes) {
  Unsupported unsupported(true);
  build_world(parse_gltf_scene(bytes, "s.gltf", unsupported), WavelengthGroups({550}), {}, unsupported);
  std::vector<std::string> list;
  for (const Complaint& each : unsupported.list()) list.push_back(each.at.text() + ": " + each.what);
  return list;
}

TEST(GltfRefusals, NamesTheEntryThatIsWrong) {
  const auto with = [](const char* pointer, const json& value) {
    GltfText gltf = room();
    gltf.json[json::json_pointer(pointer)] = value;
    return refusal(gltf.text());
  };
  EXPECT_EQ(refusal(room().text()), "");
  expect_refused(with("/scene", 5), "scene: ", "there are 1");
  expect_refused(with("/nodes/1/mesh", 77), "nodes[1].mesh: ", "meshes[77]");
  expect_refused(with("/nodes/1/children", {1}), "nodes[1].children[0]: ", "one parent");
  expect_refused(with("/nodes/1/children", {50}), "nodes[1].children[0]: ", "nodes[50]");
  expect_refused(with("/nodes/1/scale", {1, 0, 1}), "nodes[1]: ", "singular");
  expect_refused(with("/nodes/1/translation", {1, 0}), "nodes[1].translation: ", "3 would be right");
  expect_refused(with("/nodes/1/rotation", {0, 0, 0, 0}), "nodes[1]: ", "quaternion");
  expect_refused(with("/nodes/0/camera", 3), "nodes[0].camera: ", "cameras[3]");
  expect_refused(with("/cameras/0/perspective/yfov", -1), "cameras[0].perspective.yfov: ", "above 0");
  expect_refused(with("/meshes/0/primitives/0/indices", 99),
                 "is no sound glTF: ", "indices accessor out of bounds");
  expect_refused(with("/meshes/0/primitives/0/indices", 0),
                 "meshes[0].primitives[0].indices: ", "1 would be right");
  expect_refused(with("/meshes/0/primitives/0/attributes/POSITION", 1),
                 "meshes[0].primitives[0].attributes.POSITION: ", "3 would be right");
  expect_refused(with("/meshes/0/primitives/0/material", 9),
                 "meshes[0].primitives[0].material: ", "materials[9]");
  expect_refused(with("/accessors/0/count", 1000000000000), "accessors[0]: ", "more than");
  expect_refused(with("/accessors/0/byteOffset", 4), "accessors[0]: ", "more than");
  expect_refused(with("/accessors/0/componentType", 5124), "accessors[0].componentType: ", "5124");
  expect_refused(with("/bufferViews/1/byteLength", 1 << 20), "bufferViews[1]: ", "more than");
  expect_refused(with("/bufferViews/1/buffer", 2), "bufferViews[1]: ", "buffers[2]");
  expect_refused(with("/materials/0/pbrMetallicRoughness/baseColorTexture/index", 4),
                 "materials[0].pbrMetallicRoughness.baseColorTexture.index: ", "textures[4]");
  expect_refused(with("/materials/1/pbrMetallicRoughness/roughnessFactor", 1.5),
                 "materials[1].pbrMetallicRoughness.roughnessFactor: ", "0 to 1");
  expect_refused(with("/textures/0/source", 7), "textures[0].source: ", "images[7]");
  expect_refused(with("/bufferViews/0/byteLength", 30), "images[0]: ", "PNG");
  expect_refused(with("/asset/version", "1.0"), "asset.version: ", "2.0");
  expect_refused(refusal("{"), "", "glTF");
  expect_refused(refusal("{\"asset\":{\"version\":\"2.0\"},\"scenes\":" + std::string(100000, '[')), "",
                 "deep");
}

TEST(GltfRefusals, RefusesDamagedBinaries) {
  const std::string whole = room().binary();
  EXPECT_EQ(refusal(whole), "");
  for (const std::size_t length : {std::size_t{5}, std::size_t{19}, std::size_t{40}, whole.size() - 1})
    expect_refused(refusal(whole.substr(0, length)), "is no sound binary glTF", "");
  std::string lying = whole;  // the last chunk says that it is longer by the length of its own header
  const std::size_t json_size =
      static_cast<unsigned char>(lying[12]) + 256u * static_cast<unsigned char>(lying[13]);
  lying[20 + json_size] = static_cast<char>(lying[20 + json_size] + 8);
  expect_refused(refusal(lying), "is no sound binary glTF", "cut off");
}

TEST(GltfRefusals, ReadsNoFilesFromElsewhere) {
  const test::Scratch scratch;
  const std::filesystem::path folder = scratch.folder() / "gltf_folder";
  std::filesystem::create_directories(folder / "in");
  GltfText gltf = wall(0.5);
  std::ofstream(folder / "part.bin", std::ios::binary) << gltf.bytes;
  std::ofstream(folder / "in" / "a part.bin", std::ios::binary) << gltf.bytes;
  const auto with_uri = [&](const std::string& uri) {
    try {
      Unsupported unsupported;
      const SceneDescription scene =
          parse_gltf_scene(gltf.with_buffer(uri).dump(), (folder / "s.gltf").string(), unsupported);
      return std::to_string(scene.files.size()) + " files";
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(with_uri("part.bin"), "2 files");
  EXPECT_EQ(with_uri("in/a%20part.bin"), "2 files");
  for (const std::string uri : {"../gltf_folder/part.bin", "https://example.org/part.bin", "file:part.bin",
                                "in/../part.bin", "%2e%2e/gltf_folder/part.bin", "none.bin"}) {
    const std::string said = with_uri(uri);
    EXPECT_NE(said.find("s.gltf: buffers[0].uri: "), std::string::npos) << uri << ": " << said;
  }
  EXPECT_NE(with_uri((folder / "part.bin").string()).find("buffers[0].uri: "), std::string::npos);
}

TEST(GltfRefusals, ListsAllThatIsNotSupported) {
  GltfText gltf = room();
  gltf.json["materials"][0]["extensions"]["KHR_materials_iridescence"] = {{"iridescenceFactor", 1}};
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_1"] = 0;
  gltf.json["meshes"][1]["primitives"][0]["mode"] = 1;
  gltf.json["extensionsRequired"] = {"KHR_texture_transform", "KHR_draco_mesh_compression"};
  gltf.json["nodes"][1]["skin"] = 0;
  const std::vector<std::string> wanted{
      "s.gltf: extensionsRequired[1]: the extension KHR_draco_mesh_compression",
      "s.gltf: nodes[1].skin: a skin that bones move",
      "s.gltf: materials[0].extensions.KHR_materials_iridescence: this extension",
      "s.gltf: meshes[0].primitives[0].attributes.COLOR_1: a second colour for every vertex"};
  EXPECT_EQ(unsupported_in(gltf.text()), wanted);
  expect_refused(refusal(gltf.text()), "extensionsRequired[1]: ", "not supported");
}

TEST(GltfRefusals, LeavesPointsAndLinesOutWithANote) {
  GltfText gltf = room();
  const std::size_t all = read_gltf(gltf.text()).shapes.size();
  gltf.json["meshes"][1]["primitives"][0]["mode"] = 1;
  const SceneDescription scene = read_gltf(gltf.text());
  EXPECT_LT(scene.shapes.size(), all);
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("meshes[1].primitives[0]: points or lines"), std::string::npos);
}

/// KHR_texture_transform: scaled, turned anticlockwise, moved, v counted downwards.
TEST(GltfTextures, AreTurnedAsTheExtensionSays) {
  GltfText gltf = room();
  const double turn = 0.4, sx = 2, sy = 3, ox = 0.1, oy = 0.2;
  auto& texture = gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  texture["index"] = 0;
  texture["extensions"]["KHR_texture_transform"] = {
      {"offset", {ox, oy}}, {"scale", {sx, sy}}, {"rotation", turn}};
  const SceneDescription scene = read_gltf(gltf.text());
  ASSERT_FALSE(scene.textures.empty());
  const Parameters& made = scene.textures[0].entity.parameters;
  const auto number = [&](const char* name) { return made.number(name, 0); };
  for (const double u : {0.0, 0.3, 1.0})
    for (const double v : {0.0, 0.6, 1.0}) {
      // Anticlockwise as one looks at u to the right and v downwards: (1, 0) goes to (cos, −sin).
      const double x = std::cos(turn) * sx * u + std::sin(turn) * sy * v + ox,
                   y = -std::sin(turn) * sx * u + std::cos(turn) * sy * v + oy;
      const double up = 1 - v;
      EXPECT_NEAR(number("uscale") * u + number("sfromv") * up + number("udelta"), x, 1e-12);
      EXPECT_NEAR(number("vscale") * up + number("tfromu") * u + number("vdelta"), 1 - y, 1e-12);
    }
}

TEST(GltfRefusals, ABodyNeedsAColourAndADistance) {
  const auto message = [](nlohmann::json volume) {
    GltfText gltf;
    gltf.add_node({{"mesh", gltf.add_mesh(gltf.square(gltf.add_material(
                                {{"extensions",
                                  {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                   {"KHR_materials_volume", std::move(volume)}}}})))}});
    return refusal(gltf.text());
  };
  const std::string at = "materials[0].extensions.KHR_materials_volume.";
  expect_refused(message({{"attenuationColor", {0.5, 2, 0.5}}}), at + "attenuationColor",
                 "3 numbers from 0 to 1");
  expect_refused(message({{"attenuationDistance", 0}}), at + "attenuationDistance", "a number above 0");
  expect_refused(message({{"thicknessFactor", -1}}), at + "thicknessFactor", "a number from 0");
}

}  // namespace
}  // namespace petzval::render
