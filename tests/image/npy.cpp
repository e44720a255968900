// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/npy_file.h>

#include "hostile.h"
#include "python_program.h"

namespace petzval {
namespace {

const std::size_t shape_234[] = {2, 3, 4};

std::vector<double> counting(std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = 0.1 * static_cast<double>(i) - 0.7;
  return values;
}

/// A file as NEP 1 describes it, put together by hand.
std::string npy_bytes(char version, const std::string& header, const std::string& data) {
  std::string bytes = "\x93NUMPY";
  bytes += version;
  bytes += '\0';
  bytes += static_cast<char>(header.size());
  bytes += '\0';
  if (version > 1) bytes += std::string(2, '\0');
  return bytes + header + data;
}

TEST(Npy, RoundTripsExactly) {
  const test::Scratch scratch;
  const std::vector<double> doubles = counting(24);
  const std::vector<float> floats(doubles.begin(), doubles.end());
  write_npy(scratch.path("d.npy"), shape_234, doubles);
  write_npy(scratch.path("f.npy"), shape_234, floats);
  const NpyArray d = read_npy(scratch.path("d.npy")), f = read_npy(scratch.path("f.npy"));
  EXPECT_EQ(d.shape, (std::vector<std::size_t>{2, 3, 4}));
  EXPECT_EQ(std::get<std::vector<double>>(d.values), doubles);
  EXPECT_EQ(std::get<std::vector<float>>(f.values), floats);
}

TEST(Npy, DataStartAtAMultipleOf64) {
  const test::Scratch scratch;
  for (const std::size_t count : {1u, 10u, 100u, 1000u}) {
    const std::size_t shape[] = {count};
    write_npy(scratch.path("a.npy"), shape, std::vector<float>(count));
    EXPECT_EQ((read_whole_file(scratch.path("a.npy")).size() - 4 * count) % 64, 0u);
  }
}

// Kept in a file, whose room is given back while the pixels are written.
TEST(Npy, AnImageMayBeGivenUpWhileItIsWritten) {
  const test::Scratch scratch;
  SpectralImage image(4099, 4111, {400, 450, 500, 550, 600, 650, 700, 750}, 5);
  ASSERT_GT(image.values().size(), LargeFloats::most_in_memory);
  image.provenance = "stays";
  const auto value = [](std::size_t band, std::size_t pixel) {
    return static_cast<float>((8 * pixel + band) % 16777213);  // whole numbers of a float, hardly ever twice
  };
  std::vector<float> plane(image.band_size());
  for (std::size_t band = 0; band < 8; ++band) {
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = value(band, i);
    image.store_band(static_cast<int>(band), plane);
  }
  write_npy(scratch.path("i.npy"), std::move(image));
  EXPECT_EQ(image.provenance, "stays");
  EXPECT_EQ(image.rows(), 4111);
  const NpyFile file(scratch.path("i.npy"));
  EXPECT_EQ(file.shape(), (std::vector<std::size_t>{4111, 4099, 8}));
  std::vector<float> row(std::size_t{4099} * 8);
  std::size_t wrong = 0;
  for (std::size_t y = 0; y < 4111; ++y) {
    file.read(y * row.size(), std::span(row));
    for (std::size_t i = 0; i < row.size(); ++i)
      if (row[i] != value(i % 8, y * 4099 + i / 8)) ++wrong;
  }
  EXPECT_EQ(wrong, 0U);
}

TEST(Npy, AnImageIsRowsColumnsBands) {
  const test::Scratch scratch;
  SpectralImage image(3, 2, {450, 550}, 5);
  image.at(1, 0, 2) = 7;
  write_npy(scratch.path("i.npy"), image);
  const NpyArray array = read_npy(scratch.path("i.npy"));
  EXPECT_EQ(array.shape, (std::vector<std::size_t>{2, 3, 2}));
  const auto& values = std::get<std::vector<float>>(array.values);
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(values[i], i == (0 * 3 + 2) * 2 + 1 ? 7.0f : 0.0f);
}

TEST(Npy, OpensInNumpy) {
  if (!test::python_runs("import numpy")) GTEST_SKIP() << "no Python with numpy here";
  const test::Scratch scratch;
  write_npy(scratch.path("a.npy"), shape_234, counting(24));
  const std::string script =
      "import numpy, sys\n"
      "a = numpy.load(sys.argv[1])\n"
      "assert a.dtype == numpy.float64 and a.shape == (2, 3, 4) and a.flags.c_contiguous\n"
      "assert (a.ravel() == [0.1 * i - 0.7 for i in range(24)]).all()\n"
      "numpy.save(sys.argv[2], a.astype('>f4') * 2)\n"
      "numpy.lib.format.write_array(open(sys.argv[3], 'wb'), a, version=(2, 0))\n";
  ASSERT_EQ(
      test::run_python(scratch, script,
                       scratch.path("a.npy") + " " + scratch.path("big.npy") + " " + scratch.path("v2.npy")),
      0);
  const NpyArray big = read_npy(scratch.path("big.npy")), v2 = read_npy(scratch.path("v2.npy"));
  for (std::size_t i = 0; i < 24; ++i)
    EXPECT_EQ(std::get<std::vector<float>>(big.values)[i], 2 * static_cast<float>(counting(24)[i]));
  EXPECT_EQ(std::get<std::vector<double>>(v2.values), counting(24));
}

TEST(Npy, ReadsOtherVersionsByteOrdersAndScalars) {
  const test::Scratch scratch;
  const std::string big_one("\x3f\x80\0\0", 4), little_one("\0\0\x80\x3f", 4);
  const NpyArray big = read_npy(scratch.with(
      "big.npy", npy_bytes(1, "{'descr': '>f4', 'fortran_order': False, 'shape': (1,), }\n", big_one)));
  EXPECT_EQ(std::get<std::vector<float>>(big.values), std::vector<float>{1});
  const NpyArray scalar = read_npy(scratch.with(
      "v2.npy", npy_bytes(2, "{\"shape\": (), 'fortran_order':True,'descr':'<f4'}", little_one)));
  EXPECT_TRUE(scalar.shape.empty());
  EXPECT_EQ(std::get<std::vector<float>>(scalar.values), std::vector<float>{1});
  const NpyArray empty = read_npy(
      scratch.with("v3.npy", npy_bytes(3, "{'descr': '<f8', 'fortran_order': False, 'shape': (5, 0)}", "")));
  EXPECT_TRUE(std::get<std::vector<double>>(empty.values).empty());
}

/// IEEE 754-2008: 0x3c00 is 1, 0xc000 is −2, 0x0001 the least subnormal, 2^−24.
TEST(Npy, ReadsHalfPrecisionAndLongWholeNumbers) {
  const test::Scratch scratch;
  const auto read = [&](const std::string& type, int count, const std::string& data) {
    const std::string header =
        "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + std::to_string(count) + ",), }\n";
    return read_npy(scratch.with("a.npy", npy_bytes(1, header, data))).values;
  };
  const std::vector<float> halves = {1, -2, 0x1p-24F};
  EXPECT_EQ(std::get<std::vector<float>>(read("<f2", 3, std::string("\0\x3c\0\xc0\1\0", 6))), halves);
  EXPECT_EQ(std::get<std::vector<float>>(read(">f2", 3, std::string("\x3c\0\xc0\0\0\1", 6))), halves);
  // 2^40 + 1, which single precision would round.
  const std::string large("\1\0\0\0\0\1\0\0", 8), minus_two = "\xfe" + std::string(7, '\xff');
  EXPECT_EQ(std::get<std::vector<double>>(read("<i8", 2, large + minus_two)),
            (std::vector<double>{1099511627777.0, -2}));
  EXPECT_EQ(std::get<std::vector<double>>(read("<u8", 1, minus_two)), (std::vector<double>{0x1p64}));
}

