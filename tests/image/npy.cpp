// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/npy_bands.h>
#include <petzval/image/formats/npy_file.h>

#include <filesystem>
#include <iterator>

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

/// Whole numbers of a float, hardly ever twice.
float large_value(std::size_t band, std::size_t pixel) {
  return static_cast<float>((8 * pixel + band) % 16777213);
}

constexpr std::size_t large_rows = 4111, large_columns = 4099, large_bands = 8;

std::vector<float> large_plane(std::size_t band) {
  std::vector<float> plane(large_rows * large_columns);
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = large_value(band, i);
  return plane;
}

void expect_large_image(const std::string& path) {
  const NpyFile file(path);
  ASSERT_EQ(file.shape(), (std::vector<std::size_t>{large_rows, large_columns, large_bands}));
  EXPECT_TRUE(file.fortran_order());
  std::vector<float> column(large_rows);
  std::size_t wrong = 0;
  for (std::size_t band = 0; band < large_bands; ++band)
    for (std::size_t x = 0; x < large_columns; ++x) {
      file.read((band * large_columns + x) * large_rows, std::span(column));
      for (std::size_t y = 0; y < large_rows; ++y)
        if (column[y] != large_value(band, y * large_columns + x)) ++wrong;
    }
  EXPECT_EQ(wrong, 0U);
}

// Kept in a file, whose room is given back while the bands are written.
TEST(Npy, AnImageMayBeGivenUpWhileItIsWritten) {
  const test::Scratch scratch;
  SpectralImage image(large_columns, large_rows, {400, 450, 500, 550, 600, 650, 700, 750}, 5);
  ASSERT_GT(image.values().size(), LargeFloats::most_in_memory);
  image.provenance = "stays";
  for (std::size_t band = 0; band < large_bands; ++band)
    image.store_band(static_cast<int>(band), large_plane(band));
  write_npy(scratch.path("i.npy"), std::move(image));
  EXPECT_EQ(image.provenance, "stays");
  EXPECT_EQ(image.rows(), static_cast<int>(large_rows));
  EXPECT_EQ(image.at(3, 5, 7), 0.0F) << "its room was not given back";
  expect_large_image(scratch.path("i.npy"));
}

TEST(NpyBands, TakeAnImageBandByBand) {
  const test::Scratch scratch;
  const NpyImageShape shape = {large_rows, large_columns, large_bands};
  ASSERT_TRUE(is_large_npy(shape));
  NpyBandFile file(scratch.path("i.npy"), shape);
  if (!file) GTEST_SKIP() << "no files without a name here";
  for (std::size_t band = 0; band < large_bands; ++band) file.bands().add(large_plane(band));
  EXPECT_TRUE(std::filesystem::is_empty(scratch.folder())) << "nothing may be left of it yet";
  write_whole_file(scratch.path("i.npy"), "before");
  file.put_at(scratch.path("i.npy"));
  expect_large_image(scratch.path("i.npy"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.folder()), {}), 1);
}

TEST(NpyBands, RefuseWhatIsNoBandOfTheirs) {
  const test::Scratch scratch;
  NpyBandFile file(scratch.path("i.npy"), {2, 3, 2});
  if (!file) GTEST_SKIP() << "no files without a name here";
  EXPECT_THROW(file.bands().add(std::vector<float>(5)), InputError);
  file.bands().add(std::vector<float>(6));
  EXPECT_THROW(file.put_at(scratch.path("i.npy")), InputError);
  file.bands().add(std::vector<float>(6));
  EXPECT_THROW(file.bands().add(std::vector<float>(6)), InputError);
  EXPECT_FALSE(std::filesystem::exists(scratch.path("i.npy")));
}

TEST(NpyBands, OpenInNumpy) {
  if (!test::python_runs("import numpy")) GTEST_SKIP() << "no Python with numpy here";
  const test::Scratch scratch;
  NpyBandFile file(scratch.path("a.npy"), {2, 3, 2});
  if (!file) GTEST_SKIP() << "no files without a name here";
  file.bands().add(std::vector<float>{0, 10, 20, 100, 110, 120});
  file.bands().add(std::vector<float>{1, 11, 21, 101, 111, 121});
  file.put_at(scratch.path("a.npy"));
  const std::string script =
      "import numpy, sys\n"
      "a = numpy.load(sys.argv[1])\n"
      "assert a.dtype == numpy.float32 and a.shape == (2, 3, 2) and a.flags.f_contiguous\n"
      "for i, j, k in numpy.ndindex(a.shape): assert a[i, j, k] == 100 * i + 10 * j + k\n";
  EXPECT_EQ(test::run_python(scratch, script, scratch.path("a.npy")), 0);
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

/// The same where it takes several looks at the file; also with sizes of 1, which say nothing about the
/// order, and more than three of them.
TEST(Npy, ReadsLargeArraysInFortranOrder) {
  const test::Scratch scratch;
  for (const std::vector<std::size_t>& shape : std::vector<std::vector<std::size_t>>{
           {2100, 5, 900}, {7, 300001, 3}, {3000000, 2}, {2, 1, 3000001}, {17, 1500, 1, 201}, {6, 5, 4, 3}}) {
    std::size_t count = 1;
    std::string sizes;
    for (const std::size_t size : shape) count *= size, sizes += std::to_string(size) + ", ";
    std::string data(count, '\0');
    for (std::size_t i = 0; i < count; ++i) data[i] = static_cast<char>((i * 2654435761U) >> 20);
    const NpyArray array = read_npy(scratch.with(
        "f.npy", npy_bytes(1, "{'descr': '|u1', 'fortran_order': True, 'shape': (" + sizes + ")}", data)));
    const auto& values = std::get<std::vector<float>>(array.values);
    std::vector<std::size_t> index(shape.size(), 0);
    std::size_t wrong = 0;
    for (std::size_t at = 0; at < count; ++at) {  // in C order: the last index runs fastest
      std::size_t in_file = 0;
      for (std::size_t i = shape.size(); i-- > 0;) in_file = in_file * shape[i] + index[i];
      if (values[at] != float(static_cast<unsigned char>(data[in_file]))) ++wrong;
      for (std::size_t i = shape.size(); i-- > 0;) {
        if (++index[i] < shape[i]) break;
        index[i] = 0;
      }
    }
    EXPECT_EQ(wrong, 0U) << sizes;
  }
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
