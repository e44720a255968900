// SPDX-License-Identifier: BSD-3-Clause
// The light of a plane scene in a row of cells, several cells at a time.
#pragma once

#include <petzval/imaging/row_view.h>

#include <cstddef>

namespace petzval {

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
