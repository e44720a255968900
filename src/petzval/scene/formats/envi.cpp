// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/whole_file.h>
#include <petzval/scene/formats/envi.h>
#include <petzval/scene/formats/envi_header.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <numeric>

namespace petzval {

namespace fs = std::filesystem;

namespace {

constexpr const char* gain_unit = "W.m^-2.sr^-1.um^-1";
constexpr std::uint64_t most_data_bytes = std::uint64_t{8} * Scene::max_values;
constexpr double gib = 1024.0 * 1024 * 1024;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

bool is_header(const fs::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".hdr" || extension == ".HDR";
}

/// The header beside a file of numbers, or nothing.
std::string header_of(const fs::path& data) {
  for (const char* extension : {".hdr", ".HDR"}) {
    const fs::path added = data.string() + extension;
    if (is_file(added)) return added.string();
    const fs::path replaced = fs::path(data).replace_extension(extension);
    if (is_file(replaced)) return replaced.string();
  }
  return {};
}

/// The file of numbers beside a header.
std::string data_of(const fs::path& header) {
  const fs::path stem = fs::path(header).replace_extension();
  for (const char* extension :
       {"", ".img", ".dat", ".raw", ".bsq", ".bil", ".bip", ".bin", ".cube", ".IMG", ".DAT", ".RAW"}) {
    const fs::path data = stem.string() + extension;
    if (is_file(data)) return data.string();
  }
  throw InputError(header.string(),
                   fmt::format("has no data beside it; {}.img or the like would be right", stem.string()));
}

double value_at(const char* bytes, int data_type) {
  const auto as = [bytes](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  };
  switch (data_type) {
    case 1:
      return as(std::uint8_t{});
    case 2:
      return as(std::int16_t{});
    case 3:
      return as(std::int32_t{});
    case 4:
      return as(float{});
    case 5:
      return as(double{});
    case 12:
      return as(std::uint16_t{});
    case 13:
      return as(std::uint32_t{});
    case 14:
      return as(std::int64_t{});
    default:
      return as(std::uint64_t{});
  }
}

/// Where a number lies, in numbers from the start.
std::size_t index_of(const EnviHeader& header, std::size_t row, std::size_t column, std::size_t band) {
  const auto columns = static_cast<std::size_t>(header.columns), rows = static_cast<std::size_t>(header.rows);
  const auto bands = static_cast<std::size_t>(header.bands);
  switch (header.interleave) {
    case EnviInterleave::bil:
      return (row * bands + band) * columns + column;
    case EnviInterleave::bip:
      return (row * columns + column) * bands + band;
    default:
      return (band * rows + row) * columns + column;
  }
}

/// Numbers of a band as they are meant: what they are multiplied with and what is added.
struct Calibration {
  double gain = 1, offset = 0;
};

Calibration calibration(const EnviHeader& header, std::size_t band) {
  const auto of = [band](const std::vector<double>& values, double otherwise) {
    return values.empty() ? otherwise : values[band];
  };
  if (header.reflectance_scale) return {1 / *header.reflectance_scale, 0};
  if (!header.reflectance_gains.empty() || !header.reflectance_offsets.empty())
    return {of(header.reflectance_gains, 1), of(header.reflectance_offsets, 0)};
  return {of(header.gains, 1), of(header.offsets, 0)};
}

/// Bands to keep, by wavelength.
std::vector<std::size_t> order_of(const EnviHeader& header, const std::string& file) {
  std::vector<std::size_t> order;
  for (std::size_t band = 0; band < static_cast<std::size_t>(header.bands); ++band)
    if (header.good.empty() || header.good[band]) order.push_back(band);
  if (order.empty()) throw InputError(file, "calls all of its bands bad (bbl)");
  const std::vector<double>& nm = header.wavelengths_nm;
  if (nm.empty()) return order;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return nm[a] < nm[b]; });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (nm[order[i]] == nm[order[i - 1]])
      throw InputError(file, fmt::format("has two bands at {} nm", nm[order[i]]));
  return order;
}

