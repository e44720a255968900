// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/dataset/dataset.h>
#include <petzval/dataset/tar_file.h>
#include <petzval/lens/lens_file.h>
#include <sys/file.h>
#include <unistd.h>

#include <fmt/format.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scratch.h"

namespace petzval {
namespace {

namespace fs = std::filesystem;
using test::Scratch;

/// Small pictures, so that ten of them take a second; the third lens does not open to f/1.
const char* const recipe_text = R"({"format": "petzval-dataset/1", "items": 7, "items_per_part": 2, "seed": 3,
  "parameters": {"lens": {"choose": ["dgauss-50mm", "edmund-54852"]}, "stop_down_ev": {"uniform": [1, 3]},
    "scene": {"choose": ["grid", "checkerboard:6"]}, "sensor": "example-vga",
    "exposure_compensation_ev": {"normal": [0, 0.5]}},
  "sensor_set": ["columns=48", "rows=32"], "wavelengths_nm": "500,600", "tolerance": 0.02,
  "truth": ["raw", "sharp", "rays"], "psf_grid": {"rows": 1, "columns": 1, "size": 5}})";

Recipe recipe() {
  return parse_recipe(recipe_text, "recipe");
}

std::map<std::string, std::string> files_of(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    files[entry.path().filename().string()] = read_whole_file(entry.path().string());
  return files;
}

TEST(Dataset, ShardsInAnyOrderOnAnyThreadsAreOneRunByteForByte) {
  const Scratch scratch;
  const std::string whole = scratch.path("whole"), parts = scratch.path("parts");
  const DatasetReport made = make_dataset(recipe(), whole, {}, {.threads = 2});
  EXPECT_EQ(made.parts, 4u);
  EXPECT_EQ(made.items, 7u);
  EXPECT_EQ(made.failed, 0u);
  for (const std::size_t shard : {2u, 0u, 1u}) make_dataset(recipe(), parts, {shard, 3}, {.threads = 1});
  const auto expected = files_of(whole);
  EXPECT_EQ(expected.size(), 4u * 3 + 1);
  EXPECT_EQ(files_of(parts), expected);
  EXPECT_TRUE(verify_dataset(whole).empty());
}

TEST(Dataset, GoesOnWhereAProcessWasKilled) {
  const Scratch scratch;
  const std::string folder = scratch.path("set");
  make_dataset(recipe(), folder);
  const auto expected = files_of(folder);
  // Killed in the middle of a part: its sums are missing, an archive stands half-written under another name.
  fs::remove(folder + "/part-00001.json");
  fs::remove(folder + "/part-00002.json");
  fs::remove(folder + "/part-00002.tar");
  std::ofstream(folder + "/.part-00002.tar.making") << "half";
  std::ofstream(folder + "/.part-00001.lock") << "";
  const DatasetReport made = make_dataset(recipe(), folder);
  EXPECT_EQ(made.kept, 2u);
  EXPECT_EQ(made.items, 4u);
  EXPECT_EQ(files_of(folder), expected);
}

TEST(Dataset, APartThatAnotherProcessMakesIsLeftToIt) {
  const Scratch scratch;
  const std::string folder = scratch.path("set");
  fs::create_directories(folder);
  const int lock = ::open((folder + "/.part-00001.lock").c_str(), O_CREAT | O_RDWR, 0644);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  const DatasetReport made = make_dataset(recipe(), folder);
  EXPECT_EQ(made.elsewhere, 1u);
  EXPECT_EQ(made.items, 5u);
  EXPECT_FALSE(fs::exists(folder + "/part-00001.json"));
  ::close(lock);
  EXPECT_EQ(make_dataset(recipe(), folder).items, 2u);
}

