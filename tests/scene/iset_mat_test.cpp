// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/scene/formats/iset_mat.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "iset_fixture.h"
#include "scratch.h"

namespace petzval {
namespace {

using namespace test;

class IsetMat : public ::testing::Test {
 protected:
  std::string write(const MatStruct& scene, bool compressed = false) {
    write_mat(scratch_.path("scene.mat"), scene, compressed);
    return scratch_.path("scene.mat");
  }
  std::string message_of(const MatStruct& scene) {
    const std::string path = write(scene);
    try {
      read_iset_mat(path);
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(path)) << error.what();
      return error.what();
    }
    return "no error";
  }
  Scratch scratch_;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// h·c = 1.986445857e-25 J·m (SI, exact constants), so a photon of 500 nm has 3.972891714e-19 J, one of 600 nm
// 3.310743095e-19 J. Ten digits are quoted, hence the relative tolerance.
constexpr double joules_500 = 3.972891714e-19, joules_600 = 3.310743095e-19;

TEST(PhotonEnergy, IsPlancksConstantTimesFrequency) {
  EXPECT_NEAR(photon_energy_j(500) / joules_500, 1, 1e-9);
  EXPECT_NEAR(photon_energy_j(600) / joules_600, 1, 1e-9);
}

TEST_F(IsetMat, BecomesEnergyInItsPlace) {
  for (const bool compressed : {false, true}) {
    const Scene scene = read_iset_mat(write(iset_scene(), compressed));
    ASSERT_EQ(scene.columns(), iset_columns);
    ASSERT_EQ(scene.rows(), iset_rows);
    EXPECT_EQ(scene.wavelengths_nm(), (std::vector<double>{500, 600}));
    for (int band = 0; band < iset_bands; ++band)
      for (int row = 0; row < iset_rows; ++row)
        for (int column = 0; column < iset_columns; ++column) {
          const double photons = 1e15 + 1e11 * iset_stored(row, column, band);
          const double energy = photons * (band == 0 ? joules_500 : joules_600);
          // Single precision holds a number to 6e-8.
          EXPECT_NEAR(scene.band(band)[static_cast<std::size_t>(row * iset_columns + column)] / energy, 1,
                      1e-7)
              << band << " " << row << " " << column;
        }
  }
}

TEST_F(IsetMat, CarriesGeometryNameAndDepth) {
  const Scene scene = read_iset_mat(write(iset_scene()));
  EXPECT_EQ(scene.name, "small");
  EXPECT_EQ(scene.horizontal_angle_deg(), 12);
  EXPECT_EQ(scene.distance_m(), 1.5);
  EXPECT_EQ(scene.depth_m, (std::vector<float>{1.1f, 1.2f, 1.3f, 2.1f, 2.2f, 2.3f}));
  EXPECT_FALSE(scene.illuminant.has_value());
}

TEST_F(IsetMat, TakesFloatingPhotonsAsTheyAre) {
  const auto single = MatStruct("data").array("photons", MAT_C_SINGLE, MAT_T_SINGLE,
                                              {iset_rows, iset_columns, iset_bands}, iset_cube<float>());
  const auto real = MatStruct("data").array("photons", MAT_C_DOUBLE, MAT_T_DOUBLE,
                                            {iset_rows, iset_columns, iset_bands}, iset_cube<double>());
  for (const MatStruct& data : {single, real}) {
    const Scene scene = read_iset_mat(write(iset_scene_with(data)));
    EXPECT_NEAR(scene.band(1)[4] / (1110 * joules_600), 1, 1e-7) << "row 1, column 1 of the band of 600 nm";
  }
}

TEST_F(IsetMat, RescalesEightBitsOverEightBits) {
  const auto data =
      MatStruct("data")
          .array<std::uint8_t>("photons", MAT_C_UINT8, MAT_T_UINT8, {1, 2, 2}, {0, 255, 51, 102})
          .number("dmin", 1e15)
          .number("dmax", 6e15);
  const Scene scene = read_iset_mat(write(iset_scene_with(data)));
  const double expected[] = {1e15, 6e15, 2e15, 3e15};  // 51/255 = 1/5
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(scene.values()[i] / (expected[i] * (i < 2 ? joules_500 : joules_600)), 1, 1e-7) << i;
}

TEST_F(IsetMat, KnowsItsLight) {
  const auto light = MatStruct("illuminant")
                         .nested("spectrum", iset_wave())
                         .nested("data", MatStruct("data")
                                             .array<std::uint32_t>("photons", MAT_C_UINT32, MAT_T_UINT32,
                                                                   {2, 1}, {0, 4294967295u})
                                             .number("min", 2e15)
                                             .number("max", 4e15));
  const Scene scene = read_iset_mat(write(iset_scene().nested("illuminant", light)));
  ASSERT_TRUE(scene.illuminant.has_value());
  EXPECT_NEAR(scene.illuminant->at(500) / (2e15 * joules_500), 1, 1e-9);
  EXPECT_NEAR(scene.illuminant->at(600) / (4e15 * joules_600), 1, 1e-9);
}

TEST_F(IsetMat, NeedsAnAngleFromSomewhere) {
  const auto scene = [] {
    return MatStruct("scene").nested("data", iset_data()).nested("spectrum", iset_wave());
  };
  EXPECT_TRUE(contains(message_of(scene()), "wAngular"));
  const Scene read = read_iset_mat(write(scene()), 33.0);
  EXPECT_EQ(read.horizontal_angle_deg(), 33);
  EXPECT_FALSE(read.distance_m().has_value());
}

TEST_F(IsetMat, MalformedFieldsAreNamed) {
  const auto with = [](const MatStruct& data) { return iset_scene_with(data); };
  EXPECT_TRUE(contains(message_of(MatStruct("scene").number("x", 1)), "scene.data"));
  EXPECT_TRUE(contains(message_of(MatStruct("other").number("x", 1)), "'scene'"));
  EXPECT_TRUE(contains(message_of(with(MatStruct("data").number("dmin", 1))), "scene.data.photons"));
  EXPECT_TRUE(contains(message_of(with(MatStruct("data").text("photons", "many"))), "scene.data.photons"));
  EXPECT_TRUE(contains(message_of(with(MatStruct("data").array("photons", MAT_C_UINT16, MAT_T_UINT16,
                                                               {2, 3, 2}, iset_cube<std::uint16_t>()))),
                       "dmin"));
  EXPECT_TRUE(contains(message_of(with(MatStruct("data").array<double>("photons", MAT_C_DOUBLE, MAT_T_DOUBLE,
                                                                       {1, 1, 3}, {1, 2, 3}))),
                       "2 wavelengths for 3 bands"));
  EXPECT_TRUE(contains(message_of(with(MatStruct("data").array<double>("photons", MAT_C_DOUBLE, MAT_T_DOUBLE,
                                                                       {1, 1, 1, 2}, {1, 2}))),
                       "rows x columns x bands"));
  EXPECT_TRUE(
      contains(message_of(iset_scene_with(iset_data())
                              .array<double>("depthMap", MAT_C_DOUBLE, MAT_T_DOUBLE, {1, 3}, {1, 2, 3})),
               "depthMap"));
}

TEST_F(IsetMat, ImpossibleRadianceIsNamedWithItsPlace) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf, -1.0}) {
    const auto data = MatStruct("data").array<double>("photons", MAT_C_DOUBLE, MAT_T_DOUBLE, {2, 2, 2},
                                                      {1, 1, 1, 1, 1, bad, 1, 1});
    const std::string message = message_of(iset_scene_with(data));
    EXPECT_TRUE(contains(message, "600 nm at row 1, column 0")) << message;
  }
}

