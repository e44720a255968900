// SPDX-License-Identifier: BSD-3-Clause
// What every search for focus asks: how sharp it is with the film at a distance.
#pragma once

#include <petzval/focus/autofocus.h>

namespace petzval {

/// Asks for pictures and keeps the account.
class FocusJudge {
 public:
  /// The arguments must outlive this. \param scales  pictures are also judged binned by these. \throws
  /// InputError without a zone.
  FocusJudge(const PicturesAt& pictures_at, const std::vector<FocusZone>& zones,
             const FocusMeasureOptions& measure, std::vector<int> scales = {});

  /// The measure with the film at a distance, all zones together. \throws InputError if the pictures do not
  /// fit the zones or hold values that are not finite.
  double at(double film_distance_mm, const char* stage);

  /// The account as if the measure were that of pictures binned by scales[i].
  FocusResult seen_at(std::size_t i) const;

  int count() const { return static_cast<int>(result.evaluations.size()); }

  FocusResult result;

 private:
  double measure_of(const std::vector<ZonePicture>& pictures, int scale) const;
  double noise_of(const std::vector<ZonePicture>& pictures) const;

  const PicturesAt& pictures_at_;
  const std::vector<FocusZone>& zones_;
  const FocusMeasureOptions& measure_;
  std::vector<int> scales_;
  std::vector<std::vector<double>> binned_;  ///< [evaluation][scale]
};

/// \throws InputError unless 0 ≤ nearest < farthest < ∞.
void check_film_range(double nearest_mm, double farthest_mm);
/// \throws InputError if no picture had any contrast.
void require_contrast(const FocusResult& result);
/// What a search makes as small as possible: −log of the measure. No contrast at all is worse than any.
double focus_cost(double measure);

/// 2 − the golden ratio: where golden section places its next point.
inline constexpr double golden_share = 0.3819660112501051;

}  // namespace petzval
