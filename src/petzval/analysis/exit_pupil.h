// SPDX-License-Identifier: BSD-3-Clause
// The pupil of a field as seen from its image point: its outline in exit direction cosines, and the ray in
// any direction inside.
#pragma once

#include <petzval/analysis/field_tracer.h>

#include <algorithm>
#include <array>
#include <complex>
#include <optional>
#include <span>
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

/// How finely a pupil is looked at.
struct PupilDetail {
  /// Corners of the outline: a polygon of n is too small by a share of (2π/n)²/6, 2.5e-5 for 512.
  int outline_azimuths = 512;
  int sample_radii = 24;    ///< of samples(), at every fourth azimuth of the outline
  int overlap_panels = 48;  ///< of eight chords each, where an outline overlaps its shifted self
  /// Largest miss of ExitPupilFit at any of the samples: of the phase [waves], and of the amplitude against
  /// its largest value. A transfer function errs by less than 2π times this.
  double fit_tolerance = 2e-5;

  /// An MTF to 2e-3 at a tenth of the cost, for thousands of lenses.
  static constexpr PupilDetail quick() { return {128, 9, 12, 2e-4}; }
  /// Twice the rays in each direction, up to the usual number: for a wave that fewer do not tell.
  PupilDetail with_more_rays() const {
    const PupilDetail usual;
    PupilDetail more = *this;
    more.outline_azimuths =
        std::max(outline_azimuths, std::min(2 * outline_azimuths, usual.outline_azimuths));
    more.sample_radii = std::max(sample_radii, std::min(2 * sample_radii, usual.sample_radii));
    return more;
  }
  friend bool operator==(const PupilDetail&, const PupilDetail&) = default;
};

/// Which edges of an outline cross a line, looked up by bands of one coordinate.
class OutlineEdges {
 public:
  OutlineEdges() = default;
  /// \param at  that coordinate of the corners, in order.
  explicit OutlineEdges(const std::vector<double>& at);
  /// The edges, from corner i − 1 to corner i, that may reach a value.
  std::span<const std::size_t> near(double value) const;

 private:
  double low_ = 0, per_band_ = 0;
  std::vector<std::size_t> first_, edges_;  ///< of each band
};

/// The light that converges on the chief ray's image point, as a function of the exit direction cosines (α,
/// β). Mirror symmetric in α of a centred lens; blades cut it, and poses do away with the mirror image: see
/// whole_outline().
class ExitPupil {
 public:
  struct Chord {
    double low = 0, high = 0;
    double length() const { return high - low; }
  };

  /// Nothing where no ray passes.
  static std::optional<ExitPupil> of(const FieldTracer& tracer, const ChiefRay& chief,
                                     const PupilDetail& detail = {});

  double alpha_max() const { return alpha_max_; }
  const Chord& beta_range() const { return beta_range_; }
  double widest() const { return std::max(2 * alpha_max_, beta_range_.length()); }
  /// The largest distance of a ray on the image surface from the chief ray [mm].
  double transverse_mm() const { return transverse_mm_; }

  /// The range of β at this α ≥ 0, and of α at this β; of length zero outside the pupil.
  Chord along_beta(double alpha) const;
  Chord along_alpha(double beta) const;

  const PupilDetail& detail() const { return detail_; }
  const ChiefRay& chief() const { return chief_; }
  /// Whether the wave is even in α: the lens has no poses.
  bool mirrored() const { return boundary_.mirrored(); }
  /// The outline that the blades of the stop leave, or that a lens with poses has, once round in (α, β);
  /// empty for the round stop of a centred lens. All else here is the pupil of the round stop about it, and
  /// of a lens with poses nothing but its size.
  const std::vector<std::array<double, 2>>& whole_outline() const { return whole_outline_; }

  /// Where a ray ends on a sensor, from the chief ray's point there, and wave()'s phase about that point.
  struct OnSensor {
    double phase_waves = 0, x_mm = 0, y_mm = 0;
  };
  /// A ray of the half pupil α ≥ 0, or of the whole where that is not mirrored.
  struct Sample {
    double alpha = 0, beta = 0, amplitude = 0;  ///< of wave() in that direction
    std::vector<OnSensor> sensors = {};         ///< one a sensor
  };
  /// Rays over the pupil and on its rim, none of them aimed, on sensors that stand so far behind the image
  /// surface. The rays stay, the paths to them change.
  std::vector<Sample> samples(const PupilModel& model, const std::vector<double>& sensor_shifts_mm) const;

  /// Amplitude and phase in a direction, a exp(2πi φ). Aimed with real rays; zero where none goes that way.
  std::complex<double> wave(double alpha, double beta, const PupilModel& model) const;

 private:
  ExitPupil(const FieldTracer& tracer, const ChiefRay& chief, const PupilDetail& detail);
  struct Probe {
    double alpha, beta, phase_waves, x_mm, y_mm;
  };
  std::optional<Probe> probe(double u, double v) const;
  /// Many at once.
  std::vector<std::optional<Probe>> probe(const std::vector<std::array<double, 2>>& places) const;
  Probe at_sensor(const Ray& traced) const;
  bool find_outline(const PupilBoundary& pupil);
  void take_whole_outline(const PupilBoundary& pupil);

  const FieldTracer* tracer_;
  ChiefRay chief_;
  PupilDetail detail_;
  Pencil pencil_;
  double nudge_ = 0;
  double u_per_alpha_ = 0, v_per_beta_ = 0, middle_u_ = 0, middle_v_ = 0, middle_alpha_ = 0,
         middle_beta_ = 0;                            ///< first guess
  std::vector<double> outline_alpha_, outline_beta_;  ///< half of it, α ≥ 0, closed on the axis
  OutlineEdges across_alpha_, across_beta_;
  std::vector<std::array<double, 2>> whole_outline_;
  double alpha_max_ = 0, transverse_mm_ = 0, sphere_radius_mm_ = 0;
  double pupil_position_mm_ = 0;  ///< of the paraxial exit pupil, from the image surface
  PupilBoundary boundary_;        ///< coarse, for samples()
  Chord beta_range_;
};

}  // namespace petzval
