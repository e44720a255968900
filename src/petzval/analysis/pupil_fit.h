// SPDX-License-Identifier: BSD-3-Clause
// The vignetted pupil of a field as smooth functions of the exit direction.
#pragma once

#include <petzval/analysis/field_tracer.h>
#include <petzval/wave/smooth_pupil.h>

#include <optional>

namespace petzval {

/// How well a pupil must be met by its polynomials to be used.
struct PupilFitLimits {
  int lowest_degree = 12, highest_degree = 20;          ///< in steps of 4, until both residuals are met
  double phase_rms_waves = 1e-5, amplitude_rms = 1e-4;  ///< the latter relative to the largest
  /// What the best of them may leave at most: 1e-3 of the PSF's peak.
  double largest_phase_rms_waves = 2e-4, largest_amplitude_rms = 3e-3;
  int outline_azimuths = 128, radial_nodes = 10;  ///< of the rays: a few hundred
  /// Corners where two apertures meet are found to this in azimuth [rad] and radius (relative).
  double corner_tolerance = 1e-8;

  /// For light that is added up over cells far wider than λN: 0.01 rad of phase, at a third of the cost.
  static PupilFitLimits coarse() { return {8, 20, 2e-3, 2e-3, 5e-3, 1e-2, 64, 8, 1e-5}; }
};

/// A few hundred real rays inside the boundary and on it, and polynomials through their phase and amplitude.
/// \returns nothing when no ray passes, or when the pupil is not that smooth: blades, rays that fail inside
/// the boundary, an outline that is no function of β, or residuals beyond the limits. Its nodes must be
/// traced then.
std::optional<SmoothPupil> fit_pupil(const FieldTracer& tracer, const ChiefRay& chief,
                                     const PupilFitLimits& limits = {});

/// The same with where its rays enter.
struct FittedPupil {
  SmoothPupil pupil;
  PupilBoundary boundary;
};
std::optional<FittedPupil> fit_pupil_and_boundary(const FieldTracer& tracer, const ChiefRay& chief,
                                                  const PupilFitLimits& limits = {});

}  // namespace petzval
