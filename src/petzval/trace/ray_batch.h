// SPDX-License-Identifier: BSD-3-Clause
// Rays in structure-of-arrays form.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace petzval {

enum class RayStatus : std::uint8_t { ok, missed, vignetted, tir };

/// "ok", "missed", "vignetted", "tir".
const char* to_string(RayStatus status);

/// Rays of one wavelength in lens space: a point, a unit direction, and the optical path travelled so far
/// [mm].
struct RayBatch {
  std::vector<double> x_mm, y_mm, z_mm;
  std::vector<double> l, m, n;  ///< direction cosines
  std::vector<double> opl_mm;
  std::vector<RayStatus> status;
  std::vector<std::int16_t> failed_at;  ///< the surface where it failed, −1 while ok

  RayBatch() = default;
  explicit RayBatch(std::size_t count) { resize(count); }
  std::size_t size() const { return x_mm.size(); }
  void resize(std::size_t count);
  void push_back(double x, double y, double z, double dir_l, double dir_m, double dir_n, double path_mm = 0);
};

}  // namespace petzval
