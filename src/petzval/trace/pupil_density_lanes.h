// SPDX-License-Identifier: BSD-3-Clause
// How densely directions are drawn from exit pupil regions, for many at a time: lanes are rays.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace petzval {

/// Exit pupil regions as the lanes read them, one row a zone of film radius.
struct PupilDensityTable {
  static constexpr std::size_t sectors = 64;
  struct Row {
    float centre_v = 0, centre_v_per_mm = 0;  ///< at the zone's middle, and how it moves
    float per_scale_u = 0, per_scale_v = 0;
    float density_per_sr = 0;  ///< 0 for a zone without light
    std::array<float, sectors> radius_sq{};
  };
  std::vector<Row> rows;
  float zone_mm = 0;
};

/// `count` film points [mm] and direction cosines of the light there.
struct PupilDirections {
  const float *x_mm, *y_mm, *alpha, *beta;
  std::size_t count;
};

/// The density of each [1/sr] into per_sr[0 … count): as ExitPupilRegions::density_per_sr() in single
/// precision.
void pupil_densities(const PupilDensityTable& table, const PupilDirections& directions, float* per_sr);

}  // namespace petzval
