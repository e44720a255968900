// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/report/colours.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace petzval {

namespace {

struct Anchor {
  double wavelength_nm;
  std::uint32_t rgb;
};
constexpr Anchor spectrum[] = {{380, 0x7A4FA3}, {410, 0x7B3FB5}, {436, 0x4C4FD6}, {486, 0x1F78D1},
                               {510, 0x12A08C}, {546, 0x2F9E3F}, {588, 0xD9900A}, {610, 0xE0601A},
                               {656, 0xCC2A2A}, {700, 0x961F2B}, {780, 0x7A2436}};

}  // namespace

Rgb8 series_colour(std::size_t index) {
  constexpr std::uint32_t palette[series_colour_count] = {0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7,
                                                          0xE69F00, 0x56B4E9, 0x696969};
  return from_hex(palette[index % series_colour_count]);
}

Rgb8 wavelength_colour(double wavelength_nm) {
  if (std::isnan(wavelength_nm)) return from_hex(0x7F7F7F);
  const auto above = std::find_if(std::begin(spectrum), std::end(spectrum), [&](const Anchor& anchor) {
    return anchor.wavelength_nm >= wavelength_nm;
  });
  if (above == std::begin(spectrum)) return from_hex(above->rgb);
  const Anchor& below = *(above - 1);
  if (above == std::end(spectrum)) return from_hex(below.rgb);
  const double t = (wavelength_nm - below.wavelength_nm) / (above->wavelength_nm - below.wavelength_nm);
  return mixed(from_hex(below.rgb), from_hex(above->rgb), t);
}

}  // namespace petzval
