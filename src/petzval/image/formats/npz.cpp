// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/npy_file.h>
#include <petzval/image/formats/npy_header.h>
#include <petzval/image/formats/npz.h>
#include <zip.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>

namespace petzval {

namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 32;
const std::string npy_ending = ".npy";

std::string npy_bytes(const NamedArray& named, const std::string& path) {
  return std::visit(
      [&]<class Value>(const std::vector<Value>& values) {
        std::size_t count = 1;
        for (const std::size_t size : named.array.shape) count *= size;
        if (count != values.size())
          throw InputError(path,
                           fmt::format("{}: {} values for an array of {}", named.name, values.size(), count));
        std::string bytes = npy_header(sizeof(Value) == 4 ? "<f4" : "<f8", named.array.shape, NpyOrder::c);
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
        return bytes;
      },
      named.array.values);
}

/// The bytes of an entry, no more than it says. \throws InputError if they cannot be had, or if their
/// checksum is another.
std::string entry_bytes(zip_t* archive, zip_uint64_t index, std::size_t size, const std::string& path) {
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(zip_fopen_index(archive, index, 0),
                                                               &zip_fclose);
  // A damaged file may say any size: room is made as bytes come.
  constexpr std::size_t most_at_once = std::size_t{16} << 20;
  std::string bytes;
  zip_int64_t got = file ? 1 : -1;
  while (got > 0 && bytes.size() < size) {
    const std::size_t done = bytes.size();
    bytes.resize(done + std::min(size - done, most_at_once));
    got = zip_fread(file.get(), bytes.data() + done, bytes.size() - done);
    bytes.resize(done + static_cast<std::size_t>(std::max<zip_int64_t>(got, 0)));
  }
  // libzip compares the checksum where the entry ends.
  char beyond = 0;
  if (bytes.size() < size || got < 0 || zip_fread(file.get(), &beyond, 1) != 0)
    throw InputError(path, "is damaged: an array cannot be unpacked");
  return bytes;
}

/// Whether a .npy file holds text: NumPy's types U (characters) and S (bytes), of any byte order and length.
bool holds_text(std::string_view npy) {
  constexpr std::string_view key = "'descr': '";
  const std::string_view header = npy.substr(0, 128);
  const std::size_t at = header.find(key);
  if (at == header.npos || at + key.size() + 1 >= header.size()) return false;
  const char kind = header[at + key.size() + 1];  // behind the byte order
  return kind == 'U' || kind == 'S';
}

}  // namespace

void write_npz(const std::string& path, const std::vector<NamedArray>& arrays) {
  std::vector<std::string> contents;
  for (const NamedArray& array : arrays) contents.push_back(npy_bytes(array, path));
  WholeFile file(path);
  int error = 0;
  zip_t* const archive = zip_open(file.temporary_path().c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
  const auto fail = [&] {
    if (archive) zip_discard(archive);
    throw Failure(fmt::format("{}: cannot be written", path));
  };
  if (!archive) fail();
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    zip_source_t* const source = zip_source_buffer(archive, contents[i].data(), contents[i].size(), 0);
    const zip_int64_t index =
        zip_file_add(archive, (arrays[i].name + npy_ending).c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
      zip_source_free(source);
      fail();
    }
    constexpr zip_uint16_t first_of_january_1980 = 0x21;  // the file says nothing of when
    zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0);
    zip_file_set_dostime(archive, static_cast<zip_uint64_t>(index), 0, first_of_january_1980, 0);
  }
  if (zip_close(archive) != 0) fail();
  file.commit();
}

std::vector<NamedArray> read_npz(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) throw InputError(path, "is no file that can be read");
  int error = 0;
  const std::unique_ptr<zip_t, void (*)(zip_t*)> archive(zip_open(path.c_str(), ZIP_RDONLY, &error),
                                                         &zip_discard);
  if (!archive) throw InputError(path, "is not a .npz file, or damaged");
  std::vector<NamedArray> arrays;
  std::size_t total = 0;
  const zip_int64_t entries = zip_get_num_entries(archive.get(), 0);
  for (zip_int64_t index = 0; index < entries; ++index) {
    zip_stat_t stat;
    zip_stat_init(&stat);
    const auto at = static_cast<zip_uint64_t>(index);
    if (zip_stat_index(archive.get(), at, 0, &stat) != 0 || !(stat.valid & ZIP_STAT_SIZE) || !stat.name)
      throw InputError(path, "is damaged: an entry has no name or size");
    std::string name = stat.name;
    if (!name.ends_with(npy_ending)) continue;
    name.resize(name.size() - npy_ending.size());
    if (stat.size > most_bytes - total) throw InputError(path, "holds more than 4 GiB of numbers");
    total += stat.size;
    std::string bytes = entry_bytes(archive.get(), at, stat.size, path);
    if (holds_text(bytes)) continue;
    arrays.push_back({name, array_of(NpyFile(std::move(bytes), path + ": " + quotable(name)))});
  }
  return arrays;
}

const NpyArray& find_array(const std::vector<NamedArray>& arrays, const std::string& name,
                           const std::string& path) {
  std::vector<std::string> names;
  for (const NamedArray& each : arrays) {
    if (each.name == name) return each.array;
    names.push_back(quotable(each.name));
  }
  throw InputError(path, fmt::format("has no array {}; it has {}", name,
                                     names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

std::vector<double> double_values(const NpyArray& array) {
  return std::visit([](const auto& values) { return std::vector<double>(values.begin(), values.end()); },
                    array.values);
}

}  // namespace petzval
