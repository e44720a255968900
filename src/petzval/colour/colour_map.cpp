// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/colour/colour_map.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace petzval {

namespace {

// Ten evenly spaced entries of the maps of S. van der Walt and N. Smith (2015), dedicated to the public
// domain.
constexpr std::uint32_t viridis[] = {0x440154, 0x482878, 0x3E4989, 0x31688E, 0x26828E,
                                     0x1F9E89, 0x35B779, 0x6ECE58, 0xB5DE2B, 0xFDE725};
constexpr std::uint32_t inferno[] = {0x000004, 0x1B0C41, 0x4A0C6B, 0x781C6D, 0xA52C60,
                                     0xCF4446, 0xED6925, 0xFB9B06, 0xF7D13D, 0xFCFFA4};
constexpr std::uint32_t grey[] = {0x000000, 0xFFFFFF};

std::span<const std::uint32_t> anchors_of(ColourMap map) {
  if (map == ColourMap::viridis) return viridis;
  if (map == ColourMap::inferno) return inferno;
  return grey;
}

}  // namespace

Rgb8 from_hex(std::uint32_t rgb) {
  return {static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8),
          static_cast<std::uint8_t>(rgb)};
}

Rgb8 mixed(Rgb8 a, Rgb8 b, double t) {
  const auto channel = [t](int from, int to) {
    return static_cast<std::uint8_t>(std::lround(from + t * (to - from)));
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}

std::string Rgb8::hex() const {
  return fmt::format("#{:02x}{:02x}{:02x}", r, g, b);
}

std::array<Rgb8, 256> colour_table(ColourMap map) {
  const std::span<const std::uint32_t> anchors = anchors_of(map);
  std::array<Rgb8, 256> table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double position = static_cast<double>(i) / 255.0 * static_cast<double>(anchors.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(position), anchors.size() - 2);
    table[i] =
        mixed(from_hex(anchors[below]), from_hex(anchors[below + 1]), position - static_cast<double>(below));
  }
  return table;
}

}  // namespace petzval
