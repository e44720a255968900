// SPDX-License-Identifier: BSD-3-Clause
#include "npz_format.h"

#include <petzval/glass/byte_reader.h>
#include <petzval/image/formats/irradiance.h>
#include <petzval/image/formats/npz.h>
#include <petzval/optics/formats/psf_map.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "memory_file.h"
#include "require.h"

namespace petzval::fuzz {

namespace {

constexpr std::string_view mark = "ARRAY ";

/// Little-endian, as ZIP has them.
void put(std::string& bytes, std::uint64_t number, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(number >> (8 * i));
}

/// A ZIP file of entries that are not compressed (PKWARE APPNOTE 4.3).
class Archive {
 public:
  void add(const std::string& name, std::string_view data) {
    std::string entry;  // what both of its headers hold
    put(entry, 20, 2);  // version 2.0
    put(entry, 0, 8);   // flags, method, time and date
    put(entry, crc32(data), 4);
    put(entry, data.size(), 4);
    put(entry, data.size(), 4);
    put(entry, name.size(), 2);
    put(entry, 0, 2);  // no extra field
    directory_ += "PK\1\2";
    put(directory_, 20, 2);
    directory_ += entry;
    put(directory_, 0, 10);  // comment, disk, attributes
    put(directory_, entries_.size(), 4);
    directory_ += name;
    entries_ += "PK\3\4" + entry + name;
    entries_ += data;
    ++count_;
  }
  std::string bytes() const {
    std::string all = entries_ + directory_ + "PK\5\6";
    put(all, 0, 4);  // disks
    put(all, count_, 2);
    put(all, count_, 2);
    put(all, directory_.size(), 4);
    put(all, entries_.size(), 4);
    put(all, 0, 2);  // no comment
    return all;
  }

 private:
  std::string entries_, directory_;
  std::size_t count_ = 0;
};

std::string archive_of(std::string_view arrays) {
  Archive archive;
  while (arrays.starts_with(mark)) {
    arrays.remove_prefix(mark.size());
    const std::size_t line = std::min(arrays.find('\n'), arrays.size()),
                      end = std::min(arrays.find("\nARRAY ", line + 1), arrays.size());
    constexpr std::size_t longest_name = 64;
    archive.add(std::string(arrays.substr(0, std::min(line, longest_name))) + ".npy",
                arrays.substr(std::min(line + 1, end), end - std::min(line + 1, end)));
    arrays.remove_prefix(std::min(end + 1, arrays.size()));
  }
  return archive.bytes();
}

bool try_light(std::string_view archive) {
  const NamedFile file(archive, ".npz");
  return accepted([&] {
    const SpectralImage image = read_irradiance(file.path(), {{}, 4});
    require(image.columns() > 0 && image.rows() > 0 && image.bands() > 0, "an image without pixels");
    for (const float value : image.values()) require(std::isfinite(value), "light that is no number");
  });
}

}  // namespace

bool try_npz(std::string_view bytes) {
  const std::string archive = bytes.starts_with(mark) ? archive_of(bytes) : std::string(bytes);
  const MemoryFile file(archive);
  bool is_light = false;
  if (!accepted([&] {
        for (const NamedArray& each : read_npz(file.path())) {
          std::size_t count = 1;
          for (const std::size_t size : each.array.shape) count *= size;
          require(count == double_values(each.array).size(), "values that do not fill their shape");
          is_light = is_light || each.name == "irradiance";
        }
      }))
    return false;
  if (is_light) return try_light(archive);
  return accepted([&] {
    RayTraceReading reading;
    reading.g_axis_sr = 0.1;
    read_psf_map(file.path(), reading).table.validate();
  });
}

}  // namespace petzval::fuzz
