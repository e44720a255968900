// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/scene/formats/envi.h>
#include <petzval/scene/formats/envi_header.h>
#include <petzval/scene/formats/envi_planes.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>

namespace petzval {

namespace fs = std::filesystem;

namespace {

constexpr const char* gain_unit = "W.m^-2.sr^-1.um^-1";
constexpr std::uint64_t most_data_bytes = std::uint64_t{8} * Scene::max_values;
constexpr double envi_gib = 1024.0 * 1024 * 1024;

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

/// The file of numbers beside a header, or nothing.
std::string data_beside(const fs::path& header) {
  const fs::path stem = fs::path(header).replace_extension();
  for (const char* extension :
       {"", ".img", ".dat", ".raw", ".bsq", ".bil", ".bip", ".bin", ".cube", ".IMG", ".DAT", ".RAW"}) {
    const fs::path data = stem.string() + extension;
    if (is_file(data)) return data.string();
  }
  return {};
}

std::string data_of(const std::string& header) {
  std::string data = data_beside(header);
  if (data.empty())
    throw InputError(header, fmt::format("has no data beside it; {}.img or the like would be right",
                                         fs::path(header).replace_extension().string()));
  return data;
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
    throw InputError(header_file, fmt::format("{} would take {:.1f} GiB; up to {} values fit", size,
                                              static_cast<double>(needed / header.value_bytes()) *
                                                  sizeof(float) / envi_gib,
                                              Scene::max_values));
  const std::uint64_t held = there > header.offset ? there - header.offset : 0;
  if (held != needed)
    throw InputError(data_file,
                     fmt::format("holds {} bytes after its header offset of {}, but {} ({}) are {}", held,
                                 header.offset, needed, header_file, size));
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

std::string envi_companion(const std::string& path) {
  return is_header(path) ? data_beside(path) : header_of(path);
}

namespace {

SpectralCube cube_of(const EnviHeader& header, const std::string& header_file, const EnviBytes& bytes,
                     const CubeCheck& check = {}) {
  const std::vector<std::size_t> order = order_of(header, header_file);
  SpectralCube cube;
  cube.columns = header.columns, cube.rows = header.rows;
  cube.bands = static_cast<int>(order.size());
  if (!header.wavelengths_nm.empty())
    for (const std::size_t band : order) cube.wavelengths_nm.push_back(header.wavelengths_nm[band]);
  if (header.wavelengths_seem_um)
    cube.notes.push_back(fmt::format(
        "does not say the unit of its wavelengths: {:g} to {:g} nm are taken, for numbers in micrometres",
        cube.wavelengths_nm.front(), cube.wavelengths_nm.back()));
  say_what_it_is(header, cube);
  if (check) check(cube);
  cube.values = LargeFloats(order.size() * cube.band_size());
  read_envi_planes(header, order, bytes, cube);
  return cube;
}

}  // namespace

SpectralCube decode_envi(std::string_view header_text, std::string_view data, const std::string& header_file,
                         const std::string& data_file) {
  const EnviHeader header = parse_envi_header(header_text, header_file);
  check_size(header, data.size(), header_file, data_file);
  return cube_of(header, header_file, [data](std::uint64_t from, std::span<char> out) {
    std::copy_n(data.begin() + static_cast<std::ptrdiff_t>(from), out.size(), out.begin());
  });
}

SpectralCube read_envi(const std::string& path, const CubeCheck& check) {
  const std::string header_file = is_header(path) ? path : header_of(path);
  const std::string data_file = is_header(path) ? data_of(path) : path;
  const EnviHeader header = parse_envi_header(read_whole_file(header_file, largest_text), header_file);
  std::ifstream data(data_file, std::ios::binary);
  if (!data) throw InputError(data_file, "cannot be read");
  check_size(header, fs::file_size(data_file), header_file, data_file);
  const auto read = [&](std::uint64_t from, std::span<char> out) {
    data.seekg(static_cast<std::streamoff>(from));
    data.read(out.data(), static_cast<std::streamsize>(out.size()));
    if (data.gcount() != static_cast<std::streamsize>(out.size()))
      throw InputError(data_file, "became shorter while it was read");
  };
  return cube_of(header, header_file, read, check);
}

}  // namespace petzval