TEST(Dataset, VerifyFindsAnyFlippedBit) {
  const Scratch scratch;
  const std::string folder = scratch.path("set");
  Recipe few =
      parse_recipe(std::string(recipe_text).replace(std::string(recipe_text).find("7"), 1, "2"), "recipe");
  make_dataset(few, folder);
  for (const auto& [name, bytes] : files_of(folder))
    for (std::size_t i = 0; i < 23; ++i) {
      std::string altered = bytes;
      altered[i * (bytes.size() - 1) / 22] ^= static_cast<char>(1 << (i % 8));
      write_whole_file(folder + "/" + name, altered);
      bool found = false;
      try {
        found = !verify_dataset(folder).empty();
      } catch (const InputError&) {
        found = true;
      }
      EXPECT_TRUE(found) << name << ", byte " << i * (bytes.size() - 1) / 22;
      write_whole_file(folder + "/" + name, bytes);
    }
  EXPECT_TRUE(verify_dataset(folder).empty());
}

TEST(Dataset, RefusesAnotherRecipeAndAnotherVersion) {
  const Scratch scratch;
  const std::string folder = scratch.path("set"), head = folder + "/dataset.json";
  make_dataset(recipe(), folder, {0, 4});
  Recipe other = recipe();
  other = parse_recipe(
      std::string(recipe_text).replace(std::string(recipe_text).find("\"seed\": 3"), 9, "\"seed\": 4"),
      "recipe");
  EXPECT_THROW(make_dataset(other, folder), InputError);
  std::string text = read_whole_file(head);
  const std::size_t at = text.find("petzval 0");
  ASSERT_NE(at, text.npos);
  text.replace(at, 9, "petzval 9");
  write_whole_file(head, text);
  try {
    make_dataset(recipe(), folder);
    FAIL() << "another version's data set was gone on with";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("petzval 9"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("petzval 0"), std::string::npos);
  }
  EXPECT_THROW(make_dataset(recipe(), folder, {4, 4}), InputError);
}

TEST(Dataset, AnItemThatCannotBeMadeIsRecordedAndTheRestGoesOn) {
  const Scratch scratch;
  std::string text = recipe_text;
  text.replace(text.find("\"stop_down_ev\": {\"uniform\": [1, 3]}"), 35,
               "\"f_number\": {\"choose\": [0.5, 8]}");
  const Recipe some_fail = parse_recipe(text, "recipe");
  const DatasetReport made = make_dataset(some_fail, scratch.path("set"));
  std::size_t expected = 0;
  for (std::size_t i = 0; i < 7; ++i)
    expected += std::get<double>(draw_item(some_fail, i).at("f_number")) < 1 ? 1 : 0;
  ASSERT_GT(expected, 0u);
  ASSERT_LT(expected, 7u);
  EXPECT_EQ(made.failed, expected);
  EXPECT_EQ(made.items, 7u);
  const DatasetState state = dataset_state(scratch.path("set"));
  EXPECT_EQ(state.failed, expected);
  ASSERT_FALSE(state.errors.empty());
  EXPECT_NE(state.errors.front().find("opens to"), std::string::npos) << state.errors.front();
  EXPECT_TRUE(verify_dataset(scratch.path("set")).empty());
}

// The patent's focal lengths at its states, 14.42 mm and 23.29 mm (docs/STATES.md).
TEST(Dataset, ItemsAreZoomedAsTheyWereDrawn) {
  const Scratch scratch;
  std::string text = recipe_text;
  text.replace(text.find("{\"choose\": [\"dgauss-50mm\", \"edmund-54852\"]}"), 43,
               "\"zoom-14-24mm\", \"state\": {\"choose\": [\"wide\", \"tele\"]}");
  text.replace(text.find("\"items\": 7"), 10, "\"items\": 6");
  text.replace(text.find("\"truth\": [\"raw\", \"sharp\", \"rays\"]"), 33, "\"truth\": []");
  const Recipe zoomed = parse_recipe(text, "recipe");
  make_dataset(zoomed, scratch.path("set"), {0, 1}, {.threads = 2});
  std::map<std::string, int> seen;
  for (int part = 0; part < 3; ++part) {
    std::istringstream lines(read_whole_file(fmt::format("{}/part-{:05}.jsonl", scratch.path("set"), part)));
    for (std::string line; std::getline(lines, line);) {
      const nlohmann::json facts = nlohmann::json::parse(line);
      const std::string state = facts.at("parameters").at("state");
      EXPECT_NEAR(facts.at("lens").at("focal_length_mm").get<double>(), state == "wide" ? 14.42 : 23.29,
                  0.01);
      ++seen[state];
    }
  }
  EXPECT_EQ(seen.size(), 2u);
}

