// SPDX-License-Identifier: BSD-3-Clause
// Conversions between the units of the surface (degrees, nm, µm) and those of the inside (radians, mm).
#pragma once

#include <numbers>

namespace petzval {

inline constexpr double pi = std::numbers::pi;
inline constexpr double mm_per_um = 1e-3;
inline constexpr double mm_per_nm = 1e-6;
inline constexpr double um_per_mm = 1e3;
inline constexpr double mm_per_m = 1e3;

constexpr double radians(double degrees) {
  return degrees * (pi / 180.0);
}
constexpr double degrees(double radians) {
  return radians * (180.0 / pi);
}

}  // namespace petzval
