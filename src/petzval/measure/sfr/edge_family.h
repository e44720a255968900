// SPDX-License-Identifier: BSD-3-Clause
// Edges as physics makes them, for noisy samples to lean on.
#pragma once

#include <Eigen/Core>

namespace petzval {

/// Diffraction, a square photosite and a Gaussian for all the rest: the modulation transfer function
/// 2/π (acos s − s √(1 − s²)) · sinc(f cos α) sinc(f sin α) · exp(−2π²vf²) with s = f λN.
struct EdgeShape {
  double log_airy = 0;  ///< of λN [pixels]
  double variance = 0;  ///< v [pixels²]; below 0 for pictures that are sharpened or sampled at points

  double airy_px() const;
};

/// The edge-spread functions about one of a shape, as unknowns of EdgeSpreadModel: coefficients of splines
/// `knot_px` apart about the middle, and of its tail. Each of the columns belongs to a step of 1.
struct EdgeFamily {
  enum Column { profile, offset, log_airy, variance, columns };
  Eigen::Matrix<double, Eigen::Dynamic, columns, Eigen::RowMajor> splines;
  Eigen::Matrix<double, 1, columns> tail1;

  /// \param normal_rad  direction of the edge's normal against the photosite's sides.
  EdgeFamily(const EdgeShape& shape, double normal_rad, double knot_px, int count);
};

}  // namespace petzval
