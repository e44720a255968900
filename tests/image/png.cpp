// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/png.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <random>
#include <stdexcept>

#include "hostile.h"
#include "python_program.h"

namespace petzval {
namespace {

PngImage noise(int columns, int rows, int channels, int bits) {
  PngImage image;
  image.columns = columns, image.rows = rows, image.channels = channels, image.bits = bits;
  std::mt19937 random(7);
  image.samples.resize(image.row_samples() * static_cast<std::size_t>(rows));
  for (std::uint16_t& sample : image.samples)
    sample = static_cast<std::uint16_t>(random() & ((1u << bits) - 1));
  return image;
}

TEST(Png, RoundTripsExactlyInEveryLayout) {
  const test::Scratch scratch;
  for (const int channels : {1, 2, 3, 4})
    for (const int bits : {8, 16})
      for (const PngTransfer transfer : {PngTransfer::unstated, PngTransfer::srgb, PngTransfer::linear,
                                         PngTransfer::rec2100_pq, PngTransfer::rec2100_hlg}) {
        PngImage image = noise(13, 7, channels, bits);
        image.transfer = transfer;
        image.text = {{"Description", "Grüße vom Petzval"}, {"Exposure", "white is 3 lx"}};
        write_png(scratch.path("a.png"), image);
        const PngImage back = read_png(scratch.path("a.png"));
        EXPECT_EQ(back.samples, image.samples);
        EXPECT_EQ(back.columns, 13);
        EXPECT_EQ(back.rows, 7);
        EXPECT_EQ(back.channels, channels);
        EXPECT_EQ(back.bits, bits);
        EXPECT_EQ(back.transfer, transfer);
        EXPECT_EQ(back.text, image.text);
      }
}

TEST(Png, SameBytesTwice) {
  const test::Scratch scratch;
  write_png(scratch.path("a.png"), noise(64, 64, 3, 16));
  write_png(scratch.path("b.png"), noise(64, 64, 3, 16));
  EXPECT_EQ(read_whole_file(scratch.path("a.png")), read_whole_file(scratch.path("b.png")));
}

TEST(Png, BlocksOfNoiseAndOfDrawingsAreOneStreamOnAnyNumberOfThreads) {
  const test::Scratch scratch;
  PngImage image = noise(1200, 1500, 3, 8);  // six blocks of 1 MiB; the lower half is flat
  std::fill(image.samples.begin() + static_cast<std::ptrdiff_t>(image.samples.size() / 2),
            image.samples.end(), std::uint16_t{77});
  std::vector<std::string> files;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    write_png(scratch.path("a.png"), image);
    files.push_back(read_whole_file(scratch.path("a.png")));
    EXPECT_EQ(read_png(scratch.path("a.png")).samples, image.samples);
  }
  EXPECT_EQ(files[0], files[1]);
  EXPECT_EQ(files[0], files[2]);
  // Noise does not shrink; what is flat all but vanishes.
  EXPECT_LT(files[0].size(), image.samples.size() * 51 / 100);
}

// A decoder of its own, of the PNG specification (ISO/IEC 15948, clauses 5, 9), on zlib alone.
constexpr const char* independent_decoder = R"(
import struct, sys, zlib
data = open(sys.argv[1], 'rb').read()
assert data[:8] == b'\x89PNG\r\n\x1a\n'
at, idat, names = 8, b'', []
while at < len(data):
    size, name = struct.unpack('>I4s', data[at:at + 8])
    body = data[at + 8:at + 8 + size]
    assert zlib.crc32(name + body) == struct.unpack('>I', data[at + 8 + size:at + 12 + size])[0]
    names.append(name)
    if name == b'IHDR': columns, rows, bits, kind = struct.unpack('>IIBB', body[:10])
    if name == b'IDAT': idat += body
    at += 12 + size
channels = {0: 1, 2: 3, 4: 2, 6: 4}[kind]
pixel, stride = channels * bits // 8, columns * channels * bits // 8
raw, above, out = zlib.decompress(idat), bytes(stride), b''
for row in range(rows):
    method, line = raw[row * (stride + 1)], bytearray(raw[row * (stride + 1) + 1:(row + 1) * (stride + 1)])
    for i in range(stride):
        a = line[i - pixel] if i >= pixel else 0
        b, c = above[i], above[i - pixel] if i >= pixel else 0
        p = a + b - c
        paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
        line[i] = (line[i] + [0, a, b, (a + b) // 2, paeth][method]) & 255
    above, out = bytes(line), out + bytes(line)
assert b'sRGB' in names and b'tIME' not in names
open(sys.argv[2], 'wb').write(out)
)";

TEST(Png, IsReadAlikeByADecoderWrittenFromTheSpecification) {
  if (!test::python_runs("")) GTEST_SKIP() << "no Python here";
  const test::Scratch scratch;
  PngImage image = noise(17, 9, 3, 16);
  for (std::size_t i = 0; i < image.samples.size() / 2; ++i)
    image.samples[i] = static_cast<std::uint16_t>(40 * i);
  write_png(scratch.path("a.png"), image);
  ASSERT_EQ(
      test::run_python(scratch, independent_decoder, scratch.path("a.png") + " " + scratch.path("a.raw")), 0);
  const std::string raw = read_whole_file(scratch.path("a.raw"));
  ASSERT_EQ(raw.size(), 2 * image.samples.size());
  for (std::size_t i = 0; i < image.samples.size(); ++i)
    EXPECT_EQ(static_cast<unsigned char>(raw[2 * i]) * 256 + static_cast<unsigned char>(raw[2 * i + 1]),
              image.samples[i]);
}

// Written by hand with Python's zlib and struct: 3 × 1 pixels of a two-bit palette (red, half transparent
// green, blue), and 2 × 2 pixels of one-bit grey (white, black / black, white), interlaced.
constexpr unsigned char palette_png[] = {
#include "palette_png.inc"
};
constexpr unsigned char grey_png[] = {
#include "grey_png.inc"
};

template <std::size_t size>
std::string bytes_of(const unsigned char (&bytes)[size]) {
  return {reinterpret_cast<const char*>(bytes), size};
}

TEST(Png, ResolvesPalettesTransparencyAndSingleBits) {
  const test::Scratch scratch;
  const PngImage palette = read_png(scratch.with("p.png", bytes_of(palette_png)));
  EXPECT_EQ(palette.channels, 4);
  EXPECT_EQ(palette.bits, 8);
  EXPECT_EQ(palette.samples, (std::vector<std::uint16_t>{255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 255}));
  const PngImage grey = read_png(scratch.with("g.png", bytes_of(grey_png)));
  EXPECT_EQ(grey.channels, 1);
  EXPECT_EQ(grey.samples, (std::vector<std::uint16_t>{255, 0, 0, 255}));
  EXPECT_EQ(grey.transfer, PngTransfer::unstated);
}

TEST(Png, RefusesASizeThatTheFileCannotHold) {
  const test::Scratch scratch;
  const std::string path = scratch.path("a.png");
  write_png(path, noise(1, 1, 1, 8));
  std::string bytes = read_whole_file(path);
  // IHDR of 60000 × 60000 with its right CRC (computed with zlib.crc32).
  const std::string header("\0\0\0\x0dIHDR\0\0\xea\x60\0\0\xea\x60\x08\0\0\0\0\xa5\xb9\x2a\x9e", 25);
  bytes.replace(8, header.size(), header);
  try {
    read_png(scratch.with("b.png", bytes));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("60000 x 60000"), std::string::npos) << error.what();
  }
}

TEST(Png, RefusesAChunkThatTheFileCannotHold) {
  const test::Scratch scratch;
  PngImage image = noise(1, 1, 1, 8);
  image.text = {{"Description", "words"}};
  write_png(scratch.path("a.png"), image);
  std::string bytes = read_whole_file(scratch.path("a.png"));
  bytes[bytes.find("iTXt") - 4] = 0x32;  // 800 MB, which libpng would make room for
  try {
    read_png(scratch.with("b.png", bytes));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("ends within a chunk"), std::string::npos) << error.what();
  }
}

