// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/transpose.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/npy_bands.h>
#include <petzval/image/formats/npy_file.h>
#include <petzval/image/formats/npy_header.h>
#include <petzval/image/formats/output_file.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <string_view>

namespace petzval {

namespace {

// ---- writing

template <class Value>
void write_array(const std::string& path, std::string_view type, std::span<const std::size_t> shape,
                 std::span<const Value> values) {
  if (shape.size() > npy_max_dimensions) throw InputError(path, "a .npy file has at most 32 dimensions");
  std::size_t count = 1;
  for (const std::size_t size : shape) count *= size;
  if (count != values.size())
    throw InputError(path, fmt::format("{} values for an array of {}", values.size(), count));
  OutputFile file(path);
  const std::string header = npy_header(type, shape, NpyOrder::c);
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

/// Pixel by pixel.
void write_pixels(const std::string& path, const SpectralImage& image, const NpyImageShape& shape) {
  OutputFile file(path);
  const std::string header =
      npy_header("<f4", std::array{shape.rows, shape.columns, shape.bands}, NpyOrder::c);
  file.write(header.data(), header.size());

  // Some rows are turned into pixels while those before them are written.
  constexpr std::size_t rows_at_once = 8;
  const std::size_t blocks = (shape.rows + rows_at_once - 1) / rows_at_once;
  const auto slots = static_cast<std::size_t>(thread_count()) + 1;
  std::vector<std::vector<float>> pixels(slots);
  parallel_stages(blocks, slots,
                  {[](std::size_t, std::size_t) {},
                   [&](std::size_t block, std::size_t slot) {
                     const std::size_t first = block * rows_at_once;
                     interleave(image, first, std::min(shape.rows, first + rows_at_once), pixels[slot]);
                   },
                   [&](std::size_t, std::size_t slot) {
                     file.write(pixels[slot].data(), pixels[slot].size() * sizeof(float));
                   }});
  file.commit();
}

/// \param done  told of bands that have been written.
void write_image(const std::string& path, const SpectralImage& image,
                 const std::function<void(int band)>& done) {
  const NpyImageShape shape = {static_cast<std::size_t>(image.rows()),
                               static_cast<std::size_t>(image.columns()),
                               static_cast<std::size_t>(image.bands())};
  if (!is_large_npy(shape)) return write_pixels(path, image, shape);
  OutputFile file(path);
  NpyBands bands(file.descriptor(), path, shape);
  for (int band = 0; band < image.bands(); ++band) {
    bands.add(image.band(band));
    image.release_memory();
    done(band);
  }
  bands.finish();
  file.commit();
}

// ---- reading

/// From (n0, n1, n2) with the first index running fastest to C order: some of n1 at a time, or a part of n0.
template <class Value>
void take_turned(const NpyFile& file, const std::array<std::size_t, 3>& sizes, std::vector<Value>& values) {
  constexpr std::size_t at_once = std::size_t{1} << 22, fewest = 16;
  const auto [n0, n1, n2] = sizes;
  const std::size_t most_high = std::min(n0, std::max(fewest, at_once / n2)),
                    most_wide = most_high < n0 ? 1 : std::max<std::size_t>(1, at_once / (n0 * n2));
  std::vector<Value> block;
  for (std::size_t second = 0; second < n1; second += most_wide)
    for (std::size_t first = 0; first < n0; first += most_high) {
      const std::size_t wide = std::min(most_wide, n1 - second), high = std::min(most_high, n0 - first);
      block.resize(wide * high * n2);
      for (std::size_t k = 0; k < n2; ++k)
        file.read((k * n1 + second) * n0 + first, std::span(block).subspan(k * wide * high, wide * high));
      for (std::size_t j = 0; j < wide; ++j)
        transpose<Value>({block.data() + j * high, wide * high}, n2, high,
                         {values.data() + (first * n1 + second + j) * n2, n1 * n2});
    }
}

/// The same for any number of indices.
template <class Value>
void take_one_by_one(const NpyFile& file, const std::vector<std::size_t>& shape, std::vector<Value>& values) {
  constexpr std::size_t at_once = 1 << 20;
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

template <class Value>
void take_fortran_order(const NpyFile& file, std::vector<Value>& values) {
  if (values.empty()) return;
  std::vector<std::size_t> shape = file.shape();
  std::erase(shape, std::size_t{1});  // says nothing about the order
  if (shape.size() < 2) return file.read(0, std::span(values));
  if (shape.size() == 2) return take_turned(file, {shape[0], 1, shape[1]}, values);
  if (shape.size() == 3) return take_turned(file, {shape[0], shape[1], shape[2]}, values);
  take_one_by_one(file, shape, values);
}

}  // namespace

void write_npy(const std::string& path, std::span<const std::size_t> shape, std::span<const float> values) {
  write_array(path, "<f4", shape, values);
}

void write_npy(const std::string& path, std::span<const std::size_t> shape, std::span<const double> values) {
  write_array(path, "<f8", shape, values);
}

void write_npy(const std::string& path, std::span<const std::size_t> shape,
               std::span<const std::int32_t> values) {
  write_array(path, "<i4", shape, values);
}

void write_npy(const std::string& path, const SpectralImage& image) {
  write_image(path, image, [](int) {});
}

void write_npy(const std::string& path, SpectralImage&& image) {
  write_image(path, image, [&](int band) { image.give_up_band(band); });
}

NpyArray read_npy(const std::string& path) {
  return array_of(NpyFile(path));
}

NpyArray array_of(const NpyFile& file) {
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
