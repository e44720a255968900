// SPDX-License-Identifier: BSD-3-Clause
// Where the cells of a row look in a plane scene, several cells at a time.
#pragma once

#include <cstddef>
#include <vector>

namespace petzval {

/// ρ/r' and g_source at one step of r'², and per mm² from there to the next.
struct SceneMapStep {
  double samples_per_mm, g_source_sr, samples_slope = 0, g_source_slope = 0;
};

/// The lens's steps.
struct SceneMapSteps {
  const SceneMapStep* steps;
  double steps_per_square, last_height_squared;  ///< [mm⁻²], [mm²]
};

/// Centres of cells from left to right, as far to the left of the axis as to the right.
struct CellRow {
  double pitch_mm, y_mm;
  std::size_t count;
};

/// What the cells of a row see: the middles of rectangles, from the middle of the scene, their sides, and how
/// much of that light arrives.
struct RowView {
  std::vector<double> right, down;   ///< [samples]
  std::vector<float> width, height;  ///< [samples]
  std::vector<float> g_source_sr;
  std::size_t dark = 0;  ///< cells at either end that are not known, most of them without light

  /// SIMD (Highway), in double.
  void look(const SceneMapSteps& map, const CellRow& cells);
};

/// A camera that was tilted up, then turned to the right, before a plane.
struct PlaneTurn {
  double tangent_per_sample, cos_pan, sin_pan, cos_pitch, sin_pitch;
};

/// What cells see when the camera is turned, as many from the first on as vectors are filled with. Cells that
/// do not see the plane are dark. SIMD; scalar code with the same result to rounding is AimedPlane's.
/// \param turned  as large as `straight`. \return the first cell that is not done.
std::size_t turn_row(const PlaneTurn& turn, const RowView& straight, RowView& turned);

}  // namespace petzval
