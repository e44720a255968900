// SPDX-License-Identifier: BSD-3-Clause
// Looking from a row of cells into a plane scene, several cells at a time.
#pragma once

#include <cstddef>

namespace petzval {

/// ρ/r' and g_source at one step of r'², and per mm² from there to the next.
struct SceneMapStep {
  double samples_per_mm, g_source_sr, samples_slope = 0, g_source_slope = 0;
};

/// What looking into a plane takes: the lens's steps and a band of the scene.
struct PlaneView {
  const SceneMapStep* steps;
  double steps_per_square, last_height_squared;  ///< [mm⁻²], [mm²]
  const float* radiance;
  double columns, rows;  ///< of the scene
  double room;           ///< from an edge of the scene, where the neighbours of a place are sure to exist
};

/// Centres of cells, from left to right.
struct CellRow {
  double first_x_mm, pitch_mm, y_mm;
  std::size_t count;
};

/// Radiance × g_source, bilinear between sample centres, at the cells [from, …) for as long as cells see the
/// inside of the scene and light from the lens. SIMD (Highway), in double; scalar code with the same result
/// to rounding is averaged() of distortion.cpp.
/// \return the first cell that is not done.
std::size_t sample_row(const PlaneView& view, const CellRow& cells, std::size_t from, float* irradiance);

/// Cells done at a time.
std::size_t sampled_at_once();

}  // namespace petzval
