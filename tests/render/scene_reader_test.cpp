// SPDX-License-Identifier: BSD-3-Clause
// What the reader of pbrt scenes understands, and how it says what it does not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "scene_text.h"
#include "scratch.h"

namespace petzval::render {
namespace {

/// The message with which a scene is refused; empty if it is not.
std::string complaint(const std::string& text) {
  try {
    Unsupported unsupported;
    const SceneDescription scene = parse_scene_description(text, "s.pbrt", unsupported);
    build_world(scene, WavelengthGroups({550}), {}, unsupported);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string in_world(const std::string& text) {
  return complaint("WorldBegin\n" + text);
}

void expect_refused(const std::string& message, const std::string& place, const std::string& part) {
  EXPECT_EQ(message.rfind(place, 0), 0u) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(SceneReader, NamesFileLineAndColumn) {
  expect_refused(in_world("  Shape \"sphere\" \"float radius\" -1"), "s.pbrt:2:18: ", "above 0");
  expect_refused(in_world("Shap \"sphere\""), "s.pbrt:2:1: ", "Shape");
  expect_refused(in_world("Shape \"sphere"), "s.pbrt:2:7: ", "closing");
  expect_refused(in_world("Translate 1 2"), "s.pbrt:2:1: ", "3 numbers");
  expect_refused(in_world("Translate 1 2 x"), "s.pbrt:2:15: ", "3 numbers");
  expect_refused(in_world("Shape \"sphere\" \"float radius\" [ 1 2 ]"), "s.pbrt:2:16: ", "2 values");
  expect_refused(in_world("Shape \"sphere\" \"float radius\" [ 1"), "s.pbrt:2:31: ", "not closed");
  expect_refused(in_world("Shape \"sphere\" \"float radius\" nan"), "s.pbrt:2:16: ", "finite");
  expect_refused(in_world("Shape \"sphere\" \"speed radius\" 1"), "s.pbrt:2:16: ", "no type");
  expect_refused(in_world("Shape \"sphere\" \"float radius\" 1 \"float radius\" 2"),
                 "s.pbrt:2:33: ", "twice");
  expect_refused(in_world("AttributeBegin\nShape \"sphere\""), "s.pbrt:2:1: ", "AttributeEnd");
  expect_refused(in_world("AttributeEnd"), "s.pbrt:2:1: ", "without");
  expect_refused(in_world("NamedMaterial \"gold\""), "s.pbrt:2:1: ", "gold");
  expect_refused(in_world("ObjectInstance \"car\""), "s.pbrt:2:1: ", "car");
  expect_refused(in_world("CoordSysTransform \"tree\""), "s.pbrt:2:1: ", "tree");
  expect_refused(in_world("Include \"missing-file.pbrt\""), "s.pbrt:2:1: ", "missing-file.pbrt");
  expect_refused(in_world("Material \"diffuse\" \"texture reflectance\" \"wood\""), "s.pbrt:2:20: ", "wood");
  expect_refused(in_world("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"none.png\""),
                 "s.pbrt:2:35: ", "none.png");
  expect_refused(in_world("Shape \"plymesh\" \"string filename\" \"none.ply\""), "s.pbrt:2:17: ", "none.ply");
  expect_refused(in_world("Material \"diffuse\" \"rgb reflectance\" [ 1 2 0 ]"), "s.pbrt:2:20: ", "exceed 1");
  expect_refused(complaint("LookAt 0 0 0 1 0 0 0 1 0"), "s.pbrt: ", "WorldBegin");
  expect_refused(complaint("Shape \"sphere\""), "s.pbrt:1:1: ", "before WorldBegin");
}

TEST(SceneReader, RefusesLightsThatAreNone) {
  expect_refused(in_world("LightSource \"point\" \"rgb I\" [ 1e300 1 1 ]"),
                 "s.pbrt:2:21: ", "would be right");
  expect_refused(in_world("LightSource \"point\" \"float scale\" -1"), "s.pbrt:2:1: ", "would be right");
  expect_refused(in_world("LightSource \"spot\" \"point3 to\" [ 0 0 0 ]"), "s.pbrt:2:1: ", "no direction");
}

TEST(SceneReader, RefusesSingularTransformations) {
  expect_refused(in_world("Scale 1 0 1"), "s.pbrt:2:1: ", "singular");
  expect_refused(in_world("LookAt 0 0 0  0 0 0  0 1 0"), "s.pbrt:2:1: ", "sees nothing");
  expect_refused(in_world("LookAt 0 0 0  0 1 0  0 1 0"), "s.pbrt:2:1: ", "sees nothing");
  expect_refused(in_world("Rotate 30 0 0 0"), "s.pbrt:2:1: ", "axis");
  expect_refused(in_world("ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 nan 0 0 0 0 1 ]"), "s.pbrt:2:1: ", "finite");
  expect_refused(in_world("ConcatTransform [ 1 1 0 0 1 1 0 0 0 0 1 0 0 0 0 1 ]"), "s.pbrt:2:1: ", "singular");
  EXPECT_EQ(in_world("Scale 1e-6 1e-6 1e-6\nShape \"sphere\""), "");  // small is not singular
}

TEST(SceneReader, RefusesMeshesThatMakeNoSense) {
  const std::string p = "\"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] ";
  expect_refused(in_world("Shape \"trianglemesh\" " + p + "\"integer indices\" [ 0 1 3 ]"),
                 "s.pbrt:2:55: ", "vertex 3");
  expect_refused(in_world("Shape \"trianglemesh\" " + p + "\"integer indices\" [ 0 1 -1 ]"),
                 "s.pbrt:2:55: ", "vertex -1");
  expect_refused(in_world("Shape \"trianglemesh\" " + p + "\"integer indices\" [ 0 1 ]"),
                 "s.pbrt:2:1: ", "multiple of 3");
  expect_refused(in_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 nan 1 0 0 0 1 0 ]"),
                 "s.pbrt:2:22: ", "finite");
  expect_refused(in_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 1e300 1 0 0 0 1 0 ]"),
                 "s.pbrt:2:1: ", "finite");
  expect_refused(in_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 ]"), "s.pbrt:2:22: ", "multiple of 3");
  expect_refused(in_world("Shape \"trianglemesh\" " + p + "\"normal N\" [ 0 0 1 ]"),
                 "s.pbrt:2:1: ", "normals");
  EXPECT_EQ(in_world("Shape \"trianglemesh\" " + p), "");
}

/// What other files hold is told with their name, and where the scene names them.
TEST(SceneReader, TellsWhereFilesAreNamedThatCannotBeUsed) {
  const test::Scratch scratch;
  const std::filesystem::path folder = scratch.folder();
  std::ofstream(folder / "nan.ply")
      << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
         "y\nproperty float z\nelement face 1\nproperty list uchar int "
         "vertex_indices\nend_header\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n";
  std::ofstream(folder / "words.spd") << "400 one 500 two\n";
  std::ofstream(folder / "empty.png");
  const auto refused = [&](const std::string& text) {
    try {
      Unsupported unsupported;
      const SceneDescription scene =
          parse_scene_description("WorldBegin\n" + text, (folder / "s.pbrt").string(), unsupported);
      build_world(scene, WavelengthGroups({550}), {}, unsupported);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string scene = (folder / "s.pbrt").string();
  expect_refused(refused("Shape \"plymesh\" \"string filename\" \"nan.ply\""), scene + ":2:17: ", "nan.ply");
  expect_refused(refused("Shape \"plymesh\" \"string filename\" \"empty.png\""),
                 scene + ":2:17: ", "empty.png");
  expect_refused(refused("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"empty.png\""),
                 scene + ":2:35: ", "empty.png");
  expect_refused(refused("LightSource \"infinite\" \"string filename\" \"none.exr\""),
                 scene + ":2:24: ", "none.exr");
  expect_refused(refused("LightSource \"infinite\" \"spectrum L\" \"none.spd\""),
                 scene + ":2:24: ", "none.spd");
  expect_refused(refused("LightSource \"infinite\" \"spectrum L\" \"words.spd\""),
                 (folder / "words.spd").string() + ":1:5: ", "number");
  const std::string p = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] ";
  expect_refused(refused(p + "\"normal N\" [ 0 0 1 0 nan 1 0 0 1 ]"), scene + ":2:55: ", "finite");
  expect_refused(refused(p + "\"point2 uv\" [ 0 0 1 inf 0 1 ]"), scene + ":2:55: ", "finite");
}

TEST(SceneReader, FindsIncludesThatIncludeThemselves) {
  const test::Scratch scratch;
  const std::filesystem::path folder = scratch.folder();
  std::ofstream(folder / "a.pbrt") << "WorldBegin\nInclude \"b.pbrt\"\n";
  std::ofstream(folder / "b.pbrt") << "\n  Include \"a.pbrt\"\n";
  try {
    Unsupported unsupported;
    read_scene_description((folder / "a.pbrt").string(), unsupported);
    FAIL() << "a cyclic include was followed";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("b.pbrt:2:3: "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("includes itself"), std::string::npos) << error.what();
  }
}

TEST(SceneReader, ListsEverythingThatIsNotSupported) {
  Unsupported unsupported(true);
  const SceneDescription scene = parse_scene_description(
      "WorldBegin\nMaterial \"hair\"\nShape \"nurbs\"\nShape \"sphere\" \"float "
      "alpha\" "
      "0.5\n"
      "LightSource \"portal\"\nMakeNamedMedium \"fog\" \"string type\" \"cloud\"\n",
      "s.pbrt", unsupported);
  build_world(scene, WavelengthGroups({550}), {}, unsupported);
  std::vector<std::string> list;
  for (const Complaint& each : unsupported.list()) list.push_back(each.at.text() + " " + each.what);
  EXPECT_EQ(list, (std::vector<std::string>{"s.pbrt:2:1 Material \"hair\"", "s.pbrt:6:1 a medium \"cloud\"",
                                            "s.pbrt:3:1 Shape \"nurbs\"",
                                            "s.pbrt:4:16 the parameter \"float alpha\" of Shape \"sphere\"",
                                            "s.pbrt:5:1 LightSource \"portal\""}));
}

TEST(SceneReader, NamesWhatDirectivesOfOlderVersionsAreNow) {
  expect_refused(complaint("WorldBegin\nVolume \"grid\""), "s.pbrt:2:1: ", "now MakeNamedMedium");
  Unsupported all(true);
  const SceneDescription scene = parse_scene_description(
      "SurfaceIntegrator \"path\" \"integer maxdepth\" [5]\nRenderer \"sampler\"\nWorldBegin\nVolume "
      "\"grid\"\n"
      "Shape \"sphere\"\nWorldEnd\n",
      "s.pbrt", all);
  EXPECT_EQ(all.list().size(), 1U);
  EXPECT_EQ(scene.shapes.size(), 1U);
  EXPECT_EQ(in_world("Shape \"sphere\"\nWorldEnd"), "");
}

TEST(SceneReader, FollowsTransformationsAndBlocks) {
  const SceneDescription scene = described(
      "AttributeBegin\nTranslate 1 2 3\nScale 2 2 2\nCoordinateSystem \"there\"\nShape "
      "\"sphere\"\nAttributeEnd\n"
      "Shape \"sphere\"\nCoordSysTransform \"there\"\nReverseOrientation\nShape \"sphere\"\n"
      "ObjectBegin \"o\"\nShape \"disk\"\nObjectEnd\nObjectInstance \"o\"\n"
      "Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  5 6 7 1 ]\nShape \"sphere\"",
      "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\"");
  ASSERT_EQ(scene.shapes.size(), 4u);
  const Vector3 p = scene.shapes[0].world_from_object.point({1, 0, 0});
  EXPECT_DOUBLE_EQ(p.x, 3);
  EXPECT_DOUBLE_EQ(p.y, 2);
  EXPECT_DOUBLE_EQ(scene.shapes[1].world_from_object.point({1, 0, 0}).x, 1);
  EXPECT_DOUBLE_EQ(scene.shapes[2].world_from_object.point({1, 0, 0}).x, 3);
  EXPECT_TRUE(scene.shapes[2].reverse_orientation);
  EXPECT_DOUBLE_EQ(scene.shapes[3].world_from_object.point({0, 0, 0}).y, 6);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.instances.size(), 1u);
  // The eye is at the camera's origin, the target ahead of it along +z.
  EXPECT_NEAR(length(scene.camera_from_world.point({0, 0, -5})), 0, 1e-15);
  EXPECT_NEAR(scene.camera_from_world.point({0, 0, 0}).z, 5, 1e-15);
  EXPECT_NEAR(scene.camera_from_world.point({1, 0, 0}).x, 1, 1e-15);
}

/// Text that is cut off anywhere, or has any one byte replaced, is read or refused with a message; it never
/// ends the program.
// Half-way from rest to 2 to the right, a quarter turn about z and twice as large: 1, an eighth turn, 1.5.
TEST(SceneReader, ShowsWhatMovesAsItIsAtATime) {
  const std::string text =
      "TransformTimes 1 3\nWorldBegin\nAttributeBegin\nActiveTransform EndTime Translate 2 0 0 Rotate 90 0 0 "
      "1\n"
      "Scale 2 2 2 ActiveTransform All\nShape \"sphere\"\nAttributeEnd\nShape \"sphere\"\n";
  const auto at = [&](double time) {
    Unsupported unsupported;
    return parse_scene_description(text, "s.pbrt", unsupported, time);
  };
  EXPECT_TRUE(at(0).moves);
  const auto seen = [&](double time) { return at(time).shapes[0].world_from_object.point({1, 0, 0}); };
  const double eighth = 1.5 * std::sqrt(0.5);
  const std::pair<double, Vector3> expected[] = {
      {0, {1, 0, 0}}, {1, {1, 0, 0}}, {2, {1 + eighth, eighth, 0}}, {3, {2, 2, 0}}, {9, {2, 2, 0}}};
  for (const auto& [time, place] : expected) EXPECT_NEAR(length(seen(time) - place), 0, 1e-12) << time;
  EXPECT_NEAR(length(at(2).shapes[1].world_from_object.point({1, 0, 0}) - Vector3{1, 0, 0}), 0, 0);
  Unsupported unsupported;
  EXPECT_FALSE(parse_scene_description("WorldBegin\nShape \"sphere\"", "s.pbrt", unsupported).moves);
  expect_refused(in_world("ActiveTransform Never"), "s.pbrt:2:1: ", "EndTime");
  expect_refused(in_world("TransformTimes 0 1"), "s.pbrt:2:1: ", "WorldBegin");
  expect_refused(complaint("TransformTimes 1 1\nWorldBegin"), "s.pbrt:1:1: ", "increase");
}

TEST(SceneReader, SurvivesDamagedText) {
  const std::string text =
      "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n"
      "Texture \"c\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ 1 1 1 ]\nMakeNamedMaterial \"m\" \"string "
      "type\" "
      "\"mix\" \"string materials\" [ \"m\" \"m\" ]\nObjectBegin \"o\"\nShape \"trianglemesh\" \"point3 P\" "
      "[ 0 0 0 1 0 0 0 1 0 ]\nObjectEnd\nObjectInstance \"o\"\nLightSource \"infinite\"\n";
  for (std::size_t i = 0; i < text.size(); ++i) {
    complaint(text.substr(0, i));
    for (const char byte : {'\0', '"', '[', ']', '9', '-', '#', '\n', '\xff'}) {
      std::string damaged = text;
      damaged[i] = byte;
      const std::string message = complaint(damaged);
      EXPECT_EQ(message.find_first_of("\n\r"), std::string::npos);
    }
  }
}

TEST(Ply, ReadsTextAndBothByteOrders) {
  const std::string head =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  const TriangleMesh text =
      parse_ply("ply\nformat ascii 1.0\n" + head + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", "m.ply");
  EXPECT_EQ(text.triangles.size(), 2u);
  std::string little = "ply\nformat binary_little_endian 1.0\n" + head,
              big = "ply\nformat binary_big_endian 1.0\n" + head;
  const auto put = [](std::string& bytes, auto value, bool swap) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (swap) std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
  };
  for (std::string* bytes : {&little, &big}) {
    for (const float value : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f})
      put(*bytes, value, bytes == &big);
    bytes->push_back(4);
    for (const std::int32_t index : {0, 1, 2, 3}) put(*bytes, index, bytes == &big);
    const TriangleMesh mesh = parse_ply(*bytes, "m.ply");
    EXPECT_EQ(mesh.positions, text.positions);
    EXPECT_EQ(mesh.triangles, text.triangles);
    for (std::size_t cut = 0; cut < bytes->size(); ++cut)
      EXPECT_THROW(parse_ply(std::string_view(*bytes).substr(0, cut), "m.ply"), InputError);
  }
}

TEST(Ply, BelievesNoCount) {
  EXPECT_THROW(
      parse_ply(
          "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nproperty float y\nproperty "
          "float z\nend_header\n0 0 0\n",
          "m.ply"),
      InputError);
  EXPECT_THROW(
      parse_ply(
          "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n900000 0 0\n",
          "m.ply"),
      InputError);
  const auto with_last_count = [](const std::string& count) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "property list double float more\nelement face 1\nproperty list uchar int vertex_indices\n"
           "end_header\n0 0 0 0\n1 0 0 0\n0 1 0 " +
           count + "\n3 0 1 2\n";
  };
  EXPECT_EQ(parse_ply(with_last_count("0"), "m.ply").triangles.size(), 1u);
  EXPECT_THROW(parse_ply(with_last_count("1e300"), "m.ply"), InputError);
}

}  // namespace
}  // namespace petzval::render
