// SPDX-License-Identifier: BSD-3-Clause
// Small scenes in glTF, and what becomes of them.
#pragma once

#include "gltf_text.h"

#include <gtest/gtest.h>
#include <petzval/image/formats/png.h>
#include <petzval/render/camera/scene_camera.h>

#include <fstream>

#include "scene_text.h"
#include "scratch.h"

namespace petzval::render {

inline SceneDescription read_gltf(const std::string& bytes) {
  Unsupported unsupported;
  return parse_gltf_scene(bytes, "test.gltf", unsupported);
}

/// The message with which a file is refused; empty if it is not.
inline std::string refusal(const std::string& bytes) {
  try {
    Unsupported unsupported;
    build_world(parse_gltf_scene(bytes, "s.gltf", unsupported), WavelengthGroups({550}), {}, unsupported);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

inline void expect_refused(const std::string& message, const std::string& place, const std::string& part) {
  EXPECT_EQ(message.rfind("s.gltf: " + place, 0), 0u) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

inline std::string png_of(int columns, int rows, int channels, std::vector<std::uint16_t> samples) {
  const test::Scratch scratch;
  const std::string path = scratch.path("texture.png");
  PngImage image;
  image.columns = columns, image.rows = rows, image.channels = channels;
  image.samples = std::move(samples);
  write_png(path, image);
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A grey square of Lambert's.
inline GltfText wall(double reflectance) {
  GltfText gltf;
  const int matt = gltf.add_material(
      {{"pbrMetallicRoughness",
        {{"metallicFactor", 0}, {"baseColorFactor", {reflectance, reflectance, reflectance, 1}}}},
       {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
  gltf.add_node({{"mesh", gltf.add_mesh(gltf.square(matt))}});
  return gltf;
}

inline constexpr double half_view = 0.3;  // radians

/// A room of squares: a textured floor, a metal wall, two glossy instances, a glass body and a lamp.
inline GltfText room() {
  GltfText gltf;
  const int tiles = gltf.add_texture(png_of(2, 2, 3, {255, 0, 0, 40, 200, 40, 90, 90, 255, 240, 240, 240}));
  const nlohmann::json pbr{
      {"metallicFactor", 0}, {"baseColorTexture", {{"index", tiles}}}, {"baseColorFactor", {1, 1, 0.5, 1}}};
  const nlohmann::json matt{{"KHR_materials_specular", {{"specularFactor", 0}}}};
  const int floor = gltf.add_material({{"pbrMetallicRoughness", pbr}, {"extensions", matt}});
  const int metal = gltf.add_material(
      {{"pbrMetallicRoughness",
        {{"metallicFactor", 1}, {"roughnessFactor", 0.5}, {"baseColorFactor", {0.9, 0.6, 0.3, 1}}}}});
  const int glossy = gltf.add_material(
      {{"pbrMetallicRoughness",
        {{"metallicFactor", 0.25}, {"roughnessFactor", 0.4}, {"baseColorFactor", {0.2, 0.3, 0.7, 1}}}}});
  const int lamp = gltf.add_material(
      {{"emissiveFactor", {1, 0.8, 0.6}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4000}}}}}});
  gltf.add_node({{"camera", 0}, {"translation", {0, 0, 6}}});
  gltf.json["cameras"] = {{{"type", "perspective"},
                           {"perspective", {{"yfov", 2 * half_view}, {"aspectRatio", 1}, {"znear", 0.1}}}}};
  gltf.add_node({{"mesh", gltf.add_mesh(gltf.square(floor))}, {"scale", {1.5, 1.25, 1}}});
  gltf.add_node(
      {{"mesh", gltf.add_mesh(gltf.square(metal))}, {"translation", {0, -1, 1}}, {"scale", {0.5, 0.5, 0.5}}});
  const int card = gltf.add_mesh(gltf.square(glossy));
  gltf.add_node({{"mesh", card}, {"translation", {-1, 0, 1}}, {"scale", {0.5, 0.5, 0.5}}});
  gltf.add_node({{"mesh", card}, {"translation", {1, 0.5, 0.5}}, {"scale", {0.5, 0.25, 0.5}}});
  gltf.add_node({{"mesh", gltf.add_mesh(gltf.square(lamp))},
                 {"matrix", {0.5, 0, 0, 0, 0, -0.5, 0, 0, 0, 0, -1, 0, 0, 0, 7, 1}}});
  return gltf;
}

}  // namespace petzval::render
