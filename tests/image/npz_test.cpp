// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/irradiance.h>
#include <petzval/image/formats/npz.h>
#include <sys/resource.h>

#include "scratch.h"

namespace petzval {
namespace {

TEST(Npz, ArraysComeBackAndTheBytesAreTheSame) {
  const test::Scratch scratch;
  const std::vector<NamedArray> arrays = {{"psf", {{2, 3}, std::vector<float>{1, 2, 3, 4, 5, 6}}},
                                          {"wavelengths_nm", {{2}, std::vector<double>{450.5, 650}}},
                                          {"pitch_um", {{}, std::vector<double>{3.45}}}};
  const std::string path = scratch.path("a.npz");
  write_npz(path, arrays);
  const std::vector<NamedArray> back = read_npz(path);
  ASSERT_EQ(back.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back[i].name, arrays[i].name);
    EXPECT_EQ(back[i].array.shape, arrays[i].array.shape);
    EXPECT_EQ(back[i].array.values, arrays[i].array.values);
  }
  const std::string bytes = read_whole_file(path);
  write_npz(path, arrays);
  EXPECT_EQ(read_whole_file(path), bytes);
  EXPECT_THROW(find_array(back, "light", path), InputError);
}

TEST(Npz, EveryTruncationIsRefused) {
  const test::Scratch scratch;
  const std::string path = scratch.path("a.npz");
  write_npz(path, {{"irradiance", {{1, 2, 1}, std::vector<float>{1, 2}}}});
  const std::string bytes = read_whole_file(path);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    write_whole_file(path, bytes.substr(0, length));
    EXPECT_THROW(read_npz(path), InputError) << length;
  }
  write_whole_file(path, bytes);
  EXPECT_NO_THROW(read_npz(path));
}

TEST(Npz, NamesOfArraysDoNotBreakTheLineOfAMessage) {
  const test::Scratch scratch;
  const std::string path = scratch.path("a.npz");
  write_npz(path, {{"two\nlines", {{1}, std::vector<float>{1}}}});
  try {
    find_array(read_npz(path), "light", path);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

// A byte may be one that says nothing, such as the date of an entry.
TEST(Npz, DamagedBytesAreRefusedOrReadAsTheyWere) {
  const test::Scratch scratch;
  const std::string path = scratch.path("a.npz");
  const NpyArray light{{1, 2, 1}, std::vector<float>{1, 2}};
  write_npz(path, {{"irradiance", light}});
  const std::string bytes = read_whole_file(path);
  int read = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at)
    for (const int change : {1, 0x80, 0xff}) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      scratch.with("a.npz", damaged);
      try {
        for (const NamedArray& each : read_npz(path)) {
          EXPECT_EQ(each.array.shape, light.shape) << at;
          EXPECT_EQ(each.array.values, light.values) << at;
        }
        ++read;
      } catch (const InputError&) {
      }
    }
  EXPECT_GT(read, 0);
}

// The size that an archive states is not to be trusted: memory is taken for bytes that come.
TEST(Npz, AStatedSizeTakesNoMemory) {
  const test::Scratch scratch;
  const std::string path = scratch.path("a.npz");
  write_npz(path, {{"irradiance", {{1, 2, 1}, std::vector<float>{1, 2}}}});
  std::string bytes = read_whole_file(path);
  const std::size_t entry = bytes.find("PK\x01\x02"), size_at = entry + 24;
  ASSERT_NE(entry, bytes.npos);
  bytes.replace(size_at, 4, "\xFF\xFF\xFF\x7F");  // two gigabytes
  scratch.with("a.npz", bytes);
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  EXPECT_THROW(read_npz(path), InputError);
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 1 << 18);  // KiB
}

TEST(Npz, HoldsIrradianceWithItsWavelengthsAndPitch) {
  const test::Scratch scratch;
  SpectralImage image(3, 2, {450, 550, 650}, 3.45);
  for (int band = 0; band < 3; ++band)
    for (int i = 0; i < 6; ++i) image.at(band, i / 3, i % 3) = static_cast<float>(10 * band + i);
  const std::string path = scratch.path("light.npz");
  write_irradiance(path, image);
  const SpectralImage back = read_irradiance(path, {});
  EXPECT_EQ(back.wavelengths_nm(), image.wavelengths_nm());
  EXPECT_EQ(back.pitch_um(), 3.45);
  EXPECT_EQ((std::vector<float>(back.values().begin(), back.values().end())),
            (std::vector<float>(image.values().begin(), image.values().end())));
  write_npz(path, {{"irradiance", {{2, 3, 3}, std::vector<float>(18, 1)}},
                   {"wavelengths_nm", {{2}, std::vector<double>{450, 550}}}});
  EXPECT_THROW(read_irradiance(path, {{}, 3.45}), InputError);
}

}  // namespace
}  // namespace petzval
