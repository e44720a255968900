// SPDX-License-Identifier: BSD-3-Clause
// Paraxial (first-order) optics of a lens.
#pragma once

#include <petzval/lens/lens.h>

#include <optional>
#include <vector>

namespace petzval {

struct PupilData {
  double position_mm =
      0;  ///< entrance: from vertex 1; exit: from the image surface. ±infinity if telecentric.
  double diameter_mm = 0;
};

/// Signs and origins as in docs/CONVENTIONS.md; behind mirrors distances count along the light, as in the
/// lens unfolded, but for the track. Lengths in mm, at one wavelength. What lies beyond 10^10 mm is given as
/// infinite: nothing but rounding distinguishes it.
struct FirstOrder {
  double wavelength_nm = 0;
  double efl_mm = 0;             ///< 1/power, whatever the index behind the lens; infinite for an afocal lens
  double bfl_mm = 0;             ///< last vertex to rear focal point
  double ffl_mm = 0;             ///< vertex 1 to front focal point (negative when in front)
  double f_number = 0;           ///< |efl| / entrance pupil diameter
  double working_f_number = 0;   ///< 1 / (2 n' |u'|) at the object distance
  double image_space_na = 0;     ///< n' |u'| at the object distance
  double field_of_view_deg = 0;  ///< full angle at the entrance pupil, of the largest field given in the file
  double magnification = 0;      ///< 0 for an object at infinity
  PupilData entrance_pupil, exit_pupil;
  double petzval_radius_mm = 0;      ///< −1/(n' Σ φ/(n n')), of the image; infinite for a flat field
  double total_track_mm = 0;         ///< vertex 1 to image surface
  double paraxial_image_mm = 0;      ///< last vertex to the paraxial image of the object
  double stop_semi_diameter_mm = 0;  ///< height of the paraxial marginal ray at the stop
  double lagrange_invariant_mm = 0;  ///< for the largest field, positive
};

/// What paraxial optics says of a lens.
///
///     const FirstOrder optics = first_order(read_lens("dgauss-50mm").lens);
///     std::cout << optics.efl_mm << " mm f/" << optics.f_number << '\n';
///
/// The size of the stop follows from `lens.aperture` at the reference wavelength; another wavelength sees the
/// same stop. A real image height is taken for a paraxial one. \param wavelength_nm  absent: the lens's
/// reference wavelength. \throws InputError when an index is not known, or the lens cannot have the aperture
/// asked for.
FirstOrder first_order(const Lens& lens, std::optional<double> wavelength_nm = {});

/// A paraxial ray at the surfaces: heights y_k at vertex k, and the slope u_k *after* surface k; the height
/// at the image surface is the last entry of `height_mm`.
struct ParaxialRay {
  std::vector<double> height_mm, slope;
};

/// Traces height y (at vertex 1) and slope u (in front of it) through the lens to the image surface.
ParaxialRay trace_paraxial(const Lens& lens, double height_mm, double slope, double wavelength_nm);

/// Distance from the last vertex to the paraxial image of an object `object_distance_mm` in front of vertex 1
/// (absent: at infinity). ±infinity when the light leaves collimated.
double paraxial_image_distance_mm(const Lens& lens, std::optional<double> object_distance_mm,
                                  double wavelength_nm);

/// Diameter of the paraxial entrance pupil; infinite for a lens telecentric in object space.
/// \throws InputError as first_order().
double entrance_pupil_diameter_mm(const Lens& lens, double wavelength_nm);

/// Height on the paraxial image plane of the object point `object_field`, given in the unit of
/// `lens.fields.kind`; used to turn kinds of field into each other. An angle is positive for light that
/// travels towards +y, so that the image of an object at infinity is at +f tan θ; an object height h is
/// imaged at m h. Image heights are their own.
double paraxial_image_height_mm(const Lens& lens, double object_field, double wavelength_nm);

}  // namespace petzval
