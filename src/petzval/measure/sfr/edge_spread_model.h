// SPDX-License-Identifier: BSD-3-Clause
// The edge-spread function as a sum of functions whose transforms are known.
#pragma once

#include <petzval/measure/sfr/bordered_band.h>
#include <petzval/measure/sfr/edge_prior.h>
#include <petzval/measure/sfr/edge_rows.h>
#include <petzval/measure/sfr/edge_spread_basis.h>
#include <petzval/measure/sfr/quantisation_noise.h>

#include <Eigen/Core>
#include <array>
#include <complex>
#include <span>
#include <utility>
#include <vector>

namespace petzval {

struct EdgeSpreadOptions {
  double core_px = 10;    ///< splines reach as far as this from the edge; beyond it there is only the tail
  double knot_px = 0.25;  ///< spacing of the splines
  /// The light on the target may vary along the edge and across it: 0 not, 1 linearly, 2 as a parabola.
  int light_order = 0;
  /// Weight of the roughness of the profile against the data; negative: chosen by the evidence.
  double smoothing = -1;
  EdgePriorOptions prior;
};

/// E(d) = dark + step · (½ + atan(d/b)/π) − tail1 d/(d² + b²) − tail3 d/(d² + b²)² + Σ c_j B_j(d), b = 1
/// pixel, B_j quintic B-splines within ±core. Far away it is dark or dark + step ∓ A/|d|: the tail that
/// diffraction gives an edge. All of it is linear in the unknowns and is fitted to the samples as they lie,
/// without bins, so there is no bin and no derivative to correct for, and the transform of E′ is known in
/// closed form. A weak prior keeps the tail sensible where noise hides it.
///
/// The roughness of the prior costs as much as the restricted likelihood of the samples finds best (G. Wahba,
/// Ann. Statist. 13, 1378, 1985): with noise the profile is as smooth as it shows itself to be, without noise
/// it is free but for 1e-10 of the weight of the data, which joins the splines where samples leave gaps.
///
/// Where the target is not a half-plane, half the tail A times what is missing of it is added: the PSF falls
/// as K₃/r³, and K₃ is half of what the edge keeps.
///
/// With light that varies, l (p₁ t + p₂ d), and to order 2 l (p₃ t² + p₄ t d + p₅ d²), is fitted besides, for
/// a sample at t along the edge whose value is expected to be l of the bright side's: uneven light and
/// vignetting take the same share of both sides. It belongs to no transform.
class EdgeSpreadModel {
 public:
  /// \param memory  of a model that is needed no more. \throws InputError when the points do not determine
  /// the model.
  EdgeSpreadModel(std::span<const EdgePoint> points, const EdgeSpreadOptions& options, EdgeRows memory = {});
  /// The same, of the same points, with light of a lower order and the same smoothing.
  void take_light_to_order(int order, std::span<const EdgePoint> points);
  /// The same, of the same points, with another prior, whose weight the evidence chooses.
  void take_prior(const EdgePriorOptions& prior, std::span<const EdgePoint> points);

  /// The profile at a distance, in the middle of the edge and without what varies.
  double value(double distance) const { return evaluate(distance).value; }
  double slope(double distance) const { return evaluate(distance).slope; }
  struct ValueAndSlope {
    double value = 0, slope = 0;
  };
  ValueAndSlope evaluate(double distance) const;
  /// At each of the points, which are those that the model was made from: the profile and its slope, and what
  /// light that varies, and a target that is no half-plane, add there.
  void evaluate_points(std::span<const EdgePoint> points, std::vector<ValueAndSlope>& fitted,
                       std::vector<double>& variations) const;
  /// Of the terms of the highest order of light that varies: the largest share of the step that they make
  /// within `reach_px` of the edge, and how many standard deviations they are.
  double variation_over(double reach_px) const;
  double variation_significance(double noise) const;

  /// The memory for one of other points; nothing else may be asked afterwards.
  EdgeRows release() { return std::move(rows_); }

