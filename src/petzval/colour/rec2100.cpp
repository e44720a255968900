// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/colour/display_primaries.h>
#include <petzval/colour/rec2100.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

// SMPTE ST 2084:2014.
constexpr double pq_m1 = 2610.0 / 16384, pq_m2 = 2523.0 / 32, pq_c1 = 3424.0 / 4096, pq_c2 = 2413.0 / 128,
                 pq_c3 = 2392.0 / 128, pq_peak_cd_m2 = 10000;
// ITU-R BT.2100-2, table 5.
constexpr double hlg_a = 0.17883277, hlg_b = 1 - 4 * hlg_a, hlg_peak_cd_m2 = 1000, hlg_gamma = 1.2;

}  // namespace

const ColourMatrix& xyz_from_rec2020() {
  static const ColourMatrix matrix = xyz_from_primaries({{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}});
  return matrix;
}

double pq_encoded(double luminance_cd_m2) {
  const double y = std::pow(std::clamp(luminance_cd_m2 / pq_peak_cd_m2, 0.0, 1.0), pq_m1);
  return std::pow((pq_c1 + pq_c2 * y) / (1 + pq_c3 * y), pq_m2);
}

double pq_decoded(double encoded) {
  const double root = std::pow(std::clamp(encoded, 0.0, 1.0), 1 / pq_m2);
  return pq_peak_cd_m2 * std::pow(std::max(0.0, root - pq_c1) / (pq_c2 - pq_c3 * root), 1 / pq_m1);
}

double hlg_decoded(double encoded) {
  const double code = std::clamp(encoded, 0.0, 1.0);
  const double hlg_c = 0.5 - hlg_a * std::log(4 * hlg_a);
  return code <= 0.5 ? code * code / 3 : (std::exp((code - hlg_c) / hlg_a) + hlg_b) / 12;
}

LinearRgb hlg_displayed(LinearRgb scene) {
  const double luminance = (xyz_from_rec2020() * Xyz{scene.r, scene.g, scene.b}).y;
  const double gain = hlg_peak_cd_m2 * std::pow(std::max(0.0, luminance), hlg_gamma - 1);
  return {gain * scene.r, gain * scene.g, gain * scene.b};
}

}  // namespace petzval
