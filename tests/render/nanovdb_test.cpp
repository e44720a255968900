// SPDX-License-Identifier: BSD-3-Clause
// Media from .nvdb files: one that NanoVDB 32.4 itself wrote, and one written byte by byte.
#include <gtest/gtest.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/media/nanovdb_file.h>
#include <petzval/render/pbrt/scene_files.h>

#include "media_scenes.h"

namespace petzval::render {
namespace {

const std::string seeds = std::string(PETZVAL_TEST_DATA) + "/../../fuzz/seeds/nvdb/";

/// What the library was told to write, exact in binary: from (−4, −7, −2) to (6, 5, 6).
float ramp(int x, int y, int z) {
  return 0.5f + 0.03125f * static_cast<float>(x) - 0.015625f * static_cast<float>(y) +
         0.0625f * static_cast<float>(z);
}

TEST(Nanovdb, HoldsWhatTheLibraryWrote) {
  const VoxelGrid grid = read_nanovdb(read_whole_file(seeds + "ramp.nvdb"), "ramp.nvdb", "density");
  EXPECT_EQ(grid.first, (std::array{-5, -8, -3}));
  EXPECT_EQ(grid.size, (std::array{13, 15, 11}));
  EXPECT_EQ(grid.world_from_index, (std::array{0.25, 0., 0., 0., 0.25, 0., 0., 0., 0.25}));
  EXPECT_EQ(grid.origin, (std::array{0.5, -1., 2.}));
  std::size_t at = 0;
  for (int z = -3; z <= 7; ++z)
    for (int y = -8; y <= 6; ++y)
      for (int x = -5; x <= 7; ++x) {
        const bool inside = x > -5 && x < 7 && y > -8 && y < 6 && z > -3 && z < 7;
        ASSERT_EQ(grid.values[at++], inside ? ramp(x, y, z) : 0) << x << " " << y << " " << z;
      }
}

TEST(Nanovdb, HasTilesAndABackground) {
  const VoxelGrid grid = read_nanovdb(read_whole_file(seeds + "tiles.nvdb"), "tiles.nvdb", "density");
  EXPECT_EQ(grid.size, (std::array{12, 8, 6}));
  for (int z = -1; z < 5; ++z)
    for (int y = -1; y < 7; ++y)
      for (int x = -1; x < 11; ++x) {
        const float expected = y < 0 || z < 0 ? 0.25f : x < 0 ? 0.5f : 0.75f;
        ASSERT_EQ(grid.values[static_cast<std::size_t>(((z + 1) * 8 + y + 1) * 12 + x + 1)], expected)
            << x << " " << y << " " << z;
      }
}

/// The same samples as a uniformgrid, of which both fall to 0 around: the same light.
TEST(Nanovdb, IsAGridWhereTheFileSays) {
  std::string samples;
  for (int z = -3; z <= 7; ++z)
    for (int y = -8; y <= 6; ++y)
      for (int x = -5; x <= 7; ++x)
        samples +=
            " " + std::to_string(x > -5 && x < 7 && y > -8 && y < 6 && z > -3 && z < 7 ? ramp(x, y, z) : 0);
  const std::string coefficients =
      flat("sigma_a", 0.3) + coloured("sigma_s", 0.5, 1, 2) + " \"float g\" 0.5 \"string type\" ";
  const auto light_of = [&](const std::string& medium) {
    const auto world =
        world_of("Rotate 30 0 1 0\nMakeNamedMedium \"fog\" " + coefficients + medium + "\n" + fog_inside +
                 "Translate 0.8 -1 2.5\nShape \"sphere\" \"float radius\" 4\nIdentity\n"
                 "LightSource \"distant\" \"spectrum L\" [ 300 1 900 1 ] \"point3 from\" [ 1 2 -1 ] "
                 "\"point3 to\" [ 0 0 0 ]\n");
    return seen(
        *world,
        [](double u, double v) {
          return std::array{Vector3{0, 0, -6}, Vector3{u, v - 0.6, 3}};
        },
        1 << 15);
  };
  const Estimate file = light_of("\"nanovdb\" \"string filename\" \"" + seeds + "ramp.nvdb\""),
                 grid = light_of(
                     "\"uniformgrid\" \"integer nx\" 13 \"integer ny\" 15 \"integer nz\" 11 "
                     "\"point3 p0\" [ -0.875 -3.125 1.125 ] \"point3 p1\" [ 2.375 0.625 3.875 ] "
                     "\"float density\" [" +
                     samples + " ]");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GT(grid.mean[i], 50 * grid.deviation[i]);
    EXPECT_NEAR(file.mean[i], grid.mean[i], 4.5 * std::hypot(file.deviation[i], grid.deviation[i])) << i;
  }
}

TEST(Nanovdb, IsAFileOfTheScene) {
  const SceneDescription scene = described(
      "MakeNamedMedium \"a\" \"string type\" \"nanovdb\" \"string filename\" \"" + seeds + "ramp.nvdb\"");
  EXPECT_EQ(scene_files(scene), std::vector{seeds + "ramp.nvdb"});
}

TEST(Nanovdb, RefusesWhatItCannotRead) {
  const std::string good = read_whole_file(seeds + "tiles.nvdb");
  const auto message = [](std::string bytes, std::size_t at, const std::string& put,
                          const char* grid = "density") {
    bytes.replace(at, put.size(), put);
    try {
      read_nanovdb(bytes, "a.nvdb", grid);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(message(good, 0, ""), "nothing");
  EXPECT_NE(message(good, 0, "PK").find("a.nvdb: is no file of NanoVDB"), std::string::npos);
  EXPECT_NE(message(good, 8, std::string("\0\0\xC0\3", 4)).find("is of version 30 of NanoVDB; 32"),
            std::string::npos);
  EXPECT_NE(message(good, 14, "\2").find("Blosc"), std::string::npos);
  EXPECT_NE(message(good, 16 + 32, "\2").find("not of floats"), std::string::npos);
  EXPECT_EQ(message(good, 0, "", "heat"), "a.nvdb: has no grid \"heat\"; it has \"density\"");
  const std::size_t root = 16 + 176 + 8 + 672 + 64;
  EXPECT_NE(message(good, root + 14, "\x7F").find("more than 2.68435e+08 voxels"), std::string::npos);
  EXPECT_NE(message(good, root + 15, "\xFF").find("without an active voxel"), std::string::npos);
  EXPECT_NE(message(good, root + 24, "\xFF").find("ends before"), std::string::npos);
  EXPECT_NE(message(good, root + 64 + 32, std::string(8, '\0')).find("overlap"), std::string::npos);
  EXPECT_NE(message(good, root + 64 + 8, "\1").find("ends before"), std::string::npos);
  EXPECT_NE(message(good.substr(0, good.size() - 1), 0, "").find("ends before"), std::string::npos);
  const auto medium = [](const std::string& parameters) {
    return media_message("MakeNamedMedium \"a\" \"string type\" \"nanovdb\" " + parameters);
  };
  EXPECT_NE(medium("").find("test.pbrt:3:1: a nanovdb medium needs"), std::string::npos);
  EXPECT_NE(medium("\"string filename\" \"nowhere.nvdb\"").find("test.pbrt:3:45: "), std::string::npos);
}

}  // namespace
}  // namespace petzval::render
