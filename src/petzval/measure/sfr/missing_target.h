// SPDX-License-Identifier: BSD-3-Clause
// What the rest of a target adds to one of its edges.
#pragma once

#include <petzval/measure/sfr/find_edges.h>
#include <petzval/measure/sfr/flux_lanes.h>
#include <petzval/measure/sfr/smooth_about_edge.h>

#include <optional>
#include <vector>

namespace petzval {

/// At (x, y): ∬ r⁻³ dA over what is bright beyond the edge's half-plane, minus that over what is missing from
/// it [1/pixel], as far as its outline lies within 200 pixels of the edge; see SfrOptions::missing_target.
class MissingTarget {
 public:
  /// For places anywhere.
  static MissingTarget everywhere(const FoundEdge& edge) { return {edge, false}; }
  /// For the places of samples_about(): what is far away is interpolated.
  static MissingTarget where_sampled(const FoundEdge& edge) { return {edge, true}; }
  double operator()(double x, double y) const;

 private:
  MissingTarget(const FoundEdge& edge, bool sampled);
  FluxSides near_;
  std::optional<SmoothAboutEdge> far_;  ///< sides far enough to change little over the samples
};

}  // namespace petzval
