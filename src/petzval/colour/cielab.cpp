// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/colour/cielab.h>

#include <cmath>

namespace petzval {

namespace {

constexpr double foot = 6.0 / 29;  // where the cube root gives way to a straight line

double lightness_of(double ratio) {
  return ratio > foot * foot * foot ? std::cbrt(ratio) : ratio / (3 * foot * foot) + 4.0 / 29;
}

double ratio_of(double lightness) {
  return lightness > foot ? lightness * lightness * lightness : 3 * foot * foot * (lightness - 4.0 / 29);
}

void check(Xyz white) {
  if (!(white.x > 0 && white.y > 0 && white.z > 0))
    throw InputError("a white must have positive tristimulus values");
}

double seventh_power_ratio(double chroma) {
  const double c7 = std::pow(chroma, 7), k = std::pow(25.0, 7);
  return std::sqrt(c7 / (c7 + k));
}

/// In [0, 2π); 0 for grey.
double hue(double a, double b) {
  if (a == 0 && b == 0) return 0;
  const double angle = std::atan2(b, a);
  return angle < 0 ? angle + 2 * pi : angle;
}

}  // namespace

Lab cielab(Xyz colour, Xyz white) {
  check(white);
  const double x = lightness_of(colour.x / white.x), y = lightness_of(colour.y / white.y),
               z = lightness_of(colour.z / white.z);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Xyz xyz_of(Lab colour, Xyz white) {
  check(white);
  const double y = (colour.l + 16) / 116;
  return {white.x * ratio_of(y + colour.a / 500), white.y * ratio_of(y),
          white.z * ratio_of(y - colour.b / 200)};
}

double delta_e_ab(Lab a, Lab b) {
  return std::hypot(a.l - b.l, a.a - b.a, a.b - b.b);
}

double delta_e_2000(Lab one, Lab two) {
  // Step 1: a stretched, so that greys are even.
  const double mean_chroma = (std::hypot(one.a, one.b) + std::hypot(two.a, two.b)) / 2;
  const double stretch = 1.5 - 0.5 * seventh_power_ratio(mean_chroma);
  const double a1 = stretch * one.a, a2 = stretch * two.a;
  const double c1 = std::hypot(a1, one.b), c2 = std::hypot(a2, two.b);
  const double h1 = hue(a1, one.b), h2 = hue(a2, two.b);
  const bool grey = c1 * c2 == 0;

  // Step 2: differences of lightness, chroma and hue, the hue the short way round.
  const double dl = two.l - one.l, dc = c2 - c1;
  double turn = grey ? 0 : h2 - h1;
  if (turn > pi) turn -= 2 * pi;
  if (turn < -pi) turn += 2 * pi;
  const double dh = 2 * std::sqrt(c1 * c2) * std::sin(turn / 2);

  // Step 3: weights at the middle of the two colours.
  const double l = (one.l + two.l) / 2, c = (c1 + c2) / 2;
  double h = h1 + h2;
  if (!grey) h = std::abs(h1 - h2) <= pi ? h / 2 : h < 2 * pi ? h / 2 + pi : h / 2 - pi;
  const double t = 1 - 0.17 * std::cos(h - radians(30)) + 0.24 * std::cos(2 * h) +
                   0.32 * std::cos(3 * h + radians(6)) - 0.20 * std::cos(4 * h - radians(63));
  const double blue = (degrees(h) - 275) / 25;
  const double turned = -2 * seventh_power_ratio(c) * std::sin(radians(60) * std::exp(-blue * blue));
  const double l50 = (l - 50) * (l - 50);
  const double wl = dl / (1 + 0.015 * l50 / std::sqrt(20 + l50));
  const double wc = dc / (1 + 0.045 * c), wh = dh / (1 + 0.015 * c * t);
  return std::sqrt(wl * wl + wc * wc + wh * wh + turned * wc * wh);
}

}  // namespace petzval
