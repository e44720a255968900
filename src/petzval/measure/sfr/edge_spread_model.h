// SPDX-License-Identifier: BSD-3-Clause
// The edge-spread function as a sum of functions whose transforms are known.
#pragma once

#include <petzval/measure/sfr/quantisation_noise.h>

#include <complex>
#include <span>
#include <vector>

namespace petzval {

/// What diffraction-limited and moderately aberrated pupils leave at a distance d, times d [pixels]: 0.0645
/// λN; with a spread as large again it covers f/2 to f/22 on pixels of 1 to 10 µm.
inline constexpr double usual_tail_px = 0.06;

/// A sample by its distance from the edge.
struct EdgePoint {
  double distance = 0, value = 0;
};

struct EdgeSpreadOptions {
  double core_px = 10;    ///< splines reach as far as this from the edge; beyond it there is only the tail
  double knot_px = 0.25;  ///< spacing of the splines
  double blur_px = 1;     ///< scale of the transition, for the prior of the tail's second term
  double noise = 0;       ///< standard deviation of the values, 0: not known yet
};

/// E(d) = dark + step · (½ + atan(d/b)/π) − tail1 d/(d² + b²) − tail3 d/(d² + b²)² + Σ c_j B_j(d), b = 1
/// pixel, B_j quintic B-splines within ±core. Far away it is dark or dark + step ∓ A/|d|: the tail that
/// diffraction gives an edge. All of it is linear in the unknowns and is fitted to the samples as they lie,
/// without bins, so there is no bin and no derivative to correct for, and the transform of E′ is known in
/// closed form. A weak prior keeps the tail sensible where noise hides it; where samples leave gaps (edges
/// along the pixel grid) a penalty on the third derivative, 1e-12 of the weight of the data, joins the
/// splines smoothly.
class EdgeSpreadModel {
 public:
  /// \throws InputError when the points do not determine the model.
  EdgeSpreadModel(std::span<const EdgePoint> points, const EdgeSpreadOptions& options);

  double value(double distance) const;
  double slope(double distance) const;
  double dark() const { return dark_; }
  double step() const { return step_; }
  /// A/step: what the edge still misses at a distance d is this over d [pixels].
  double tail_px() const;
  /// ∫ E′(d) exp(−2πifd) dd / step.
  std::complex<double> transform(double frequency_cpp) const;
  /// Standard deviation of |transform| that noise of the given variances at the points and their rounding
  /// would make. `variance[i]` belongs to the i-th point that the model was made from.
  std::vector<double> modulus_deviation(std::span<const double> frequencies_cpp,
                                        std::span<const EdgePoint> points, std::span<const double> variance,
                                        const QuantisationNoise& rounding) const;
  /// Number of unknowns that the data settle.
  std::size_t unknowns() const { return coefficients_.size(); }

 private:
  static constexpr int fixed = 4;  ///< dark, step, tail1, tail3; the splines follow
  static constexpr int support = 6;
  int spline_values(double distance, double* values) const;  ///< the first, −support outside
  void fixed_values(double distance, double* values) const;
  /// d transform·step / d unknown.
  std::vector<std::complex<double>> transform_row(double frequency_cpp) const;

  EdgeSpreadOptions options_;
  int splines_ = 0;
  double dark_ = 0, step_ = 1;
  std::vector<double> coefficients_;
  std::vector<double> factor_;  ///< lower Cholesky factor of the normal matrix, column-major
};

}  // namespace petzval
