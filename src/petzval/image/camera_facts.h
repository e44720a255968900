// SPDX-License-Identifier: BSD-3-Clause
// What a camera notes in its files beside the picture.
#pragma once

#include <petzval/base/date_time.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// Gains at points that lie evenly over a frame from edge to edge, row by row, and bilinear in between.
struct GainMap {
  int columns = 0, rows = 0;  ///< 0: none; else 2 or more
  std::vector<float> gains = {};
  bool operator==(const GainMap&) const = default;
};

/// The lens that light came through, as far as a camera notes it in its files.
struct LensFacts {
  std::string name = {};
  double focal_length_mm = 0, f_number = 0;  ///< the working f-number; 0: not known
  double exit_pupil_mm = 0;  ///< from the sensor, negative in front of it; 0: not known, or at infinity
  /// What undoes distortion and fall-off over this frame, r = 1 in its corners: a point at r of a straight
  /// picture is found at r·(w₀ + w₁r² + w₂r⁴ + w₃r⁶), and its light × (1 + v₀r² + … + v₄r¹⁰) is even (DNG's
  /// WarpRectilinear and FixVignetteRadial). Empty: not known.
  std::vector<double> warp = {}, vignetting = {};
  /// In place of `warp` where that cannot follow: found at w₀θ + w₁θ³ + w₂θ⁵ + w₃θ⁷, θ = arctan r
  /// (WarpFisheye).
  std::vector<double> fisheye_warp = {};
  GainMap gain_map = {};  ///< in place of `vignetting`, which a lens without symmetry has not (GainMap)
};

/// 0 and empty: not known.
struct CameraFacts {
  double exposure_s = 0, iso = 0;
  double pitch_um = 0;
  LensFacts lens = {};
  std::string camera = {};
  std::optional<DateTime> date_time = {};  ///< when the exposure began; never that of the computer's clock
};

}  // namespace petzval
