// SPDX-License-Identifier: BSD-3-Clause
// Meshes, nodes and cameras of glTF.
#include "gltf_scenes.h"

#include <petzval/base/units.h>

#include <cmath>

namespace petzval::render {
namespace {

using nlohmann::json;

const TriangleMesh& mesh_of(const SceneDescription& scene) {
  return *scene.shapes.at(0).mesh;
}

TEST(GltfMeshes, NumbersMayBeOfEveryType) {
  const auto positions_of = [](auto add) {
    GltfText gltf;
    const int accessor = add(gltf);
    gltf.add_node({{"mesh", gltf.add_mesh({{"attributes", {{"POSITION", accessor}}}})}});
    return mesh_of(read_gltf(gltf.text())).positions;
  };
  const auto expect = [](const std::vector<TriangleMesh::Vertex>& got, double third) {
    ASSERT_EQ(got.size(), 3u);
    EXPECT_FLOAT_EQ(got[1][0], static_cast<float>(third));
    EXPECT_FLOAT_EQ(got[2][1], 1);
  };
  expect(positions_of([](GltfText& g) {
           return g.add<std::int16_t>({0, 0, 0, 10922, 0, 0, 0, 32767, 0}, "VEC3", 5122, true);
         }),
         10922.0 / 32767);
  expect(positions_of([](GltfText& g) {
           return g.add<std::uint16_t>({0, 0, 0, 21845, 0, 0, 0, 65535, 0}, "VEC3", 5123, true);
         }),
         1.0 / 3);
  expect(positions_of([](GltfText& g) {
           return g.add<std::int16_t>({0, 0, 0, -7, 0, 0, 0, 1, 0}, "VEC3", 5122);
         }),
         -7);
  expect(positions_of([](GltfText& g) { return g.add_floats({0, 0, 0, 0.3f, 0, 0, 0, 1, 0}, "VEC3"); }), 0.3);
  // Rows of bytes begin at multiples of four.
  const auto bytes = [](GltfText& g, std::vector<std::int8_t> rows, int type) {
    const int accessor = g.add(rows, "VEC4", type, true);
    g.json["accessors"].back()["type"] = "VEC3";
    g.json["bufferViews"].back()["byteStride"] = 4;
    return accessor;
  };
  expect(positions_of([&](GltfText& g) {
           return bytes(g, {0, 0, 0, 0, -128, 0, 0, 0, 0, 127, 0, 0}, 5120);
         }),
         -1);
  expect(positions_of([&](GltfText& g) {
           return bytes(g, {0, 0, 0, 0, 51, 0, 0, 0, 0, -1, 0, 0}, 5121);
         }),
         0.2);
}

TEST(GltfMeshes, IndicesMakeListsStripsAndFans) {
  const auto triangles_of = [](int mode, auto add_indices) {
    GltfText gltf;
    json primitive = gltf.square(0);
    gltf.add_material(json::object());
    primitive["mode"] = mode;
    primitive["indices"] = add_indices(gltf);
    gltf.add_node({{"mesh", gltf.add_mesh(primitive)}});
    return mesh_of(read_gltf(gltf.text())).triangles;
  };
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;
  const auto bytes = [](GltfText& g) { return g.add<std::uint8_t>({0, 1, 2, 3}, "SCALAR", 5121); };
  const auto words = [](GltfText& g) { return g.add<std::uint32_t>({0, 1, 3, 2}, "SCALAR", 5125); };
  EXPECT_EQ(triangles_of(4, bytes), (Triangles{{0, 1, 2}}));
  EXPECT_EQ(triangles_of(5, bytes), (Triangles{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_EQ(triangles_of(6, words), (Triangles{{1, 3, 0}, {3, 2, 0}}));
}

TEST(GltfMeshes, SparseNumbersStandInForOthers) {
  GltfText gltf;
  const int positions = gltf.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const std::string index("\1", 1);
  std::string value(12, 0);
  const float moved[3] = {4, 5, 6};
  std::memcpy(value.data(), moved, 12);
  gltf.json["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", gltf.add_view(index)}, {"componentType", 5121}}},
      {"values", {{"bufferView", gltf.add_view(value)}}}};
  gltf.add_node({{"mesh", gltf.add_mesh({{"attributes", {{"POSITION", positions}}}})}});
  EXPECT_EQ(mesh_of(read_gltf(gltf.text())).positions[1], (TriangleMesh::Vertex{4, 5, 6}));
  gltf.json["accessors"][0]["sparse"]["count"] = 9;
  expect_refused(refusal(gltf.text()), "accessors[0].sparse.indices: ", "more than");
}

TEST(GltfMeshes, NodesStandWhereTheirParentsPutThem) {
  GltfText gltf;
  gltf.add_material(json::object());
  const int mesh = gltf.add_mesh(gltf.square(0));
  const double s = std::sqrt(0.5);
  gltf.json["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, s, s}}},
                        {{"mesh", mesh}, {"translation", {1, 2, 3}}, {"scale", {2, 3, 4}}}};
  gltf.json["scenes"][0]["nodes"] = {0};
  // A quarter of a turn about z takes x to y and y to −x.
  const Vector3 corner = read_gltf(gltf.text()).shapes.at(0).world_from_object.point({1, 1, 0});
  EXPECT_NEAR(corner.x, 10 - (2 + 3), 1e-12);
  EXPECT_NEAR(corner.y, 1 + 2, 1e-12);
  EXPECT_NEAR(corner.z, 3, 1e-12);
}

TEST(GltfMeshes, LooksAlongMinusZWhereThereIsNoCamera) {
  GltfText gltf = wall(0.5);
  const SceneDescription scene = read_gltf(gltf.text());
  EXPECT_FALSE(scene.has_camera);
  EXPECT_NEAR(length(scene.camera_from_world.inverse().direction({0, 0, 1}) - Vector3{0, 0, -1}), 0, 1e-12);
}

}  // namespace
}  // namespace petzval::render
