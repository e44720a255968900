// SPDX-License-Identifier: BSD-3-Clause
// What profiles of edges look like before anything is known but how wide they are.
#pragma once

#include <array>

namespace petzval {

/// Two edge-spread functions of equal MTF50, of a photosite that light reaches by a Gaussian and by the PSF
/// of a circular pupil: real ones lie about and between them.
class EdgeShapes {
 public:
  /// The mean of both, what it changes by where both are wider by a share, per share, and their difference.
  static constexpr int count = 3;

  /// \param mtf50_cpp  of both. \param normal_rad  direction of the edge's normal: a photosite fills its
  /// pixel. \throws InputError where a photosite alone has less contrast; possible() tells.
  EdgeShapes(double mtf50_cpp, double normal_rad);
  static bool possible(double mtf50_cpp, double normal_rad);

  /// At a distance from the edge, from 0 (dark) to 1.
  std::array<double, count> operator()(double distance_px) const;

 private:
  static constexpr int places = 24;
  std::array<double, places> place_{}, weight_{};  ///< of the photosite along the normal [px]
  double sigma_px_ = 0, cutoff_cpp_ = 0;
};

}  // namespace petzval
