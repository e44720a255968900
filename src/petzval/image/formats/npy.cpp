// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/npy_file.h>
#include <petzval/image/formats/output_file.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <functional>
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

/// Rows `first` to `end` with the bands of a pixel side by side.
void interleave(const SpectralImage& image, std::size_t first, std::size_t end, std::vector<float>& pixels) {
  const auto columns = static_cast<std::size_t>(image.columns()),
             bands = static_cast<std::size_t>(image.bands());
  pixels.resize((end - first) * columns * bands);
  for (std::size_t row = first; row < end; ++row)
    for (std::size_t band = 0; band < bands; ++band) {
      const float* in = image.band(static_cast<int>(band)).data() + row * columns;
      float* out = pixels.data() + (row - first) * columns * bands + band;
      for (std::size_t column = 0; column < columns; ++column, out += bands) *out = in[column];
    }
}

/// \param done  told of rows that have been written; may be empty.
void write_image(const std::string& path, const SpectralImage& image,
                 const std::function<void(int first, int count)>& done) {
  const auto rows = static_cast<std::size_t>(image.rows());
  const std::size_t shape[] = {rows, static_cast<std::size_t>(image.columns()),
                               static_cast<std::size_t>(image.bands())};
  OutputFile file(path);
  const std::string header = header_bytes("<f4", shape);
  file.write(header.data(), header.size());

  // Some rows are turned into pixels while those before them are written. What is given up in pieces as
  // large as these the system uses at once for what is written next.
  constexpr std::size_t rows_at_once = 8, bytes_given_up = std::size_t{4} << 20;
  const std::size_t blocks = (rows + rows_at_once - 1) / rows_at_once;
  const std::size_t rows_given_up = std::max(rows_at_once, bytes_given_up / (shape[1] * sizeof(float)));
  const auto slots = static_cast<std::size_t>(thread_count()) + 1;
  std::vector<std::vector<float>> pixels(slots);
  std::size_t written = 0, given_up = 0;
  const auto end_of = [&](std::size_t block) { return std::min(rows, (block + 1) * rows_at_once); };
  parallel_stages(blocks, slots,
                  {[](std::size_t, std::size_t) {},
                   [&](std::size_t block, std::size_t slot) {
                     interleave(image, block * rows_at_once, end_of(block), pixels[slot]);
                   },
                   [&](std::size_t block, std::size_t slot) {
                     file.write(pixels[slot].data(), pixels[slot].size() * sizeof(float));
                     written = end_of(block);
                     if (written - given_up < rows_given_up && written < rows) return;
                     image.release_memory();
                     if (done) done(static_cast<int>(given_up), static_cast<int>(written - given_up));
                     given_up = written;
                   }});
  file.commit();
}

// ---- reading

/// All values in C order, from a file that has the first index running fastest, some at a time.
template <class Value>
void take_fortran_order(const NpyFile& file, std::vector<Value>& values) {
  constexpr std::size_t at_once = 1 << 20;
  const std::vector<std::size_t>& shape = file.shape();
  std::vector<std::size_t> steps(shape.size(), 1), index(shape.size(), 0);
  for (std::size_t i = shape.size() - 1; i > 0; --i) steps[i - 1] = steps[i] * shape[i];
  std::vector<Value> block;
  std::size_t to = 0;
  for (std::size_t first = 0; first < values.size(); first += at_once) {
    block.resize(std::min(at_once, values.size() - first));
    file.read(first, std::span(block));
    for (const Value value : block) {
      values[to] = value;
      for (std::size_t i = 0; i < shape.size(); ++i) {  // the next index, as a counter turns
        to += steps[i];
        if (++index[i] < shape[i]) break;
        to -= steps[i] * shape[i];
        index[i] = 0;
      }
    }
  }
}

}  // namespace

void write_npy(const std::string& path, std::span<const std::size_t> shape, std::span<const float> values) {
  write_array(path, "<f4", shape, values);
}

void write_npy(const std::string& path, std::span<const std::size_t> shape, std::span<const double> values) {
  write_array(path, "<f8", shape, values);
}

void write_npy(const std::string& path, const SpectralImage& image) {
  write_image(path, image, {});
}

void write_npy(const std::string& path, SpectralImage&& image) {
  write_image(path, image, [&](int first, int count) { image.give_up_rows(first, count); });
}

NpyArray read_npy(const std::string& path) {
  const NpyFile file(path);
  NpyArray array{file.shape(), {}};
  const auto read = [&](auto values) {
    values.resize(file.size());
    if (file.fortran_order())
      take_fortran_order(file, values);
    else
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