/// In Fortran order the first index runs fastest: value 100 i + 10 j + k of (i, j, k) comes as 0, 100, 10, …
TEST(Npy, ReadsFortranOrder) {
  const test::Scratch scratch;
  std::string data;
  std::vector<float> wanted;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 2; ++i) data += static_cast<char>(100 * i + 10 * j + k);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 4; ++k) wanted.push_back(static_cast<float>(100 * i + 10 * j + k));
  const NpyArray array = read_npy(scratch.with(
      "f.npy", npy_bytes(1, "{'descr': '|u1', 'fortran_order': True, 'shape': (2, 3, 4)}", data)));
  EXPECT_EQ(array.shape, (std::vector<std::size_t>{2, 3, 4}));
  EXPECT_EQ(std::get<std::vector<float>>(array.values), wanted);
}

TEST(Npy, RefusesWhatItCannotHold) {
  const test::Scratch scratch;
  const auto refused = [&](const std::string& header, std::size_t bytes) {
    return !test::taken(read_npy, scratch.with("a.npy", npy_bytes(1, header, std::string(bytes, '\0'))),
                        header);
  };
  EXPECT_FALSE(refused("{'descr': '<f4', 'fortran_order': False, 'shape': (2,)}", 8));
  EXPECT_TRUE(refused("{'descr': '<f4', 'fortran_order': False, 'shape': (2,)}", 9));
  EXPECT_TRUE(refused("{'descr': '<f4', 'fortran_order': False, 'shape': (-2,)}", 8));
  EXPECT_TRUE(refused("{'descr': '<f4', 'fortran_order': False, 'shape': (2 1)}", 8));
  EXPECT_TRUE(refused("{'descr': '<c8', 'fortran_order': False, 'shape': (2,)}", 16));
  EXPECT_TRUE(refused("{'descr': '|b1', 'fortran_order': False, 'shape': (2,)}", 2));
  EXPECT_TRUE(refused("{'descr': '<f16', 'fortran_order': False, 'shape': (1,)}", 16));
  EXPECT_TRUE(refused("{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (2,)}", 8));
  EXPECT_TRUE(refused("{'descr': '<f4', 'shape': (2,)}", 8));
  // Sizes whose product wraps around 2^64 to a small number, and absurd ones.
  EXPECT_TRUE(refused("{'descr': '<f4', 'fortran_order': False, 'shape': (4294967296, 4294967296)}", 0));
  EXPECT_TRUE(refused("{'descr': '<f4', 'fortran_order': False, 'shape': (4294967297, 4294967297)}", 8));
  EXPECT_TRUE(refused("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999,)}", 8));
  EXPECT_THROW(write_npy(scratch.path("b.npy"), shape_234, std::vector<float>(23)), InputError);
  EXPECT_THROW(read_npy(scratch.path("missing.npy")), InputError);
}

TEST(Npy, DamagedFilesDoNoHarm) {
  const test::Scratch scratch;
  write_npy(scratch.path("a.npy"), shape_234, counting(24));
  const std::string bytes = read_whole_file(scratch.path("a.npy"));
  test::refuses_truncations(scratch, bytes, read_npy);
  test::survives_flips(scratch, bytes, 128, read_npy);
}

}  // namespace
}  // namespace petzval