// Memory of two threads is that of two items at once.
TEST(Dataset, BuildsByAListOfTolerancesAreThoseOfTheSameGrade) {
  const Scratch scratch;
  const auto part_of = [&](const std::string& name, const std::string& grade, const std::string& list) {
    const Recipe recipe = parse_recipe(
        R"({"format": "petzval-dataset/1", "items": 1, "parameters": {"lens": "edmund-54852", "build": 3, )" +
            grade + R"("scene": "grid", "sensor": "example-vga"}, )" + list +
            R"("sensor_set": ["columns=48", "rows=32"], "wavelengths_nm": "500", "tolerance": 0.02})",
        "recipe");
    make_dataset(recipe, scratch.path(name));
    TarReader archive(scratch.path(name) + "/part-00000.tar");
    std::string file, bytes;
    while (archive.next(file, bytes))
      if (file == "0000000.png") break;
    return bytes;
  };
  std::string list = "\"build_tolerances\": [";
  for (const Tolerance& each : graded_tolerances(read_lens("edmund-54852").lens, "commercial"))
    list += fmt::format("{}\"{}={}\"", list.back() == '[' ? "" : ", ", place_of(each), each.limit);
  // Without the list the grade would be another: precision.
  EXPECT_EQ(part_of("list", "", list + "], "), part_of("grade", R"("grade": "commercial", )", ""));
}

TEST(Dataset, LightsOfAWorldAreDrawnOneByOne) {
  const std::string start =
      R"({"format": "petzval-dataset/1", "items": 40, "parameters": {"lens": "dgauss-50mm",
    "world": "spheres", "sensor": "example-vga", "light_scale": {"uniform": [1, 2]})";
  const Recipe few = parse_recipe(start + "}}", "recipe");
  const Recipe many =
      parse_recipe(start + R"(, "light_scale@0": {"uniform": [0, 1]}, "light_turn_deg@0": {"uniform": [0, 1]},
    "light_scale@1": {"uniform": [0, 1]}}})",
                   "recipe");
  double product = 0;
  for (std::size_t item = 0; item < 40; ++item) {
    const auto draw = draw_item(many, item);
    EXPECT_EQ(draw.at("light_scale"), draw_item(few, item).at("light_scale"));
    const double a = std::get<double>(draw.at("light_scale@0")),
                 b = std::get<double>(draw.at("light_scale@1"));
    EXPECT_NE(a, b);
    EXPECT_NE(a, std::get<double>(draw.at("light_turn_deg@0")));
    product += 12 * (a - 0.5) * (b - 0.5) / 40;
  }
  EXPECT_LT(std::abs(product), 4 / std::sqrt(40.0));  // four standard errors of no correlation
  EXPECT_THROW(parse_recipe(start + R"(, "light_scale@": 1}})", "recipe"), InputError);
  EXPECT_THROW(parse_recipe(start + R"(, "light_kelvin@0": 20}})", "recipe"), InputError);
}

TEST(Dataset, EstimateMakesAsManyItemsAtOnceAsMakeDoes) {
  const DatasetEstimate one = estimate_dataset(recipe(), 1, {.threads = 1}),
                        two = estimate_dataset(recipe(), 1, {.threads = 2});
  EXPECT_EQ(one.threads, 1);
  EXPECT_EQ(one.probed, 2u);
  EXPECT_EQ(two.threads, 2);
  EXPECT_EQ(two.probed, 4u);
  EXPECT_GT(two.cpu_s, 0);
  EXPECT_GE(two.memory_bytes, one.memory_bytes);
}

