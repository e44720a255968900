// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/npy_file.h>
#include <petzval/image/formats/output_file.h>

#include <bit>
#include <cstddef>
#include <string_view>

namespace petzval {

static_assert(std::endian::native == std::endian::little, "the .npy writer writes memory as it is");

namespace {

// ---- writing

/// Magic, version 1.0 and the header, padded with spaces so that the data start at a multiple of 64.
std::string header_bytes(std::string_view type, std::span<const std::size_t> shape) {
  std::string sizes;
  for (const std::size_t size : shape) sizes += fmt::format("{}, ", size);
  if (shape.size() > 1) sizes.resize(sizes.size() - 2);
  std::string dictionary =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, sizes);
  constexpr std::size_t before = 10;  // magic, two bytes of version, two of length
  dictionary.append(63 - (before + dictionary.size()) % 64, ' ');
  dictionary += '\n';
  std::string bytes(npy_magic);
  bytes += '\x01';
  bytes += '\x00';
  bytes += static_cast<char>(dictionary.size() & 0xff);
  bytes += static_cast<char>(dictionary.size() >> 8);
  return bytes + dictionary;
}

template <class Value>
void write_array(const std::string& path, std::string_view type, std::span<const std::size_t> shape,
                 std::span<const Value> values) {
  if (shape.size() > npy_max_dimensions) throw InputError(path, "a .npy file has at most 32 dimensions");
  std::size_t count = 1;
  for (const std::size_t size : shape) count *= size;
  if (count != values.size())
    throw InputError(path, fmt::format("{} values for an array of {}", values.size(), count));
  OutputFile file(path);
  const std::string header = header_bytes(type, shape);
  file.write(header.data(), header.size());
  file.write(values.data(), values.size_bytes());
  file.commit();
}

}  // namespace

void write_npy(const std::string& path, std::span<const std::size_t> shape, std::span<const float> values) {
  write_array(path, "<f4", shape, values);
}

void write_npy(const std::string& path, std::span<const std::size_t> shape, std::span<const double> values) {
  write_array(path, "<f8", shape, values);
}

void write_npy(const std::string& path, const SpectralImage& image) {
  const auto rows = static_cast<std::size_t>(image.rows()),
             columns = static_cast<std::size_t>(image.columns());
  const auto bands = static_cast<std::size_t>(image.bands());
  const std::size_t shape[] = {rows, columns, bands};
  OutputFile file(path);
  const std::string header = header_bytes("<f4", shape);
  file.write(header.data(), header.size());
  std::vector<float> line(columns * bands);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t band = 0; band < bands; ++band) {
      const std::span<const float> source =
          image.band(static_cast<int>(band)).subspan(row * columns, columns);
      for (std::size_t column = 0; column < columns; ++column) line[column * bands + band] = source[column];
    }
    file.write(line.data(), line.size() * sizeof(float));
    constexpr std::size_t rows_kept = 64;
    if (row % rows_kept == 0) image.release_memory();
  }
  file.commit();
}

NpyArray read_npy(const std::string& path) {
  const NpyFile file(path);
  NpyArray array{file.shape(), {}};
  const auto read = [&](auto values) {
    values.resize(file.size());
    file.read(0, std::span(values));
    array.values = std::move(values);
  };
  // Whole numbers become the smallest floating-point type that holds them all.
  if (file.needs_double())
    read(std::vector<double>());
  else
    read(std::vector<float>());
  return array;
}

}  // namespace petzval
