// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/isp/colour_rendering.h>

#include <cmath>
#include <cstdint>
#include <utility>

namespace petzval {

namespace {

/// Numbers as ICC files hold them: high byte first.
void put(std::string& bytes, std::uint32_t value, int count) {
  for (int i = count - 1; i >= 0; --i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
}
/// s15Fixed16Number.
void put_fixed(std::string& bytes, double value) {
  put(bytes, static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value * 65536))), 4);
}

/// multiLocalizedUnicodeType with one text in English.
std::string text_tag(const std::string& text) {
  std::string bytes("mluc\0\0\0\0", 8);
  put(bytes, 1, 4);
  put(bytes, 12, 4);  // bytes of a record
  bytes += "enUS";
  put(bytes, static_cast<std::uint32_t>(2 * text.size()), 4);
  put(bytes, 28, 4);  // where it begins
  for (const char c : text) put(bytes, static_cast<unsigned char>(c), 2);
  return bytes;
}

std::string xyz_tag(Xyz colour) {
  std::string bytes("XYZ \0\0\0\0", 8);
  for (const double value : {colour.x, colour.y, colour.z}) put_fixed(bytes, value);
  return bytes;
}

std::string matrix_tag(const ColourMatrix& matrix) {
  std::string bytes("sf32\0\0\0\0", 8);
  for (const auto& row : matrix)
    for (const double value : row) put_fixed(bytes, value);
  return bytes;
}

/// The transfer curve of sRGB: Y = (aX + b)^g above d, cX below.
std::string curve_tag() {
  std::string bytes("para\0\0\0\0", 8);
  put(bytes, 3, 2);
  put(bytes, 0, 2);
  for (const double value : {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045}) put_fixed(bytes, value);
  return bytes;
}

Xyz primary(const ColourMatrix& xyz_from_display, std::size_t index) {
  return {xyz_from_display[0][index], xyz_from_display[1][index], xyz_from_display[2][index]};
}

/// The inverse, by cofactors.
ColourMatrix inverse(const ColourMatrix& m) {
  ColourMatrix result{};
  const auto minor = [&](std::size_t r, std::size_t c) {
    const std::size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) result[c][r] = minor(r, c) / determinant;
  return result;
}

constexpr std::size_t header_bytes = 128;

std::string header(std::size_t size) {
  std::string bytes;
  put(bytes, static_cast<std::uint32_t>(size), 4);
  put(bytes, 0, 4);           // no preferred module
  put(bytes, 0x04200000, 4);  // version 4.2
  bytes += "mntrRGB XYZ ";
  for (const std::uint32_t part : {2026u, 1u, 1u, 0u, 0u, 0u})
    put(bytes, part, 2);  // a date there must be; never today's
  bytes += "acsp";
  // Illuminant of the connection space, as the standard rounds it.
  bytes.resize(68, '\0');
  for (const double value : {0.9642, 1.0, 0.8249}) put_fixed(bytes, value);
  bytes.resize(header_bytes, '\0');
  return bytes;
}

}  // namespace

std::string icc_profile(DisplaySpace space) {
  const ColourMatrix adapt = bradford_adaptation(display_white(), {0.9642, 1, 0.8249});
  const ColourMatrix colorants = adapt * inverse(display_from_xyz(space));
  const std::string curve = curve_tag();
  const std::pair<const char*, std::string> tags[] = {
      {"desc", text_tag(space == DisplaySpace::srgb ? "sRGB" : "Display P3")},
      {"cprt", text_tag("no copyright: figures of public standards")},
      {"wtpt", xyz_tag({0.9642, 1, 0.8249})},
      {"chad", matrix_tag(adapt)},
      {"rXYZ", xyz_tag(primary(colorants, 0))},
      {"gXYZ", xyz_tag(primary(colorants, 1))},
      {"bXYZ", xyz_tag(primary(colorants, 2))},
      {"rTRC", curve},
      {"gTRC", curve},
      {"bTRC", curve}};
  std::string table, data;
  put(table, static_cast<std::uint32_t>(std::size(tags)), 4);
  const std::size_t data_start = header_bytes + 4 + 12 * std::size(tags);
  std::size_t curve_start = 0;
  for (const auto& [name, bytes] : tags) {
    const bool again = bytes == curve && curve_start != 0;  // the three curves share their bytes
    const std::size_t start = again ? curve_start : data_start + data.size();
    if (bytes == curve) curve_start = start;
    table += name;
    put(table, static_cast<std::uint32_t>(start), 4);
    put(table, static_cast<std::uint32_t>(bytes.size()), 4);
    if (!again) data += bytes;
    data.resize((data.size() + 3) / 4 * 4, '\0');
  }
  return header(data_start + data.size()) + table + data;
}

}  // namespace petzval
