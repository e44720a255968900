// SPDX-License-Identifier: BSD-3-Clause
// False colours for numbers.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace petzval {

/// 8-bit sRGB.
struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
  /// "#rrggbb"
  std::string hex() const;
  friend bool operator==(const Rgb8&, const Rgb8&) = default;
};

/// 0xRRGGBB.
Rgb8 from_hex(std::uint32_t rgb);
/// t of the way from a to b, in code values.
Rgb8 mixed(Rgb8 a, Rgb8 b, double t);

enum class ColourMap { grey, viridis, inferno };

/// 256 colours from dark to light; all three grow steadily in lightness, so they survive a grey printer.
std::array<Rgb8, 256> colour_table(ColourMap map);

}  // namespace petzval
