// SPDX-License-Identifier: BSD-3-Clause
// The pupil of a field as seen from its image point: its outline in exit direction cosines, and the ray in
// any direction inside.
#pragma once

#include <petzval/analysis/field_tracer.h>

#include <algorithm>
#include <complex>
#include <optional>
#include <vector>

namespace petzval {

/// What the pupil's amplitude and phase stand for.
struct PupilModel {
  enum class Amplitude {
    uniform,  ///< 1 over the exit direction cosines
    light     ///< a² = dq/(dα dβ), as bright as the rays are: what Psf has
  };
  enum class Phase {
    reference_sphere,  ///< −W of WavefrontRow
    plane_waves        ///< to the foot of the perpendicular, exact on a flat sensor: what Psf has
  };
  Amplitude amplitude = Amplitude::uniform;
  Phase phase = Phase::reference_sphere;
};

/// The light that converges on the chief ray's image point, as a function of the exit direction cosines (α,
/// β). Mirror symmetric in α.
class ExitPupil {
 public:
  struct Chord {
    double low = 0, high = 0;
    double length() const { return high - low; }
  };

  /// Nothing where no ray passes.
  static std::optional<ExitPupil> of(const FieldTracer& tracer, const ChiefRay& chief);

  double alpha_max() const { return alpha_max_; }
  const Chord& beta_range() const { return beta_range_; }
  double widest() const { return std::max(2 * alpha_max_, beta_range_.length()); }
  /// The largest distance of a ray on the image surface from the chief ray [mm].
  double transverse_mm() const { return transverse_mm_; }

  /// The range of β at this α ≥ 0, and of α at this β; of length zero outside the pupil.
  Chord along_beta(double alpha) const;
  Chord along_alpha(double beta) const;

  /// Amplitude and phase in a direction, a exp(2πi φ). Aimed with real rays; zero where none goes that way.
  std::complex<double> wave(double alpha, double beta, const PupilModel& model) const;

 private:
  ExitPupil(const FieldTracer& tracer, const ChiefRay& chief);
  struct Probe {
    double alpha, beta, phase_waves, x_mm, y_mm;
  };
  std::optional<Probe> probe(double u, double v) const;
  bool find_outline(const PupilBoundary& pupil);

  const FieldTracer* tracer_;
  ChiefRay chief_;
  Pencil pencil_;
  double nudge_ = 0;
  double u_per_alpha_ = 0, v_per_beta_ = 0, middle_v_ = 0, middle_beta_ = 0;  ///< first guess
  std::vector<double> outline_alpha_, outline_beta_;  ///< half of it, α ≥ 0, closed on the axis
  double alpha_max_ = 0, transverse_mm_ = 0, sphere_radius_mm_ = 0;
  Chord beta_range_;
};

}  // namespace petzval
