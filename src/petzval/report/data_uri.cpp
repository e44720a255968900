// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/report/data_uri.h>
#include <png.h>

#include <cstdint>

namespace petzval {

static_assert(sizeof(Rgb8) == 3, "libpng is handed the pixels as packed RGB bytes");

std::string base64(std::string_view bytes) {
  constexpr char alphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= count ? alphabet[group >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string data_uri(std::string_view mime, std::string_view bytes) {
  return fmt::format("data:{};base64,{}", mime, base64(bytes));
}

std::string encode_png(std::span<const Rgb8> pixels, int columns, int rows) {
  constexpr std::int64_t most_pixels = std::int64_t{1} << 28;
  const std::int64_t count = std::int64_t{columns} * rows;
  if (columns < 1 || rows < 1 || count > most_pixels || static_cast<std::size_t>(count) != pixels.size())
    throw InputError(
        fmt::format("a picture of {} x {} pixels cannot be made of {} values", columns, rows, pixels.size()));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(columns);
  image.height = static_cast<png_uint_32>(rows);
  image.format = PNG_FORMAT_RGB;
  std::string out(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = out.size();
  if (png_image_write_to_memory(&image, out.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
    throw Failure(fmt::format("a PNG could not be made: {}", image.message));
  out.resize(size);
  return out;
}

PixelSize png_size(std::string_view png) {
  constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
  if (png.size() < 24 || png.substr(0, 8) != signature)
    throw InputError("a picture in a report must be a PNG");
  const auto big_endian = [png](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<std::uint8_t>(png[at + k]);
    return static_cast<int>(value & 0x7FFFFFFF);
  };
  return {big_endian(16), big_endian(20)};
}

}  // namespace petzval
