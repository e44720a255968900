// SPDX-License-Identifier: BSD-3-Clause
// Masks, boxes, poses and flow of three-dimensional items.
#include <gtest/gtest.h>
#include <petzval/base/parallel.h>
#include <petzval/base/whole_file.h>
#include <petzval/dataset/dataset.h>
#include <petzval/dataset/object_masks.h>
#include <petzval/dataset/tar_file.h>

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "scratch.h"

namespace petzval {
namespace {

using nlohmann::json;
using test::Scratch;

constexpr double ball_z = 2, ball_radius = 0.3;

/// A ball before a wall, through a pinhole.
const char* const ball = R"(LookAt 0 0 0  0 0 1  0 1 0
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 64 "integer yresolution" 48 "float diagonal" 20
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Shape "bilinearmesh" "point3 P" [ -9 -9 5   9 -9 5   -9 9 5   9 9 5 ]
AttributeBegin
Translate 0.1 0.05 2
Shape "sphere" "float radius" 0.3
AttributeEnd
)";

TEST(ObjectMasks, OfABallAreTheCircleThatGeometrySays) {
  const Scratch scratch;
  RenderRequest request{.scene = scratch.with("ball.pbrt", ball), .focus_as_in_scene = true};
  request.wavelengths_nm = {550};
  const ObjectMasks masks = object_masks(segments_seen(prepare_scene(request)));
  ASSERT_EQ(masks.columns, 64);
  const double focal_px = 24 / std::tan(std::atan(1) / 3);
  // Seen within its angle about the direction of its middle.
  const std::array<double, 3> to{0.1, 0.05, ball_z};
  const double away = std::hypot(to[0], to[1], to[2]), least = std::sqrt(1 - std::pow(ball_radius / away, 2));
  std::size_t pixels = 0, near_edge = 0;
  for (int row = 0; row < 48; ++row)
    for (int column = 0; column < 64; ++column) {
      const double x = (column + 0.5 - 32) / focal_px, y = -(row + 0.5 - 24) / focal_px;
      const double cosine = (x * to[0] + y * to[1] + to[2]) / (away * std::sqrt(x * x + y * y + 1));
      const int number = masks.values[2 * static_cast<std::size_t>(row * 64 + column)];
      pixels += number == 2 ? 1 : 0;
      // A millionth of a radian from the edge single precision decides.
      if (std::abs(cosine - least) < 1e-6)
        ++near_edge;
      else
        EXPECT_EQ(number, cosine > least ? 2 : 0) << column << "," << row;
    }
  EXPECT_LT(near_edge, 3u);
  ASSERT_EQ(masks.objects.size(), 2u);
  EXPECT_EQ(masks.objects[0].pixels + masks.objects[1].pixels, 64u * 48);
  EXPECT_EQ(masks.objects[1].pixels, pixels);
  EXPECT_EQ(masks.objects[0].columns, 64);
}

/// The files of a set's only part.
std::map<std::string, std::string> members_of(const std::string& folder) {
  TarReader archive(folder + "/part-00000.tar");
  std::map<std::string, std::string> files;
  std::string name, bytes;
  while (archive.next(name, bytes)) files[name] = bytes;
  return files;
}

template <typename Value>
std::vector<Value> values_of(const std::string& npy, std::size_t count) {
  std::vector<Value> values(count);
  std::memcpy(values.data(), npy.data() + npy.size() - count * sizeof(Value), count * sizeof(Value));
  return values;
}

TEST(Dataset, ItemsSayThatTheirLightIsDenoised) {
  const Scratch scratch;
  scratch.with("ball.pbrt", ball);
  std::string text = R"({"format": "petzval-dataset/1", "items": 1,
    "parameters": {"lens": "dgauss-50mm", "world": "ball.pbrt", "sensor": "example-vga", "focus_distance_m": 2},
    "sensor_set": ["columns=32", "rows=24", "pitch_um=800"], "wavelengths_nm": "500,600", "samples_per_pixel": 8,
    "denoise_light": true})";
  make_dataset(read_recipe(scratch.with("recipe.json", text)), scratch.path("set"));
  const auto files = members_of(scratch.path("set"));
  EXPECT_EQ(json::parse(files.at("0000000.json")).at("denoised"), true);
  // Only rendered light has noise that a denoiser takes out.
  text.replace(text.find("\"world\": \"ball.pbrt\""), 20, "\"scene\": \"colorchecker\"");
  EXPECT_THROW(parse_recipe(text, "recipe.json", ""), InputError);
}

