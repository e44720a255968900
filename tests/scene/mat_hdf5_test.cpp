// SPDX-License-Identifier: BSD-3-Clause
// MAT files of version 7.3: the same scene as in version 5, and harm to nobody. (Files as MATLAB lays them
// out, made with h5py, are in cli/test_mat_hdf5.py.)
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/scene/formats/hdf5_handle.h>
#include <petzval/scene/formats/iset_mat.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "image/hostile.h"
#include "iset_fixture.h"

namespace petzval {
namespace {

using namespace test;

/// As matio, another program, writes it.
std::string write_hdf5(const std::string& path, const MatStruct& variable) {
  mat_t* file = Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT73);
  EXPECT_EQ(Mat_VarWrite(file, variable.variable(), MAT_COMPRESSION_ZLIB), 0);
  Mat_Close(file);
  Mat_VarFree(variable.variable());
  return read_whole_file(path);
}

MatStruct lit_scene() {
  const auto light = MatStruct("illuminant")
                         .nested("data", MatStruct("data").array<double>("photons", MAT_C_DOUBLE,
                                                                         MAT_T_DOUBLE, {2, 1}, {1, 2}));
  return std::move(iset_scene().nested("illuminant", light));
}

TEST(MatHdf5, IsTheSceneOfVersion5ToTheLastBit) {
  const Scratch scratch;
  write_mat(scratch.path("old.mat"), lit_scene(), false);
  write_hdf5(scratch.path("new.mat"), lit_scene());
  const Scene old_scene = read_iset_mat(scratch.path("old.mat"));
  const Scene new_scene = read_iset_mat(scratch.path("new.mat"));
  EXPECT_TRUE(std::ranges::equal(new_scene.values(), old_scene.values()));
  EXPECT_EQ(new_scene.depth_m, old_scene.depth_m);
  EXPECT_EQ(new_scene.wavelengths_nm(), old_scene.wavelengths_nm());
  EXPECT_EQ(new_scene.horizontal_angle_deg(), old_scene.horizontal_angle_deg());
  EXPECT_EQ(new_scene.distance_m(), old_scene.distance_m());
  EXPECT_EQ(new_scene.name, old_scene.name);
  ASSERT_TRUE(new_scene.illuminant && old_scene.illuminant);
  EXPECT_EQ(new_scene.illuminant->values(), old_scene.illuminant->values());
}

class DamagedMatHdf5 : public ::testing::Test {
 protected:
  /// What is said of the whole file after HDF5 altered it.
  std::string message_after(const std::function<void(hid_t)>& alter) {
    const std::string path = scratch_.path("altered.mat");
    write_hdf5(path, iset_scene());
    {
      const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
      alter(file.id());
    }
    try {
      read_iset_mat(path);
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(path)) << error.what();
      EXPECT_EQ(std::count(error.what(), error.what() + std::strlen(error.what()), '\n'), 0);
      return std::string(error.what()).substr(path.size() + 2);
    }
    return "no error";
  }
  /// scene.data.photons of this many numbers a side, of which none is stored.
  static void claim(hid_t file, hsize_t side) {
    H5Ldelete(file, "scene/data/photons", H5P_DEFAULT);
    const hsize_t sides[] = {2, side, side}, chunk[] = {1, 64, 64};
    const Hdf5Handle space(H5Screate_simple(3, sides, nullptr), H5Sclose),
        plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(plan.id(), 3, chunk);
    const Hdf5Handle data(H5Dcreate2(file, "scene/data/photons", H5T_NATIVE_DOUBLE, space.id(), H5P_DEFAULT,
                                     plan.id(), H5P_DEFAULT),
                          H5Dclose);
    say_class(data.id(), "double");
  }
  static void say_class(hid_t object, const std::string& word) {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
    H5Tset_size(type.id(), word.size());
    const Hdf5Handle attribute(
        H5Acreate2(object, "MATLAB_class", type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    H5Awrite(attribute.id(), type.id(), word.data());
  }
  Scratch scratch_;
};

TEST_F(DamagedMatHdf5, SizesAreRefusedBeforeRoomIsMade) {
  EXPECT_EQ(message_after([](hid_t file) { claim(file, 100000); }),
            "scene.data.photons would take 149.0 GiB; up to 16 GiB fit");
  EXPECT_EQ(message_after([](hid_t file) { claim(file, 10000); }),
            "is damaged: scene.data.photons claims to hold more than there is; save it again with MATLAB's "
            "save -v7.3");
}

TEST_F(DamagedMatHdf5, StructsWithinThemselvesAreRefused) {
  EXPECT_EQ(message_after([](hid_t file) {
              H5Lcreate_hard(file, "scene", file, "scene/again", H5P_DEFAULT, H5P_DEFAULT);
            }),
            "is damaged: structs are nested more than 32 deep");
  EXPECT_EQ(message_after([](hid_t file) {
              const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
              const Hdf5Handle data(H5Dcreate2(file, "scene/again", H5T_STD_REF_OBJ, space.id(), H5P_DEFAULT,
                                               H5P_DEFAULT, H5P_DEFAULT),
                                    H5Dclose);
              hobj_ref_t reference{};
              H5Rcreate(&reference, file, "scene", H5R_OBJECT, -1);
              H5Dwrite(data.id(), H5T_STD_REF_OBJ, H5S_ALL, H5S_ALL, H5P_DEFAULT, &reference);
            }),
            "is damaged: structs are nested more than 32 deep");
}

TEST_F(DamagedMatHdf5, OtherFilesAreNotLookedInto) {
  EXPECT_EQ(message_after([](hid_t file) {
              H5Ldelete(file, "scene/data/photons", H5P_DEFAULT);
              H5Lcreate_external("/etc/passwd", "scene", file, "scene/data/photons", H5P_DEFAULT,
                                 H5P_DEFAULT);
            }),
            "scene.data.photons must be an array of real numbers");
  EXPECT_EQ(message_after([](hid_t file) {
              H5Ldelete(file, "scene/distance", H5P_DEFAULT);
              const hsize_t sides[] = {1, 1};
              const Hdf5Handle space(H5Screate_simple(2, sides, nullptr), H5Sclose),
                  plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
              H5Pset_external(plan.id(), "/etc/passwd", 0, 8);
              const Hdf5Handle data(H5Dcreate2(file, "scene/distance", H5T_NATIVE_DOUBLE, space.id(),
                                               H5P_DEFAULT, plan.id(), H5P_DEFAULT),
                                    H5Dclose);
              say_class(data.id(), "double");
            }),
            "scene.distance is kept in another file; only data within this one are read");
}

TEST_F(DamagedMatHdf5, WrongTypesAreNamed) {
  EXPECT_EQ(message_after([](hid_t file) {
              H5Ldelete(file, "scene/spectrum", H5P_DEFAULT);
              const Hdf5Handle group(
                  H5Gcreate2(file, "scene/spectrum", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
              say_class(group.id(), "function_handle");
            }),
            "scene.spectrum must be a single struct");
  EXPECT_EQ(message_after([](hid_t file) { H5Ldelete(file, "scene/wAngular", H5P_DEFAULT); }),
            "scene has no wAngular: its horizontal angle must be given (`scene.horizontal_angle_deg`)");
}

void read_hdf5_and_check(const std::string& path) {
  const Scene scene = read_iset_mat(path);
  scene.validate();
  EXPECT_GT(scene.band_size(), 0u);
}

TEST_F(DamagedMatHdf5, TruncatedIsRefused) {
  refuses_truncations(scratch_, write_hdf5(scratch_.path("whole.mat"), iset_scene()), read_hdf5_and_check);
}

TEST_F(DamagedMatHdf5, FlippedBitsAreSurvived) {
  constexpr std::size_t flips = 400;  // each is read by a process of its own
  survives_flips(scratch_, write_hdf5(scratch_.path("whole.mat"), iset_scene()), 0, read_hdf5_and_check,
                 flips);
}

}  // namespace
}  // namespace petzval
