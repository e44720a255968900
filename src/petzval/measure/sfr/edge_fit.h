// SPDX-License-Identifier: BSD-3-Clause
// Line and profile of one edge, fitted in turn.
#pragma once

#include <petzval/measure/sfr/edge_alignment.h>
#include <petzval/measure/sfr/edge_line.h>
#include <petzval/measure/sfr/edge_samples.h>
#include <petzval/measure/sfr/edge_spread_model.h>
#include <petzval/measure/sfr/measure_edge.h>

#include <functional>
#include <optional>
#include <vector>

namespace petzval {

/// Variance of the samples about a profile: near each level, and of all.
struct EdgeNoise {
  double dark = 0, bright = 0, all = 0;
};

/// \param unknowns  of the profile, that the data settle.
EdgeNoise noise_about(const EdgeProfile& profile, const EdgeSpreadModel& model, double unknowns);

/// From a guess to the line and the profile that fit the samples best. The line is bent, and the light
/// varies, where the samples show it.
class EdgeFit {
 public:
  /// Samples and guess outlive the fit.
  EdgeFit(const std::vector<EdgeSample>& samples, const EdgeGuess& guess, const SfrOptions& options);

  /// \throws InputError when no edge stands out, or it is too short.
  void run(const SfrOptions& options);

  /// The same profile by other splines, finer ones, which end nearer, and of samples about the middle of the
  /// edge alone, as far as they are close enough together: towards the ends corners change the profile. Where
  /// samples near corners have been left out, the profile with them, too.
  struct Variant {
    EdgeSpreadModel model;
    double share;             ///< of the samples
    double corners_left = 0;  ///< of what corners add to the profile of all samples, the part that these have
  };
  std::vector<Variant> variants() const;
  /// In proportion to what corners add to the profile; 0: none are known.
  double added_by_corners() const { return corners_.empty() ? 0 : added_by_corners(profile_.points); }
  double noise() const { return noise_; }
  /// Whether there is so little that finer splines fit as well.
  bool without_noise() const;

  const EdgeLine& line() const { return line_; }
  const EdgeProfile& profile() const { return profile_; }
  const EdgeSpreadModel& model() const { return *model_; }
  double unknowns() const { return unknowns_; }
  /// The distance of the rows in which the samples lie, as sample_comb_px() has it.
  double comb_px() const { return comb_px_; }
  double light_variation() const { return light_variation_; }

 private:
  bool quiet() const;
  void find_missing(const std::function<double(double, double)>& missing_target);
  void place_samples();
  void keep_clear_of_corners();
  bool close_enough(const std::vector<EdgePoint>& part, const std::vector<EdgePoint>& all) const;
  double clear_of_corners() const;
  double reach_of_blur_px() const;
  double added_by_corners(const std::vector<EdgePoint>& points) const;
  void expect_light();
  void fit_placed();
  void fit_profile();
  void leave_out_even_light();
  void take_profile();
  EdgeAlignment line_alignment() const;
  void bend_by_guess(const SfrOptions& options);
  void fit_to_shapes();
  void compare_with(const std::optional<EdgeShapes>& shapes);
  void settle();
  void move_to_rest();
  void settle_by_evidence(const SfrOptions& options);
  void settle_in_rows(const SfrOptions& options);
  void bend_by_evidence();
  void judge_light();
  bool light_varies(double least_share) const;

  const std::vector<EdgeSample>& samples_;
  const EdgeGuess& guess_;
  EdgeLine line_;
  EdgeProfile profile_;
  std::optional<EdgeSpreadModel> model_;
  std::vector<double> missing_, light_;  ///< of each sample
  double noise_, smoothing_ = 0, unknowns_ = 0, comb_px_ = 0, light_variation_ = 0;
  std::vector<ContourPoint> corners_;
  std::vector<Variant> near_corners_;
  double most_along_ = 1;  ///< samples farther along the edge are left out
  int light_order_ = 0;
  bool in_rows_ = false, coarse_ = false;
};

}  // namespace petzval
