// SPDX-License-Identifier: BSD-3-Clause
// Scenes in glTF, written down in tests.
#pragma once

#include <petzval/render/gltf/gltf_scene.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace petzval::render {

inline std::string base64(const std::string& bytes) {
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// A glTF file that grows: its JSON, and one buffer.
struct GltfText {
  nlohmann::json json{{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  std::string bytes;

  GltfText() { json["scenes"] = {{{"nodes", nlohmann::json::array()}}}; }

  int add_view(const std::string& data) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}});
    bytes += data;
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }
  /// \param type  "SCALAR", "VEC2", "VEC3". \return the index of the accessor.
  template <class Number>
  int add(const std::vector<Number>& numbers, const char* type, int component_type, bool normalised = false) {
    const std::size_t each = type[0] == 'S' ? 1 : static_cast<std::size_t>(type[3] - '0');
    std::string data(sizeof(Number) * numbers.size(), 0);
    std::memcpy(data.data(), numbers.data(), data.size());
    json["accessors"].push_back({{"bufferView", add_view(data)},
                                 {"componentType", component_type},
                                 {"count", numbers.size() / each},
                                 {"type", type},
                                 {"normalized", normalised}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int add_floats(const std::vector<float>& numbers, const char* type) { return add(numbers, type, 5126); }

  int add_mesh(nlohmann::json primitive) {
    json["meshes"].push_back({{"primitives", {std::move(primitive)}}});
    return static_cast<int>(json["meshes"].size()) - 1;
  }
  int add_node(nlohmann::json node) {
    json["nodes"].push_back(std::move(node));
    const int index = static_cast<int>(json["nodes"].size()) - 1;
    json["scenes"][0]["nodes"].push_back(index);
    return index;
  }
  int add_material(nlohmann::json material) {
    json["materials"].push_back(std::move(material));
    return static_cast<int>(json["materials"].size()) - 1;
  }
  int add_light(nlohmann::json light) {
    nlohmann::json& lights = json["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(std::move(light));
    return static_cast<int>(lights.size()) - 1;
  }
  /// A picture and a texture of it.
  int add_texture(const std::string& png) {
    json["images"].push_back({{"bufferView", add_view(png)}, {"mimeType", "image/png"}});
    json["textures"].push_back({{"source", json["images"].size() - 1}});
    return static_cast<int>(json["textures"].size()) - 1;
  }
  /// A square of 2 by 2 about the origin in the plane z = 0, facing +z, v downwards.
  nlohmann::json square(int material) {
    return {{"attributes",
             {{"POSITION", add_floats({-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0}, "VEC3")},
              {"TEXCOORD_0", add_floats({0, 1, 1, 1, 0, 0, 1, 0}, "VEC2")}}},
            {"indices", add<std::uint16_t>({0, 1, 3, 0, 3, 2}, "SCALAR", 5123)},
            {"material", material}};
  }

  nlohmann::json with_buffer(const nlohmann::json& uri) const {
    nlohmann::json all = json;
    all["buffers"] = {{{"byteLength", bytes.size()}}};
    if (!uri.is_null()) all["buffers"][0]["uri"] = uri;
    return all;
  }
  std::string text() const {
    return with_buffer("data:application/octet-stream;base64," + base64(bytes)).dump();
  }
  std::string binary() const {
    std::string json_text = with_buffer(nullptr).dump(), data = bytes;
    json_text.resize((json_text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4);
    const auto number = [](std::size_t value) {
      std::string four(4, 0);
      for (std::size_t i = 0; i < 4; ++i) four[i] = static_cast<char>(value >> (8 * i) & 0xFF);
      return four;
    };
    return "glTF" + number(2) + number(28 + json_text.size() + data.size()) + number(json_text.size()) +
           "JSON" + json_text + number(data.size()) + std::string("BIN\0", 4) + data;
  }
};

}  // namespace petzval::render
