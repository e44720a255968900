// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/image/formats/exif_orientation.h>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace petzval {

namespace {

/// The TIFF file within the segment; reads beyond its end give nothing.
class TiffBytes {
 public:
  explicit TiffBytes(std::string_view bytes) : bytes_(bytes), big_endian_(bytes.starts_with("MM")) {}

  std::optional<std::uint32_t> number(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || bytes_.size() - at < size) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t index = at + (big_endian_ ? i : size - 1 - i);
      value = value << 8 | static_cast<unsigned char>(bytes_[index]);
    }
    return value;
  }

 private:
  std::string_view bytes_;
  bool big_endian_;
};

}  // namespace

int exif_orientation(std::string_view app1) {
  using namespace std::string_view_literals;
  constexpr std::string_view marker = "Exif\0\0"sv;
  constexpr std::uint32_t orientation_tag = 0x0112, short_type = 3;
  if (!app1.starts_with(marker)) return upright_orientation;
  const TiffBytes tiff(app1.substr(marker.size()));
  const std::optional<std::uint32_t> directory = tiff.number(4, 4);
  const std::optional<std::uint32_t> count = directory ? tiff.number(*directory, 2) : std::nullopt;
  for (std::uint32_t i = 0; count && i < *count; ++i) {
    const std::size_t entry = std::size_t{*directory} + 2 + 12 * std::size_t{i};
    if (tiff.number(entry, 2) != orientation_tag || tiff.number(entry + 2, 2) != short_type) continue;
    const std::optional<std::uint32_t> value = tiff.number(entry + 8, 2);
    return value && *value >= 1 && *value <= 8 ? static_cast<int>(*value) : upright_orientation;
  }
  return upright_orientation;
}

}  // namespace petzval