TEST(Dataset, ALensThatIsNotThereIsToldAtOnce) {
  const Scratch scratch;
  std::string text = recipe_text;
  text.replace(text.find("dgauss-50mm"), 11, "dgauss-51mm");
  EXPECT_THROW(make_dataset(parse_recipe(text, "recipe"), scratch.path("set")), InputError);
  EXPECT_FALSE(fs::exists(scratch.path("set")));
}

TEST(Dataset, CancelledLeavesWholePartsOnly) {
  const Scratch scratch;
  const std::string folder = scratch.path("set");
  Context context{.threads = 1};
  context.progress = [](double fraction, const std::string&) { return fraction < 0.4; };
  EXPECT_THROW(make_dataset(recipe(), folder, {}, context), Cancelled);
  for (const auto& [name, bytes] : files_of(folder)) EXPECT_FALSE(name.starts_with('.')) << name;
  EXPECT_TRUE(verify_dataset(folder).empty());
  EXPECT_GT(dataset_state(folder).parts_done, 0u);
}

TEST(Dataset, RenderedItemsHaveWhatTheFirstSurfacesAre) {
  const Scratch scratch;
  write_whole_file(scratch.path("wall.pbrt"), R"(LookAt 0 0 0  0 0 1  0 1 0
Camera "perspective" "float fov" 30
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "bilinearmesh" "point3 P" [ -9 -9 2   9 -9 2   -9 9 2   9 9 2 ]
)");
  write_whole_file(scratch.path("recipe.json"), R"({"format": "petzval-dataset/1", "items": 2,
    "parameters": {"lens": "dgauss-50mm", "world": "wall.pbrt", "sensor": "example-vga", "camera_x": 0, "camera_y": 0,
      "camera_z": {"choose": [0, 0.5]}, "look_x": 0, "look_y": 0, "look_z": 2, "focus_distance_m": 2},
    "sensor_set": ["columns=32", "rows=24"], "wavelengths_nm": "550", "samples_per_pixel": 8,
    "truth": ["depth", "normals", "albedo"]})");
  const Recipe rendered = read_recipe(scratch.path("recipe.json"));
  make_dataset(rendered, scratch.path("set"));
  TarReader archive(scratch.path("set") + "/part-00000.tar");
  std::string name, bytes;
  int depths = 0;
  while (archive.next(name, bytes)) {
    if (!name.ends_with(".depth.npy")) continue;
    ++depths;
    // A flat wall is as far away in every pixel: 2 m less the camera's place, counted from the film.
    const double wanted = 2 - std::get<double>(draw_item(rendered, name[6] == '0' ? 0 : 1).at("camera_z"));
    const auto* first = reinterpret_cast<const float*>(bytes.data() + bytes.size() - 32 * 24 * sizeof(float));
    for (int i = 0; i < 32 * 24; ++i) EXPECT_NEAR(static_cast<double>(first[i]), wanted, 1e-4);
  }
  EXPECT_EQ(depths, 2);
}

TEST(TarFile, RefusesWhatItDidNotWrite) {
  const Scratch scratch;
  TarWriter writer(scratch.path("a.tar"));
  writer.add("one.txt", "hello");
  EXPECT_THROW(writer.add(std::string(101, 'a'), ""), InputError);
  writer.finish();
  std::string text = read_whole_file(scratch.path("a.tar")), name, bytes;
  EXPECT_EQ(text.size(), 2u * 512 + 2 * 512);
  for (const std::string& damaged :
       {text.substr(0, 700), text + "x", std::string(), std::string(512, '\0')}) {
    write_whole_file(scratch.path("b.tar"), damaged);
    EXPECT_THROW(
        {
          TarReader reader(scratch.path("b.tar"));
          while (reader.next(name, bytes)) {
          }
        },
        InputError);
  }
}

}  // namespace
}  // namespace petzval
