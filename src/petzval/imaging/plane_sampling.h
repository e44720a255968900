// SPDX-License-Identifier: BSD-3-Clause
// Looking from a row of cells into a plane scene, several cells at a time.
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

/// Where the cells of a row look, from the middle of the scene [samples], and how much of that light arrives.
/// The row as far from the axis on its other side looks as far down as this one looks up.
struct RowView {
  std::vector<double> right, down;
  std::vector<float> g_source_sr;
  std::size_t dark = 0;  ///< cells at either end that are not known, most of them without light

  /// SIMD (Highway), in double.
  void look(const SceneMapSteps& map, const CellRow& cells);
};

/// A band of a scene.
struct PlaneView {
  const float* radiance;
  double columns, rows;
  double room;  ///< from an edge of the scene, where the neighbours of a place are sure to exist
};

/// Radiance × g_source, bilinear between sample centres, at the cells [from, …) of a row for as long as they
/// see the inside of the scene and light from the lens. SIMD: places in double, light in float; scalar code
/// with the same result to rounding is averaged() of distortion.cpp.
/// \param down  1, or −1 for the row on the other side of the axis.
/// \return the first cell that is not done.
std::size_t sample_row(const PlaneView& view, const RowView& cells, double down, std::size_t from,
                       float* irradiance);

/// Cells done at a time.
std::size_t sampled_at_once();

}  // namespace petzval
