// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/image/formats/exr_header.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

namespace petzval {

namespace {

// OpenEXR File Layout, 2013: magic, version and flags, then attributes (name, type, size, value) up to an
// empty name.
constexpr std::uint32_t magic = 20000630;
constexpr std::uint32_t deep_flag = 0x800, multi_part_flag = 0x1000;
constexpr std::size_t max_header_bytes = std::size_t{1} << 24;
// Deflate, the most efficient of the lossless codecs, makes at most 1032 bytes of one; PXR24 adds a third.
constexpr std::uint64_t max_expansion = 2048;
constexpr std::uint64_t smallest_tile_allowance =
    1u << 20;  // a small picture may come in one tile larger than itself

class Walker {
 public:
  Walker(const std::string& path, std::string_view header, std::uint64_t file_bytes)
      : path_(path), rest_(header), file_bytes_(file_bytes) {}

  void check() {
    if (rest_.size() < 8 || number() != magic) throw InputError(path_, "is not an OpenEXR file");
    const std::uint32_t flags = number();
    if (flags & (deep_flag | multi_part_flag))
      throw InputError(path_, "has several parts or deep pixels; a flat picture in one part is needed");
    for (std::string_view name; !(name = text()).empty();) take_attribute(name);
    compare();
  }

 private:
  [[noreturn]] void damaged() const { throw InputError(path_, "the header of this OpenEXR file is damaged"); }

  std::string_view bytes(std::size_t count) {
    if (count > rest_.size()) damaged();
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  std::uint32_t number() {
    std::uint32_t value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::int64_t integer() { return static_cast<std::int32_t>(number()); }
  std::string_view text() {
    const std::size_t end = rest_.find('\0');
    if (end == std::string_view::npos) damaged();
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return word;
  }

  /// OpenEXR reads values of these types without a look at the size that the file states: the next attribute
  /// would begin elsewhere for it than for us.
  static std::optional<std::size_t> size_of_type(std::string_view type) {
    static constexpr std::pair<std::string_view, std::size_t> sizes[] = {{"box2i", 16},
                                                                         {"box2f", 16},
                                                                         {"chromaticities", 32},
                                                                         {"compression", 1},
                                                                         {"deepImageState", 1},
                                                                         {"double", 8},
                                                                         {"envmap", 1},
                                                                         {"float", 4},
                                                                         {"int", 4},
                                                                         {"keycode", 28},
                                                                         {"lineOrder", 1},
                                                                         {"m33f", 36},
                                                                         {"m33d", 72},
                                                                         {"m44f", 64},
                                                                         {"m44d", 128},
                                                                         {"rational", 8},
                                                                         {"tiledesc", 9},
                                                                         {"timecode", 8},
                                                                         {"v2i", 8},
                                                                         {"v2f", 8},
                                                                         {"v2d", 16},
                                                                         {"v3i", 12},
                                                                         {"v3f", 12},
                                                                         {"v3d", 24}};
    for (const auto& [name, size] : sizes)
      if (type == name) return size;
    return std::nullopt;
  }

  void take_attribute(std::string_view name) {
    const std::string_view type = text();
    const std::string_view value = bytes(number());
    Walker inside(path_, value, file_bytes_);
    if (const std::optional<std::size_t> size = size_of_type(type); size && value.size() != *size) damaged();
    if (type == "chlist") inside.check_channel_list();
    if (type == "preview") inside.check_preview();
    if (name == "channels") bytes_per_pixel_ = inside.channel_bytes();
    if (name == "dataWindow") pixels_ = inside.window_pixels();
    if (name == "tiles") tile_pixels_ = std::uint64_t{inside.number()} * inside.number();
  }
  void check_channel_list() const {
    Walker list = *this;
    list.channel_bytes();
    if (!list.rest_.empty()) damaged();
  }
  void check_preview() const {
    Walker preview = *this;
    const std::uint64_t columns = preview.number(), rows = preview.number();
    constexpr std::uint64_t pixel_bytes = 4;
    if (rows != 0 && columns > preview.rest_.size() / rows) damaged();
    if (preview.rest_.size() != pixel_bytes * columns * rows) damaged();
  }
  std::uint64_t channel_bytes() {
    std::uint64_t sum = 0;
    while (!text().empty()) {
      constexpr std::uint32_t half = 1;
      sum += number() == half ? 2 : 4;
      bytes(12);  // linearity and sampling
    }
    return sum;
  }
  std::uint64_t window_pixels() {
    const std::int64_t left = integer(), top = integer(), right = integer(), bottom = integer();
    if (right < left || bottom < top) damaged();
    return static_cast<std::uint64_t>(right - left + 1) * static_cast<std::uint64_t>(bottom - top + 1);
  }

  void compare() const {
    if (pixels_ == 0 || bytes_per_pixel_ == 0) damaged();
    const std::uint64_t allowed = max_expansion * file_bytes_ / bytes_per_pixel_;
    if (pixels_ > allowed)
      throw InputError(path_, fmt::format("promises {} pixels of {} bytes, but the file has only {} bytes",
                                          pixels_, bytes_per_pixel_, file_bytes_));
    if (tile_pixels_ > allowed + smallest_tile_allowance) damaged();
  }

  const std::string& path_;
  std::string_view rest_;
  std::uint64_t file_bytes_;
  std::uint64_t pixels_ = 0, tile_pixels_ = 0, bytes_per_pixel_ = 0;
};

}  // namespace

void check_exr_header(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw InputError(path, "is a folder, not a file");
  std::ifstream file(path, std::ios::binary);
  const std::uint64_t file_bytes = std::filesystem::file_size(path, error);
  if (!file || error) throw InputError(path, "cannot be read");
  std::string header(static_cast<std::size_t>(std::min<std::uint64_t>(file_bytes, max_header_bytes)), '\0');
  file.read(header.data(), static_cast<std::streamsize>(header.size()));
  if (static_cast<std::size_t>(file.gcount()) != header.size()) throw InputError(path, "cannot be read");
  Walker(path, header, file_bytes).check();
}

}  // namespace petzval
