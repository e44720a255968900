// SPDX-License-Identifier: BSD-3-Clause
// What is expected of an edge-spread function before its samples are seen.
#pragma once

#include <petzval/measure/sfr/bordered_band.h>
#include <petzval/measure/sfr/edge_shapes.h>
#include <petzval/measure/sfr/edge_spread_basis.h>

#include <optional>
#include <vector>

namespace petzval {

/// What diffraction-limited and moderately aberrated pupils leave at a distance d, times d [pixels]: 0.0645
/// λN; with a spread as large again it covers f/2 to f/22 on pixels of 1 to 10 µm.
inline constexpr double usual_tail_px = 0.06;

struct EdgePriorOptions {
  double blur_px = 1;  ///< scale of the transition
  double noise = 0;    ///< standard deviation of the values, 0: not known yet
  /// The least weight of the roughness that is chosen over the most that edges can bear: more where samples
  /// leave gaps, for there the evidence is of what else the model lacks.
  double least_smoothing_share = 1e-6;
  /// What the profile is expected to look like; absent: smooth.
  std::optional<EdgeShapes> shapes;
};

/// A Gaussian density of the unknowns, in units of the noise, in two parts: one as it is, and the roughness
/// of the profile, whose weight the samples choose.
///
/// The first is weak. It keeps the tail sensible where noise hides it, and says how wide shapes may be and
/// how far beyond both they may lie.
///
/// The roughness is that of third differences of the splines' coefficients. With shapes it is not the
/// profile's roughness that costs, but that of its difference from the nearest of them, of any width (to
/// first order) and between both or a little beyond.
class EdgePrior {
 public:
  /// \param range  of the values of the samples. Options and basis outlive the prior.
  EdgePrior(const EdgePriorOptions& options, const EdgeSpreadBasis& basis, double range);

  void add_first_part(BorderedBand& normal) const;
  BorderedBand roughness() const;
  /// How many unknowns the roughness settles, and how many nothing does.
  int rank() const;
  int unsettled() const;
  /// Weights of the roughness among which the samples choose. They may not call a profile smoother than edges
  /// are. \param unit  of the weights.
  struct Weights {
    double least = 0, most = 0;
  };
  Weights weights(double unit) const;
  /// Least weight of the roughness, for samples without noise.
  static constexpr double least_weight = 1e-12;
  /// −2 log of the density of the shapes' unknowns, but for a constant and what they cost.
  double log_spread_of_shapes() const;

 private:
  double noise() const;
  /// A function that has an unknown of its own, by the splines' coefficients.
  struct RoughForm {
    int unknown;
    std::vector<double> coefficients;
  };
  std::vector<RoughForm> rough_forms() const;

  const EdgePriorOptions& options_;
  const EdgeSpreadBasis& basis_;
  double range_;
};

}  // namespace petzval
