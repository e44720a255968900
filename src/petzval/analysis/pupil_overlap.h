// SPDX-License-Identifier: BSD-3-Clause
// The overlap of a pupil with itself: the transfer function of what passes it.
#pragma once

#include <petzval/analysis/exit_pupil.h>
#include <petzval/analysis/exit_pupil_fit.h>
#include <petzval/numeric/quadrature.h>

#include <array>
#include <complex>
#include <functional>
#include <optional>

namespace petzval {

/// Along which direction on the sensor the pattern varies: tangential, along y (away from the axis: lines at
/// right angles to the field), or sagittal, along x.
enum class MtfDirection { tangential, sagittal };

/// ∫ P(p) P*(p − s e) along one chord of the overlap, which runs along e: β (tangential) at α = across, or α
/// (sagittal) at β = across, over [low, low + length].
struct ChordOverlap {
  double across = 0, low = 0, length = 0, shift = 0;
};
using OverlapAlong =
    std::function<std::complex<double>(MtfDirection, const ChordOverlap&, const QuadratureRule& along)>;

/// One pupil's optical transfer function, asked frequency by frequency; see diffraction_otf(). What all
/// frequencies share is worked out once. The tracer, the pupil and the fit must outlive it.
class PupilOverlap {
 public:
  PupilOverlap(const FieldTracer& tracer, const ExitPupil& pupil, const ExitPupilFit& fit);
  /// By aimed rays.
  PupilOverlap(const FieldTracer& tracer, const ExitPupil& pupil, const PupilModel& model);

  std::complex<double> otf(MtfDirection direction, double frequency_cpmm);

 private:
  using Wave = std::function<std::complex<double>(double alpha, double beta)>;
  PupilOverlap(const FieldTracer& tracer, const ExitPupil& pupil, double transverse_mm, const Wave& wave,
               OverlapAlong along);
  std::complex<double> unscaled(MtfDirection direction, double shift, int nodes) const;
  std::complex<double> round_tangential(double shift, int nodes) const;
  std::complex<double> round_sagittal(double shift, int nodes) const;

  const ExitPupil& pupil_;
  double lambda_mm_, transverse_mm_;
  int most_nodes_;
  OverlapAlong along_;
  bool dark_inside_ = false;
  double widest_beta_ = 0, width_ = 0;  ///< where a round pupil is widest in α
  std::array<std::optional<double>, 2> whole_ = {};
};

}  // namespace petzval
