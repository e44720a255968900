// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/display_primaries.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

Eigen::Matrix3d eigen(const ColourMatrix& m) {
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) result(i, j) = m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return result;
}

ColourMatrix plain(const Eigen::Matrix3d& m) {
  ColourMatrix result;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) result[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = m(i, j);
  return result;
}

Eigen::Vector3d eigen(Xyz c) {
  return {c.x, c.y, c.z};
}

double clipped(double value) {
  return value > 0 ? std::min(value, 1.0) : 0.0;
}

}  // namespace

ColourMatrix operator*(const ColourMatrix& a, const ColourMatrix& b) {
  return plain(eigen(a) * eigen(b));
}

ColourMatrix inverse(const ColourMatrix& matrix) {
  return plain(eigen(matrix).inverse());
}

Xyz operator*(const ColourMatrix& m, Xyz c) {
  return {m[0][0] * c.x + m[0][1] * c.y + m[0][2] * c.z, m[1][0] * c.x + m[1][1] * c.y + m[1][2] * c.z,
          m[2][0] * c.x + m[2][1] * c.y + m[2][2] * c.z};
}

Xyz display_white() {
  return xyz_of(Chromaticity{0.3127, 0.3290});
}

ColourMatrix xyz_from_primaries(const std::array<Chromaticity, 3>& primaries) {
  // Columns: the primaries, scaled so that together they are white.
  Eigen::Matrix3d xyz;
  for (int i = 0; i < 3; ++i) xyz.col(i) = eigen(xyz_of(primaries[static_cast<std::size_t>(i)]));
  const Eigen::Vector3d levels = xyz.inverse() * eigen(display_white());
  return plain(xyz * levels.asDiagonal());
}

const ColourMatrix& xyz_from_srgb() {
  static const ColourMatrix matrix = xyz_from_primaries({{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}});
  return matrix;
}

const ColourMatrix& srgb_from_xyz() {
  static const ColourMatrix matrix = inverse(xyz_from_srgb());
  return matrix;
}

LinearRgb linear_srgb(Xyz colour) {
  const Xyz rgb = srgb_from_xyz() * colour;
  return {rgb.x, rgb.y, rgb.z};
}

Xyz xyz_of(LinearRgb colour) {
  return xyz_from_srgb() * Xyz{colour.r, colour.g, colour.b};
}

ColourMatrix bradford_adaptation(Xyz from, Xyz to) {
  Eigen::Matrix3d cones_from_xyz;
  cones_from_xyz << 0.8951, 0.2664, -0.1614,  //
      -0.7502, 1.7135, 0.0367,                //
      0.0389, -0.0685, 1.0296;
  const Eigen::Vector3d cones_from = cones_from_xyz * eigen(from), cones_to = cones_from_xyz * eigen(to);
  if (!(cones_from.minCoeff() > 0 && cones_to.minCoeff() > 0))
    throw InputError(
        fmt::format("a light of XYZ {:.4g} {:.4g} {:.4g} cannot serve as white: it leaves one kind of cone "
                    "in the dark; give a broad-band white",
                    from.x, from.y, from.z));
  const Eigen::Vector3d gains = cones_to.cwiseQuotient(cones_from);
  return plain(cones_from_xyz.inverse() * gains.asDiagonal() * cones_from_xyz);
}

double srgb_encoded(double linear) {
  const double magnitude = std::abs(linear);
  const double encoded =
      magnitude <= 0.0031308 ? 12.92 * magnitude : 1.055 * std::pow(magnitude, 1 / 2.4) - 0.055;
  return std::copysign(encoded, linear);
}

double srgb_decoded(double encoded) {
  const double magnitude = std::abs(encoded);
  const double linear = magnitude <= 0.04045 ? magnitude / 12.92 : std::pow((magnitude + 0.055) / 1.055, 2.4);
  return std::copysign(linear, encoded);
}

std::uint8_t quantised_8(double value) {
  return static_cast<std::uint8_t>(std::lround(255.0 * clipped(value)));
}

std::uint16_t quantised_16(double value) {
  return static_cast<std::uint16_t>(std::lround(65535.0 * clipped(value)));
}

}  // namespace petzval
