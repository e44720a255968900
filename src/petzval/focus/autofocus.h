// SPDX-License-Identifier: BSD-3-Clause
// Finding the film distance at which a picture is sharpest.
#pragma once

#include <petzval/focus/focus_measure.h>
#include <petzval/focus/zones.h>

#include <functional>
#include <string>
#include <vector>

namespace petzval {

/// Pictures of all zones, in their order, with the film at a distance. Whoever forms them: a renderer, image
/// formation, a camera.
using PicturesAt = std::function<std::vector<ZonePicture>(double film_distance_mm)>;

struct FocusEvaluation {
  double film_distance_mm = 0, measure = 0;
  double noise = 0;   ///< standard deviation of the measure, as far as two pictures of a zone tell
  std::string stage;  ///< "coarse", "close", "settle", "golden", "scan"
};

struct FocusResult {
  double film_distance_mm = 0;
  double measure = 0;       ///< the largest that was found
  bool at_the_end = false;  ///< the sharpest place lies at an end of the range: it may lie beyond
  std::vector<FocusEvaluation> evaluations;  ///< in the order in which they were made

  /// Noise of the measure against its peak, a root mean square over all evaluations. A share ε leaves the
  /// peak uncertain by about 2.3 ε depths of focus: the parabola through places two depths apart, about a
  /// peak that three depths halve.
  double noise_share() const;
};

struct FocusSearchOptions {
  FocusMeasureOptions measure;
  double nearest_mm = 0, farthest_mm = 0;  ///< range of film distances
  /// Depth of focus: how far the film moves until a point is blurred over a pixel, f-number × pixel. The
  /// scale in which sharpness changes; 0: a hundredth of the range.
  double depth_mm = 0;
  int coarse = 5;  ///< evaluations that find the bracket, evenly over the range; ≥ 3
  int most_evaluations = 12;
};

/// Evaluations evenly over the range find the neighbourhood of the peak (several distant peaks of a noisy
/// measure do not mislead them as they mislead a search that trusts its first bracket). From there on each
/// next place is the peak of the curve that fits all evaluations best: geometry blurs by a disc whose width
/// grows with the distance x − x0 from the sharp place, so that the measure is nearly A·((x − x0)² +
/// w²)^(−p), far off a cusp, near by a parabola. Where no such curve fits, Brent's method without derivatives
/// (Algorithms for Minimization, 1973, ch. 5) on the logarithm of the measure takes the step. When places
/// within some depths of focus lie on both sides, the polynomial through them says where the peak is. Its
/// places lie two depths apart, so that noise of the measure matters little. Zones count by their area.
/// \throws InputError for a range or options that make no sense, or when no picture has any contrast.
FocusResult find_focus(const PicturesAt& pictures_at, const std::vector<FocusZone>& zones,
                       const FocusSearchOptions& options);

}  // namespace petzval
