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

/// What the cells of a row see: the middles of rectangles, from the middle of the scene, their sides, and how
/// much of that light arrives. The row as far from the axis on its other side sees as far down as this one
/// sees up.
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

/// A band of a scene.
struct PlaneView {
  const float* radiance;
  double columns, rows;
  bool dark_around;  ///< beyond the scene; else its nearest sample is seen there
};

/// How three neighbouring samples share in the mean over a stretch of the straight lines between them.
///
/// \param beyond  of the middle of the stretch, from the middle sample, −½ to ½. \param length  of the
/// stretch, more than 0 and at most 1 [samples].
struct LinearMean {
  double before, here, after;

  LinearMean(double beyond, double length) : before(side(-beyond, length)), after(side(beyond, length)) {
    here = 1 - before - after;
  }

 private:
  /// The mean of max(0, x) over [beyond − length/2, beyond + length/2].
  static double side(double beyond, double length) {
    const double high = beyond + length / 2, low = beyond - length / 2;
    const double to = high > 0 ? high : 0, from = low > 0 ? low : 0;
    return (to * to - from * from) / (2 * length);
  }
};

/// Mean radiance × g_source of the cells [from, to) of a row for as long as they see no more than a sample of
/// the scene along either side, and light from the lens. Between sample centres radiance is bilinear, and the
/// mean is exact, so that the light of a sample is the same wherever it falls on the cells. SIMD: places in
/// double, light in float; scalar code with the same result to rounding is SceneRows's.
/// \return the first cell that is not done.
std::size_t sample_row(const PlaneView& view, const RowView& cells, std::size_t from, std::size_t to,
                       float* irradiance);

/// The first of the cells [from, to) of a row that does not see the inside of the scene wholly, or that is
/// not known; `to` if there is none. SIMD.
std::size_t first_outside(const PlaneView& view, const RowView& cells, std::size_t from, std::size_t to);

/// Cells done at a time.
std::size_t sampled_at_once();

}  // namespace petzval
