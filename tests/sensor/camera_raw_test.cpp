// SPDX-License-Identifier: BSD-3-Clause
// Raw files of cameras, by LibRaw in a program of its own.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/sensor/formats/camera_raw.h>
#include <petzval/sensor/formats/dng.h>
#include <scratch.h>

#include <fstream>
#include <random>

namespace petzval {
namespace {

/// A raw image that two readers can be held to: every number differs from its neighbours.
RawImage sample_raw(const std::vector<std::string>& channels, const Mosaic& mosaic) {
  RawImage raw;
  raw.columns = 46, raw.rows = 34;
  raw.channels = channels;
  raw.mosaic = mosaic;
  raw.black_level = 64, raw.white_level = 4000;
  std::mt19937 random(5);
  std::uniform_int_distribution<int> value(60, 4000);
  for (int i = 0; i < raw.columns * raw.rows; ++i)
    raw.samples.push_back(static_cast<std::uint16_t>(value(random)));
  raw.calibrations.push_back({21, 6504, {1.1, -0.3, -0.1, -0.4, 1.3, 0.1, -0.1, 0.2, 0.6}, {}});
  raw.as_shot_neutral = {0.5, 1, 0.7};
  raw.exposure_s = 0.02, raw.iso = 100;
  return raw;
}

const std::vector<std::string> rgb{"red", "green", "blue"};

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Our own reader and LibRaw, which shares no code with it, find the same in the same file.
TEST(CameraRaw, LibRawReadsWhatTheReaderOfDngReads) {
  const test::Scratch scratch;
  for (const std::vector<int>& cells :
       {std::vector<int>{0, 1, 1, 2}, {2, 1, 1, 0}, {1, 0, 2, 1}, {1, 2, 0, 1}}) {
    const RawImage raw = sample_raw(rgb, {2, 2, cells});
    const std::string path = scratch.path("own.dng"), camera = scratch.path("camera.nef");
    write_dng(path, raw);
    write_dng(camera, raw);
    const RawImage own = read_dng(path), other = read_raw(camera);
    EXPECT_EQ(other.columns, own.columns);
    EXPECT_EQ(other.rows, own.rows);
    EXPECT_EQ(other.samples, own.samples);
    EXPECT_EQ(other.black_level, own.black_level);
    EXPECT_EQ(other.white_level, own.white_level);
    EXPECT_NEAR(other.exposure_s, own.exposure_s, 1e-6);
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        EXPECT_EQ(other.channels[static_cast<std::size_t>(other.mosaic.channel(row, column))],
                  own.channels[static_cast<std::size_t>(own.mosaic.channel(row, column))]);
    for (const std::size_t neutral : {0U, 1U, 2U})
      EXPECT_NEAR(other.as_shot_neutral.at(neutral), own.as_shot_neutral.at(neutral), 1e-5);
  }
}

// Whatever the bytes: a raw image or one line, and the program that reads them goes on.
TEST(CameraRaw, DamagedFilesAreRefusedInOneLine) {
  const test::Scratch scratch;
  const std::string path = scratch.path("camera.nef");
  write_dng(path, sample_raw(rgb, {2, 2, {0, 1, 1, 2}}));
  const std::string good = bytes_of(path);
  std::mt19937 random(11);
  int read = 0, refused = 0;
  for (int round = 0; round < 400; ++round) {
    std::string bytes = good;
    if (round % 4 == 0) bytes.resize(random() % good.size());
    // Most of the file is pixels; its tags are at the front.
    for (unsigned i = 0; i <= random() % 6 && !bytes.empty(); ++i)
      bytes[random() % std::min<std::size_t>(bytes.size(), round % 2 ? 700 : good.size())] =
          static_cast<char>(random());
    std::ofstream(path, std::ios::binary) << bytes;
    try {
      read_raw(path);
      ++read;
    } catch (const InputError& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(read, 20);
  EXPECT_GT(refused, 50);
  EXPECT_THROW(read_raw(scratch.path("missing.cr2")), InputError);
  EXPECT_THROW(read_raw(scratch.path("")), InputError);
}

}  // namespace
}  // namespace petzval
