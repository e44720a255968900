// SPDX-License-Identifier: BSD-3-Clause
// Paraxial (first-order) optics of a lens.
#pragma once

#include <petzval/lens/lens.h>

#include <optional>
#include <vector>

namespace petzval {

struct PupilData {
  double position_mm = 0;  ///< entrance: from vertex 1; exit: from the image surface. ±infinity if telecentric.
  double diameter_mm = 0;
};

/// Signs and origins as in docs/CONVENTIONS.md. Lengths in mm, at one wavelength.
struct FirstOrder {
  double wavelength_nm = 0;
  double efl_mm = 0;  ///< infinite for an afocal lens
  double bfl_mm = 0;  ///< last vertex to rear focal point
  double ffl_mm = 0;  ///< vertex 1 to front focal point (negative when in front)
  double f_number = 0;           ///< efl / entrance pupil diameter
  double working_f_number = 0;   ///< 1 / (2 n' |u'|) at the object distance
  double image_space_na = 0;     ///< n' |u'| at the object distance
  double field_of_view_deg = 0;  ///< full, from the largest field given in the file
  double magnification = 0;      ///< 0 for an object at infinity
  PupilData entrance_pupil, exit_pupil;
  double petzval_radius_mm = 0;       ///< −1/(n' Σ(…)); infinite for a flat field
  double total_track_mm = 0;          ///< vertex 1 to image surface
  double paraxial_image_mm = 0;       ///< last vertex to the paraxial image of the object
  double lagrange_invariant_mm = 0;   ///< for the largest field
};

/// \param wavelength_nm  absent: the lens's reference wavelength.
/// \throws InputError when an index is not known, or the lens cannot have the aperture asked for.
FirstOrder first_order(const Lens& lens, std::optional<double> wavelength_nm = {});

/// A paraxial ray at the surfaces: heights y_k at vertex k, and the slope u_k *after* surface k; the height at the
/// image surface is the last entry of `height_mm`.
struct ParaxialRay {
  std::vector<double> height_mm, slope;
};

/// Traces y, u (slope in the space before surface 0, height at vertex 0) through the lens. `from`, `to`: surface
/// indices, the ray is refracted at [from, to).
ParaxialRay trace_paraxial(const Lens& lens, double height_mm, double slope, double wavelength_nm);

/// Distance from the last vertex to the paraxial image of an object `object_distance_mm` in front of vertex 1
/// (absent: at infinity).
double paraxial_image_distance_mm(const Lens& lens, std::optional<double> object_distance_mm, double wavelength_nm);

/// The image distance of an object at infinity, and the paraxial image height of a field in the units of
/// `lens.fields.kind`, at the lens's reference wavelength; used to turn field kinds into each other.
double paraxial_image_height_mm(const Lens& lens, double object_field, double wavelength_nm);

}  // namespace petzval