  double dark() const { return dark_; }
  double step() const { return step_; }
  /// A/step: what the edge still misses at a distance d is this over d [pixels].
  double tail_px() const;
  double core_px() const { return basis_.core_px(); }
  const EdgeSpreadOptions& options() const { return options_; }
  /// ∫ E′(d) exp(−2πifd) dd / step.
  std::complex<double> transform(double frequency_cpp) const;
  std::vector<std::complex<double>> transforms(std::span<const double> frequencies_cpp) const;
  /// Unknowns that the data settle: the trace of the matrix that makes fitted values of samples.
  double unknowns() const;
  /// All of them.
  double most_unknowns() const { return static_cast<double>(coefficients_.size()); }
  double smoothing() const { return options_.smoothing; }
  /// Standard deviation of the values as the restricted likelihood has it.
  double likely_noise() const { return noise_; }
  /// −2 log of the restricted likelihood, but for what it has in common with that of other models of the same
  /// points, knots and noise.
  double criterion() const { return criterion_; }

  /// What the profile can take of other functions of the points, so that these and it can be fitted together
  /// (variable projection: G. H. Golub & V. Pereyra, SIAM J. Numer. Anal. 10, 413, 1973): sums over the
  /// points that the model was made from of the products of what it takes. \param values  of the functions at
  /// each point, one after the other. `functions` is 2, 4 or BorderedBand::lanes.
  template <int functions>
  Eigen::Matrix<double, functions, functions> taken_of(std::span<const double> values) const;

  /// Standard deviations of |transform|: of noise of the given variances at the points, of their rounding,
  /// and of what smoothing may have taken away (the spread of the posterior, which holds on average for
  /// profiles as rough as this one). `variance[i]` belongs to the i-th point that the model was made from.
  class Deviation {
   public:
    /// \param changes  of the values that may have happened besides, each as likely: BorderedBand::lanes for
    /// each point, one after the other; empty: none.
    Deviation(const EdgeSpreadModel& model, std::span<const double> variance,
              const QuantisationNoise& rounding, std::span<const double> changes = {});
    /// \param transforms  of the model, at the frequencies.
    std::vector<double> of_moduli(std::span<const double> frequencies_cpp,
                                  std::span<const std::complex<double>> transforms) const;
    /// How what noise does to |transform| at three frequencies hangs together: correlations of the first and
    /// second, first and third, second and third.
    std::array<double, 3> correlations(const std::array<double, 3>& frequencies_cpp) const;

   private:
    /// xᵀ (spread + rounding) x of each vector.
    std::array<double, BorderedBand::lanes> variances(const BorderedBand::Block& x) const;
    /// d|transform|/d(unknowns) at up to eight frequencies.
    BorderedBand::Block gradients_of_moduli(std::span<const double> frequencies_cpp,
                                            std::span<const std::complex<double>> transforms) const;

    const EdgeSpreadModel& model_;
    BorderedBand spread_;       ///< covariance of the right side of the normal equations
    Eigen::MatrixXd rounding_;  ///< and what rounding adds: lower half and half the diagonal; empty without
    BorderedBand::Block changes_;  ///< of the right side; empty without
  };

 private:
  static constexpr int closed_forms = EdgeSpreadBasis::closed_forms, support = EdgeSpreadBasis::support,
                       margin = EdgeRows::margin;
  /// Right sides of the normal equations, of other values of the points: so many for each, one after the
  /// other.
  template <int functions>
  BorderedBand::Columns<functions> right_sides(std::span<const double> values) const;
  /// Normal equations of the unknowns, of these sums over the points.
  BorderedBand normal_of(const EdgeRows::Products& sums) const;
  void fit(std::span<const EdgePoint> points);

  EdgeSpreadOptions options_;
  EdgeSpreadBasis basis_;
  double dark_ = 0, step_ = 1, noise_ = 0, criterion_ = 0;
  Eigen::VectorXd coefficients_;
  EdgeRows rows_;             ///< of the points
  EdgeRows::Products sums_;   ///< over them
  BorderedBand data_normal_;  ///< of the unknowns
  Eigen::VectorXd right_;     ///< side of the normal equations
  BorderedBand priors_;       ///< of the priors and the roughness
  BorderedCholesky factor_;   ///< of the whole normal matrix
};

}  // namespace petzval
