// SPDX-License-Identifier: BSD-3-Clause
// The wave in an exit pupil as polynomials: a hundred times quicker to ask than rays that must be aimed.
#pragma once

#include <petzval/analysis/exit_pupil.h>
#include <petzval/wave/line_overlap.h>

#include <complex>
#include <optional>
#include <vector>

namespace petzval {

/// Amplitude and phase of an ExitPupil, least-squares polynomials through a quadrature's worth of its rays:
/// Chebyshev in β and in α², on the box about the pupil. Also for a sensor moved along the axis, which
/// changes the phase by what the rays travel and nothing else.
class ExitPupilFit {
 public:
  /// \param sensor_shift_mm  how far the sensor stands behind the lens's own image surface; the wave is then
  /// about the chief ray's new point. \returns nothing when no polynomial of degree 40 or less is as near as
  /// PupilDetail asks; then ExitPupil::wave is there.
  static std::optional<ExitPupilFit> of(const ExitPupil& pupil, const PupilModel& model,
                                        double sensor_shift_mm = 0);
  /// One a sensor; their rays are the same and traced once.
  static std::vector<std::optional<ExitPupilFit>> of(const ExitPupil& pupil, const PupilModel& model,
                                                     const std::vector<double>& sensor_shifts_mm);

  std::complex<double> wave(double alpha, double beta) const { return at_beta(beta)(alpha); }
  /// The wave along a line of one α, over β, and of one β, over α.
  WaveLine at_alpha(double alpha) const;
  WaveLine at_beta(double beta) const;
  /// As ExitPupil::transverse_mm, on the moved sensor.
  double transverse_mm() const { return transverse_mm_; }

 private:
  double transverse_mm_ = 0;
  ChebyshevSurface phase_;
  std::optional<ChebyshevSurface> amplitude_;  ///< absent: 1 everywhere
};

}  // namespace petzval