// Worlds are built once, under a lock, by loops that wait for other threads: whoever builds one must not
// begin another item meanwhile, which would ask for the same lock.
TEST(Dataset, ManyThreadsMakeItemsOfManyWorlds) {
  const Scratch scratch;
  const std::string text = ball, shape = "Shape \"sphere\"";
  json names = json::array();
  for (int i = 0; i < 8; ++i) {
    names.push_back("ball" + std::to_string(i) + ".pbrt");
    // The table of a coating's albedo is such a loop.
    const std::string material =
        "Material \"coateddiffuse\" \"float eta\" " + std::to_string(1.3 + 0.05 * i) + "\n";
    std::string world = text;
    scratch.with(names.back().get<std::string>(), world.insert(world.find(shape), material));
  }
  const Recipe recipe =
      read_recipe(scratch.with("recipe.json", R"({"format": "petzval-dataset/1", "items": 32,
    "parameters": {"lens": "dgauss-50mm", "world": {"choose": )" +
                                                  names.dump() + R"(}, "sensor": "example-vga",
      "focus_distance_m": 2},
    "sensor_set": ["columns=32", "rows=24", "pitch_um=800"], "wavelengths_nm": "550", "samples_per_pixel": 1})"));
  make_dataset(recipe, scratch.path("one"), {}, {.threads = 1});
  const ThreadLimit eight(8);
  make_dataset(recipe, scratch.path("set"), {}, {.threads = 8});
  EXPECT_EQ(members_of(scratch.path("set")), members_of(scratch.path("one")));
}

TEST(Dataset, ItemsOfAWorldHaveMasksBoxesPosesAndFlow) {
  const Scratch scratch;
  scratch.with("ball.pbrt", ball);
  const std::string path = scratch.with("recipe.json", R"({"format": "petzval-dataset/1", "items": 2,
    "parameters": {"lens": "dgauss-50mm", "world": "ball.pbrt", "sensor": "example-vga", "focus_distance_m": 2,
      "camera_x": {"uniform": [-0.1, 0.1]}, "camera_y": 0, "camera_z": 0, "look_x": 0, "look_y": 0, "look_z": 2,
      "camera_move_x": 0.02, "camera_move_y": 0, "camera_move_z": 0, "look_move_x": 0.02, "look_move_y": 0,
      "look_move_z": 0, "rolling_shutter": {"uniform": [0, 0.9]}},
    "sensor_set": ["columns=64", "rows=48", "pitch_um=400"], "wavelengths_nm": "500,600", "samples_per_pixel": 8,
    "truth": ["depth", "masks", "flow", "rays", "sharp"]})");
  const Recipe recipe = read_recipe(path);
  make_dataset(recipe, scratch.path("set"), {}, {.threads = 2});
  make_dataset(recipe, scratch.path("again"), {}, {.threads = 1});
  const auto files = members_of(scratch.path("set"));
  EXPECT_EQ(files, members_of(scratch.path("again")));
  for (const std::string key : {"0000000", "0000001"}) {
    ASSERT_TRUE(files.contains(key + ".sharp.png"));
    const json facts = json::parse(files.at(key + ".json"));
    const auto masks = values_of<std::int32_t>(files.at(key + ".masks.npy"), 2 * 64 * 48);
    std::size_t seen = 0, boxed = 0;
    for (const json& each : facts.at("objects")) {
      const auto [left, top, columns, rows] = each.at("box_px").get<std::array<int, 4>>();
      std::size_t pixels = 0;
      bool touches_left = false, touches_bottom = false;
      for (int row = 0; row < 48; ++row)
        for (int column = 0; column < 64; ++column) {
          if (masks[2 * static_cast<std::size_t>(row * 64 + column)] != each.at("object").get<int>())
            continue;
          ++pixels;
          boxed += column >= left && column < left + columns && row >= top && row < top + rows ? 1 : 0;
          touches_left |= column == left, touches_bottom |= row == top + rows - 1;
        }
      EXPECT_TRUE(touches_left && touches_bottom);
      EXPECT_EQ(pixels, each.at("pixels").get<std::size_t>());
      seen += pixels;
    }
    EXPECT_EQ(facts.at("objects").size(), 2u);
    EXPECT_EQ(seen, boxed);
    EXPECT_EQ(seen, 64u * 48);
    // The camera stands where it was drawn, and ends where it was moved.
    const auto pose = [&](const char* name) {
      return facts.at("camera").at(name).get<std::array<std::array<double, 4>, 4>>();
    };
    const double x = facts.at("parameters").at("camera_x");
    EXPECT_NEAR(pose("world_from_camera")[0][3], x, 1e-12);
    EXPECT_NEAR(pose("world_from_camera_at_end")[0][3], x + 0.02, 1e-12);
    // 50 mm on pixels of 400 µm, focused at 2 m: the image lies 2.6 % further away.
    const json& intrinsics = facts.at("intrinsics");
    EXPECT_NEAR(intrinsics.at("fx_px").get<double>(), 50.36 / 0.4 * 1.026, 0.03 * 130);
    EXPECT_LT(intrinsics.at("worst_px").get<double>(), 0.05);
    // The ball is nearer than the wall, and moves more: by the ratio of their distances from the pupil.
    const auto flow = values_of<float>(files.at(key + ".flow.npy"), 2 * 64 * 48);
    const auto depth = values_of<float>(files.at(key + ".depth.npy"), 64 * 48);
    const double exposure = 1 - facts.at("parameters").at("rolling_shutter").get<double>();
    for (const std::size_t at : {std::size_t{24 * 64 + 2}, std::size_t{23 * 64 + 35}}) {
      const double expected =
          -intrinsics.at("fx_px").get<double>() * 0.02 * exposure / (static_cast<double>(depth[at]) - 0.05);
      EXPECT_NEAR(static_cast<double>(flow[2 * at]), expected, 0.05 * std::abs(expected)) << at;
    }
  }
}

}  // namespace
}  // namespace petzval
