// SPDX-License-Identifier: BSD-3-Clause
// What profiles of edges look like before anything is known but how wide they are.
#pragma once

#include <array>

namespace petzval {

/// Edge-spread functions of equal MTF50, of a photosite that light reaches by several PSFs: a Gaussian, that
/// of a circular pupil, the same with half a wave of defocus, with half a wave of spherical aberration, and a
/// Gaussian with a quarter of its light in a halo four times as wide. Real ones lie about and between them.
class EdgeShapes {
 public:
  static constexpr int kinds = 5;
  /// The mean of the first two, what it changes by where both are wider by a share, per share, the difference
  /// of these two, and those of the others from their mean.
  static constexpr int count = kinds + 1;

  /// \param mtf50_cpp  of all. \param normal_rad  direction of the edge's normal: a photosite fills its
  /// pixel. \throws InputError where a photosite alone has less contrast; possible() tells.
  EdgeShapes(double mtf50_cpp, double normal_rad);
  static bool possible(double mtf50_cpp, double normal_rad);

  /// At a distance from the edge, from 0 (dark) to 1.
  std::array<double, count> operator()(double distance_px) const;

 private:
  static constexpr int places = 24;
  std::array<double, places> place_{}, weight_{};  ///< of the photosite along the normal [px]
  std::array<double, kinds> scale_cpp_{};          ///< frequency of each that ScaledEdge counts as 1
};

}  // namespace petzval
