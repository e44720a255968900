// SPDX-License-Identifier: BSD-3-Clause
// Colours of series, as those see them who lack a kind of cone.
#include <gtest/gtest.h>
#include <petzval/colour/cielab.h>
#include <petzval/colour/display.h>
#include <petzval/report/colours.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

struct Vision {
  const char* name;
  Matrix linear_srgb;
};
/// Machado, Oliveira and Fernandes, "A physiologically-based model for simulation of color vision
/// deficiency", IEEE TVCG 15 (2009), severity 1.0, on linear sRGB.
constexpr Vision visions[] = {
    {"all cones", {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
    {"protanopia",
     {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}}},
    {"deuteranopia",
     {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}}},
    {"tritanopia",
     {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}}};

/// A difference of 2.3 is just noticeable between areas (Mahy, Van Eycken and Oosterlinck 1994); lines need
/// several times that (Szafir 2018). The bound was set before it was measured.
constexpr double least_delta_e = 10;

Lab seen(Rgb8 colour, const Vision& vision) {
  constexpr double full = 255;
  const std::array<double, 3> linear{srgb_decoded(colour.r / full), srgb_decoded(colour.g / full),
                                     srgb_decoded(colour.b / full)};
  std::array<double, 3> left{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t i = 0; i < 3; ++i) left[row] += vision.linear_srgb[row][i] * linear[i];
    left[row] = std::clamp(left[row], 0.0, 1.0);
  }
  return cielab(xyz_of(LinearRgb{left[0], left[1], left[2]}), display_white());
}

TEST(ColourBlindness, LeavesAnyTwoSeriesApart) {
  for (const Vision& vision : visions)
    for (std::size_t a = 0; a < series_colour_count; ++a)
      for (std::size_t b = 0; b < a; ++b)
        EXPECT_GE(delta_e_2000(seen(series_colour(a), vision), seen(series_colour(b), vision)), least_delta_e)
            << series_colour(a).hex() << " and " << series_colour(b).hex() << ", " << vision.name;
}

TEST(ColourBlindness, LeavesTheUsualWavelengthsApart) {
  constexpr double f_d_c[] = {486.13, 587.56, 656.27};
  for (const Vision& vision : visions)
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < a; ++b)
        EXPECT_GE(delta_e_2000(seen(wavelength_colour(f_d_c[a]), vision),
                               seen(wavelength_colour(f_d_c[b]), vision)),
                  least_delta_e)
            << f_d_c[a] << " and " << f_d_c[b] << " nm, " << vision.name;
}

TEST(ColourBlindness, LeavesSeriesApartFromWhatIsBehindThem) {
  // Cards and glass of the page of petzval live, light and dark (web/style.css); paper.
  for (const std::uint32_t ground : {0xFFFFFF, 0x161D26, 0xBCD9F2, 0x24466A})
    for (const Vision& vision : visions)
      for (std::size_t i = 0; i < series_colour_count; ++i)
        EXPECT_GE(delta_e_2000(seen(series_colour(i), vision), seen(from_hex(ground), vision)), least_delta_e)
            << series_colour(i).hex() << " on " << from_hex(ground).hex() << ", " << vision.name;
}

TEST(ColourBlindness, IsOneThatMixesUpRedAndGreen) {
  // The simulation itself: a red and a green that deuteranopes are known to mix up, and that others do not.
  const Rgb8 red = from_hex(0x9C6B3C), green = from_hex(0x7A7A3C);
  EXPECT_LT(delta_e_2000(seen(red, visions[2]), seen(green, visions[2])),
            delta_e_2000(seen(red, visions[0]), seen(green, visions[0])) / 2);
}

}  // namespace
}  // namespace petzval