/// Before any room is made.
void check_size(const EnviHeader& header, std::uint64_t there, const std::string& header_file,
                const std::string& data_file) {
  const std::uint64_t needed = header.data_bytes();
  const std::string size = fmt::format("{} x {} samples in {} bands of {} bytes", header.columns, header.rows,
                                       header.bands, header.value_bytes());
  if (needed > most_data_bytes || needed / header.value_bytes() > Scene::max_values)
    throw InputError(header_file,
                     fmt::format("{} would take {:.1f} GiB; up to {} values fit", size,
                                 static_cast<double>(needed / header.value_bytes()) * sizeof(float) / gib,
                                 Scene::max_values));
  const std::uint64_t held = there > header.offset ? there - header.offset : 0;
  if (held != needed)
    throw InputError(data_file,
                     fmt::format("holds {} bytes after its header offset of {}, but {} ({}) are {}", held,
                                 header.offset, needed, header_file, size));
}

void take_band(const EnviHeader& header, std::string_view data, std::size_t band, std::span<float> plane) {
  const std::size_t size = header.value_bytes(), columns = static_cast<std::size_t>(header.columns);
  const Calibration meant = calibration(header, band);
  for (std::size_t i = 0; i < plane.size(); ++i) {
    std::array<char, 8> bytes{};
    const char* const from = data.data() + index_of(header, i / columns, i % columns, band) * size;
    std::copy_n(from, size, bytes.begin());
    if (header.big_endian) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    const double number = value_at(bytes.data(), header.data_type);
    plane[i] = header.ignored && number == *header.ignored
                   ? 0.0f
                   : static_cast<float>(meant.gain * number + meant.offset);
  }
}

void say_what_it_is(const EnviHeader& header, SpectralCube& cube) {
  const bool reflectance =
      header.reflectance_scale || !header.reflectance_gains.empty() || !header.reflectance_offsets.empty();
  const bool radiance = !header.gains.empty() || !header.offsets.empty() || !header.units.empty();
  if (reflectance) cube.quantity = SceneQuantity::reflectance;
  if (!reflectance && radiance) {
    cube.quantity = SceneQuantity::radiance;
    cube.radiance_unit = header.units.empty() ? gain_unit : header.units;
  }
}

}  // namespace

bool is_envi_path(const std::string& path) {
  return is_header(path) || !header_of(path).empty();
}

SpectralCube decode_envi(std::string_view header_text, std::string_view data, const std::string& header_file,
                         const std::string& data_file) {
  const EnviHeader header = parse_envi_header(header_text, header_file);
  check_size(header, data.size(), header_file, data_file);
  data.remove_prefix(header.offset);
  const std::vector<std::size_t> order = order_of(header, header_file);
  SpectralCube cube;
  cube.columns = header.columns, cube.rows = header.rows;
  cube.values.resize(order.size() * cube.band_size());
  parallel_for(order.size(), [&](std::size_t i) {
    take_band(header, data, order[i], std::span(cube.values).subspan(i * cube.band_size(), cube.band_size()));
  });
  if (!header.wavelengths_nm.empty())
    for (const std::size_t band : order) cube.wavelengths_nm.push_back(header.wavelengths_nm[band]);
  say_what_it_is(header, cube);
  return cube;
}

SpectralCube read_envi(const std::string& path) {
  const std::string header_file = is_header(path) ? path : header_of(path);
  const std::string data_file = is_header(path) ? data_of(path) : path;
  const std::string header_text = read_whole_file(header_file);
  // Looked at twice, so that a file is not read for nothing.
  const EnviHeader header = parse_envi_header(header_text, header_file);
  check_size(header, fs::file_size(data_file), header_file, data_file);
  return decode_envi(header_text, read_whole_file(data_file, most_data_bytes), header_file, data_file);
}

}  // namespace petzval