TEST_F(IsetMat, EmptyAndOlderVersionsAreRefusedWithTheWayOut) {
  const auto refused = [&](const std::string& bytes) {
    try {
      read_iset_mat(scratch_.with("version.mat", bytes));
    } catch (const InputError& error) {
      return contains(error.what(), "-v7");
    }
    return false;
  };
  std::string header = "MATLAB 7.3 MAT-file";
  header.resize(512, ' ');
  header.replace(124, 4, std::string("\0\2IM", 4));
  EXPECT_TRUE(refused(header)) << "version 7.3 without HDF5";
  EXPECT_TRUE(refused(std::string("\0\0\0\0\1\0\0\0\1\0\0\0\0\0\0\0\2\0\0\0x\0", 22))) << "version 4";
  EXPECT_TRUE(refused("")) << "nothing";
}

TEST_F(IsetMat, ReadsTheOtherByteOrder) {
  // The smallest big-endian file: one variable `scene` that is a number, so that reading gets as far as that.
  std::string bytes = "MATLAB 5.0 MAT-file";
  bytes.resize(124, ' ');
  const auto word = [&](std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
  };
  bytes += std::string("\1\0MI", 4);
  word(14), word(16 + 16 + 16 + 16);   // a matrix
  word(6), word(8), word(6), word(0);  // of class double
  word(5), word(8), word(1), word(1);  // 1 × 1
  word(1), word(5), bytes += std::string("scene\0\0\0", 8);
  word(9), word(8), word(0x3ff00000), word(0);  // 1.0
  try {
    read_iset_mat(scratch_.with("big.mat", bytes));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "no struct")) << error.what();
  }
}

TEST(PianoScene, IsAsItsMakersDescribeIt) {
  namespace fs = std::filesystem;
  const char* elsewhere = std::getenv("PETZVAL_SHARED");
  const fs::path path =
      (elsewhere ? fs::path(elsewhere) : fs::path(data_directory()) / ".." / ".." / "shared") / "data" /
      "scenes" / "piano3d.mat";
  if (!fs::is_regular_file(path)) GTEST_SKIP() << "the ISET scene piano3d.mat is not beside the checkout";
  const Scene scene = read_iset_mat(path.string());
  EXPECT_EQ(scene.name, "piano3d");
  EXPECT_EQ(scene.columns(), 200);
  EXPECT_EQ(scene.rows(), 200);
  ASSERT_EQ(scene.bands(), 31);
  EXPECT_EQ(scene.wavelengths_nm().front(), 400);
  EXPECT_EQ(scene.wavelengths_nm().back(), 700);
  EXPECT_EQ(scene.horizontal_angle_deg(), 10);
  EXPECT_EQ(scene.distance_m(), 1.2);
  EXPECT_EQ(scene.depth_m.size(), scene.band_size());
  EXPECT_TRUE(scene.illuminant.has_value());
  // ISET wrote its own mean luminance into the file, 100.001 cd/m²: a sum over samples every 10 nm, where
  // ours integrates the colour-matching functions between them. For smooth spectra that makes less than 1e-3.
  EXPECT_NEAR(scene.mean_luminance_cd_m2(), 100.001, 0.1);
}

}  // namespace
}  // namespace petzval
