// SPDX-License-Identifier: BSD-3-Clause
// Modulation transfer of a lens: by diffraction and by rays alone, at one wavelength and over several.
#pragma once

#include <petzval/analysis/exit_pupil.h>
#include <petzval/analysis/exit_pupil_fit.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/pupil_overlap.h>
#include <petzval/analysis/pupil_rays.h>

#include <complex>
#include <optional>
#include <vector>

namespace petzval {

/// Optical transfer function about the chief ray's image point, 1 at frequency zero:
/// OTF(ν) = ∬ P(p) P*(p − s) d²p / ∬ |P|² d²p, P the pupil over exit direction cosines p = (α, β), and s the
/// shift λν/n' along the direction of the pattern, so that frequencies are those on the sensor at any field
/// angle. With {light, plane_waves} it is the exact transform of Psf. By
/// Gauss-Legendre over chords of the overlap, every node a pair of aimed rays; no grid.
/// (Hopkins, Proc. R. Soc. A 231 (1955) 91, with the angle characteristic in place of a pupil sphere.)
std::complex<double> diffraction_otf(const FieldTracer& tracer, const ExitPupil& pupil,
                                     MtfDirection direction, double frequency_cpmm,
                                     const PupilModel& model = {});

/// The same, the wave asked of polynomials through the pupil's rays instead of aimed rays.
std::complex<double> diffraction_otf(const FieldTracer& tracer, const ExitPupil& pupil,
                                     const ExitPupilFit& wave, MtfDirection direction, double frequency_cpmm);

/// The transform of the ray spot, each ray weighing as the light it carries.
std::complex<double> geometric_otf(const std::vector<PupilRay>& rays, MtfDirection direction,
                                   double frequency_cpmm);

struct MtfOptions {
  std::vector<double> frequencies_cpmm = {};
  bool geometric = false;  ///< by as many rays as change no OTF by 1e-5
  PupilModel model = {};
  PupilDetail detail = {};
  /// One a wavelength of the request: over all wavelengths together, each PSF of unit light times its weight,
  /// at its own place (lateral colour included). Empty: every wavelength for itself.
  std::vector<double> weights = {};
  /// Sensors [mm] behind the lens's own image surface, each with rows of its own; the fields stay the object
  /// points that they are. Empty: the image surface alone.
  std::vector<double> sensor_shifts_mm = {};
};

struct MtfRow {
  double field = 0, wavelength_nm = 0;  ///< 0: polychromatic
  double frequency_cpmm = 0;
  double tangential = 0, sagittal = 0;
  double sensor_shift_mm = 0;
};

/// Rows in the order sensor shifts × fields × wavelengths (or one polychromatic) × frequencies. \throws
/// InputError naming a field at which no ray passes, for a negative or non-finite frequency, weights that do
/// not fit or a shift that is not finite.
std::vector<MtfRow> mtf_table(const Lens& lens, const FieldTableRequest& request, const MtfOptions& options);

}  // namespace petzval