TEST(Png, DamagedFilesDoNoHarm) {
  const test::Scratch scratch;
  PngImage image = noise(9, 8, 3, 16);
  image.text = {{"Description", "a text to be damaged"}};
  write_png(scratch.path("a.png"), image);
  const std::string bytes = read_whole_file(scratch.path("a.png"));
  test::refuses_truncations(scratch, bytes, read_png);
  test::survives_flips(scratch, bytes, 60, read_png);
  test::survives_flips(scratch, bytes_of(palette_png), 200, read_png);
}

TEST(Png, RefusesLayoutsThatPngDoesNotHave) {
  const test::Scratch scratch;
  for (const auto& [channels, bits, columns] :
       {std::tuple{0, 8, 1}, {5, 8, 1}, {3, 12, 1}, {3, 8, 0}, {3, 8, -4}}) {
    PngImage image;
    image.columns = columns, image.rows = 1, image.channels = channels, image.bits = bits;
    EXPECT_THROW(write_png(scratch.path("a.png"), image), InputError);
  }
  PngImage image = noise(3, 3, 3, 8);
  image.samples.pop_back();
  EXPECT_THROW(write_png(scratch.path("a.png"), image), InputError);
  image = noise(3, 3, 3, 8);
  image.text[""] = "no key";
  EXPECT_THROW(write_png(scratch.path("a.png"), image), InputError);
  EXPECT_TRUE(scratch.is_empty());
}

TEST(Png, NothingIsLeftBehindWhenARowCannotBeMade) {
  const test::Scratch scratch;
  const auto source = [](int row, std::span<std::uint16_t>) {
    if (row == 2) throw std::runtime_error("no third row");
  };
  EXPECT_THROW(write_png(scratch.path("a.png"), noise(3, 3, 3, 8), source), std::runtime_error);
  EXPECT_TRUE(scratch.is_empty());
}

TEST(Png, AFullDiskIsAFailureAndLeavesNothing) {
  const test::Scratch scratch;
  const PngImage image = noise(200, 200, 3, 16);
  std::signal(SIGXFSZ, SIG_IGN);  // writes beyond the limit then fail as on a full disk
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{20000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(write_png(scratch.path("a.png"), image), Failure);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_TRUE(scratch.is_empty());
}

}  // namespace
}  // namespace petzval
