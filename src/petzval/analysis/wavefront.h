// SPDX-License-Identifier: BSD-3-Clause
// Wavefront aberration by field and wavelength.
#pragma once

#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/pupil_rays.h>

#include <optional>
#include <vector>

namespace petzval {

/// Radius of the reference sphere of a field: from the chief ray's image point to the centre of the paraxial
/// exit pupil at the lens's reference wavelength; positive when the pupil lies in front of the image,
/// ±infinite when it is telecentric.
double reference_sphere_radius_mm(const FieldTracer& tracer, const ChiefRay& chief);

/// A ray at (x, y) from the sphere's centre on the image surface: how far back along it the sphere lies, less
/// the radius and less the way back to the foot of the perpendicular from the centre; 0 for an infinite
/// sphere, NaN where the ray misses.
double sphere_behind_foot_mm(double x_mm, double y_mm, double alpha, double beta, double radius_mm);

/// W of each ray [waves]: (OPL_chief − OPL_ray)/λ, each path to the sphere about the chief ray's image point
/// through the centre of the paraxial exit pupil at the lens's reference wavelength (docs/CONVENTIONS.md,
/// "Optical path difference"). A telecentric pupil makes the sphere a plane wave per ray: the foot of the
/// perpendicular from the image point. \throws InputError when the exit pupil lies so near the image that a
/// ray misses the sphere.
std::vector<double> opd_waves(const FieldTracer& tracer, const ChiefRay& chief,
                              const std::vector<PupilRay>& rays);

struct WavefrontRow {
  double field = 0, wavelength_nm = 0;
  double real_image_height_mm = 0;
  double rms_waves = 0;               ///< area-weighted over the stop, piston removed
  double rms_without_tilt_waves = 0;  ///< the same with the best tilt over the stop removed too
  double pv_waves = 0;                ///< rim included
  /// |∬ e^{2πiW} dα dβ|² / (∬ dα dβ)² at the chief ray's image point, without approximation.
  double strehl = 0;
  double reference_sphere_radius_mm = 0;  ///< infinite for a telecentric exit pupil
};

/// \returns nothing where no ray passes.
std::optional<WavefrontRow> wavefront(const FieldTracer& tracer, const ChiefRay& chief,
                                      const PupilSampling& sampling = {});

/// Rows in the order fields × wavelengths. \throws InputError naming the field at which no ray passes.
std::vector<WavefrontRow> wavefront_table(const Lens& lens, const FieldTableRequest& request);

}  // namespace petzval
