// SPDX-License-Identifier: BSD-3-Clause
// Damaged MAT files: an error or a sound scene, never harm.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/scene/formats/iset_mat.h>

#include <algorithm>
#include <cstring>

#include "image/hostile.h"
#include "iset_fixture.h"

namespace petzval {
namespace {

using namespace test;

/// A scene that comes out of a damaged file must be one all the same.
void read_and_check(const std::string& path) {
  const Scene scene = read_iset_mat(path);
  scene.validate();
  EXPECT_GT(scene.band_size(), 0u);
}

class DamagedMat : public ::testing::TestWithParam<bool> {
 protected:
  std::string bytes() {
    const auto light = MatStruct("illuminant")
                           .nested("data", MatStruct("data").array<double>("photons", MAT_C_DOUBLE,
                                                                           MAT_T_DOUBLE, {2, 1}, {1, 2}));
    return write_mat(scratch_.path("whole.mat"), iset_scene().nested("illuminant", light), GetParam());
  }
  Scratch scratch_;
};

TEST_P(DamagedMat, TheWholeFileIsTaken) {
  EXPECT_TRUE(taken(read_and_check, scratch_.with("copy.mat", bytes()), "the whole file"));
}

TEST_P(DamagedMat, TruncatedIsRefused) {
  refuses_truncations(scratch_, bytes(), read_and_check);
}

TEST_P(DamagedMat, LongerIsRefused) {
  for (const char* more : {"x", "more than a tag of eight bytes"})
    EXPECT_FALSE(taken(read_and_check, scratch_.with("long", bytes() + more), more));
  EXPECT_FALSE(taken(read_and_check, scratch_.with("long", bytes() + std::string(8, '\0')), "zeros"));
}

TEST_P(DamagedMat, EveryFlippedBitIsSurvived) {
  const std::string whole = bytes();
  survives_flips(scratch_, whole, whole.size(), read_and_check);
}

TEST_P(DamagedMat, EveryWordOfAllOnesIsSurvived) {
  const std::string whole = bytes();
  for (const char* word : {"\xff\xff\xff\xff", "\xff\xff\xff\x7f", "\0\0\0\0"})
    for (std::size_t at = 0; at + 4 <= whole.size(); at += 4) {
      std::string damaged = whole;
      std::memcpy(damaged.data() + at, word, 4);
      taken(read_and_check, scratch_.with("word", damaged), "word at " + std::to_string(at));
    }
}

INSTANTIATE_TEST_SUITE_P(Compression, DamagedMat, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "compressed" : "plain"; });

TEST(PackedMat, DamageIsSeenOrMakesNoDifference) {
  // The checksum covers every number. What a flipped bit may get past it is what deflate can say in two ways,
  // and the bits that fill up its last byte: a few dozen at most.
  const Scratch scratch;
  const std::string whole = write_mat(scratch.path("whole.mat"), iset_scene(), true);
  const Scene original = read_iset_mat(scratch.path("whole.mat"));
  int passed = 0;
  for (std::size_t bit = 8 * 128; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    taken(
        [&](const std::string& path) {
          const Scene scene = read_iset_mat(path);
          ++passed;
          EXPECT_TRUE(std::ranges::equal(scene.values(), original.values())) << "bit " << bit;
          EXPECT_EQ(scene.depth_m, original.depth_m) << "bit " << bit;
        },
        scratch.with("damaged", damaged), "bit " + std::to_string(bit));
  }
  EXPECT_LT(passed, 40);
}

TEST(PackedMat, ClaimsBeyondReasonAreRefusedBeforeAnythingIsAllocated) {
  // A few packed bytes that promise up to 4 GiB.
  const Scratch scratch;
  std::string plain = write_mat(scratch.path("plain.mat"), iset_scene(), false);
  for (const std::uint32_t size : {0x00100000u, 0x7fffffffu, 0x80000000u, 0xfffffff8u}) {
    std::memcpy(plain.data() + 132, &size, 4);
    EXPECT_FALSE(taken(read_and_check, scratch.with("claim", packed_mat(plain)), "claim"));
  }
}

TEST(PackedMat, DamageUnderARightChecksumIsSurvived) {
  const Scratch scratch;
  const std::string plain = write_mat(scratch.path("plain.mat"), iset_scene(), false);
  for (std::size_t bit = 8 * 128; bit < 8 * plain.size(); ++bit) {
    std::string damaged = plain;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    taken(read_and_check, scratch.with("packed", packed_mat(damaged)), "bit " + std::to_string(bit));
  }
}

}  // namespace
}  // namespace petzval
