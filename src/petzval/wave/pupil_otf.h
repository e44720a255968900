// SPDX-License-Identifier: BSD-3-Clause
// The transfer function of any pupil: blades, obstruction, and a wavefront of radial and Zernike terms.
#pragma once

#include <petzval/wave/aperture_shape.h>
#include <petzval/wave/otf.h>
#include <petzval/wave/zernike.h>

#include <complex>
#include <memory>
#include <vector>

namespace petzval {

/// The pupil exp(2πi W) inside the shape. Pupil coordinates run along x' and y' of image space, the unit
/// circle being the rim that the f-number belongs to. W is in waves and signed as reports quote it
/// (docs/CONVENTIONS.md, "Optical path difference"): W > 0 where the wavefront runs ahead of the reference
/// sphere.
struct GeneralPupil {
  ApertureShape shape;
  std::vector<double> w_waves;  ///< at the rim: W020, W040, W060, …
  ZernikeOrder order = ZernikeOrder::fringe;
  std::vector<double> zernike_waves;  ///< [0] is the coefficient of Z_1

  /// Whether it is rotationally symmetric, so that RadialPupil says it all.
  bool is_radial() const;
  RadialPupil radial() const;  ///< \throws InputError unless is_radial()
  double aberration(double x, double y) const;
  /// The largest slope of W over the unit disc [waves per radius].
  double steepest() const;
  /// \throws InputError as ApertureShape::validate and zernike_term; for terms beyond the 20th order,
  /// coefficients that are not finite, or a wavefront steeper than 100 waves per radius.
  void validate() const;
};

/// OTF at (s cos θ, s sin θ) in image space, s = ν/ν_c with ν_c = 1/(λN): the autocorrelation of the pupil,
/// (1/area) ∬ exp 2πi(W(p + s) − W(p − s)) over the overlap of the two shifted shapes. Strips along the
/// shift, each divided where an obstruction cuts it, by Gauss-Legendre; heights divided at every corner and
/// crossing. Error below 1e-9. \throws InputError as validate().
std::complex<double> pupil_otf_at(const GeneralPupil& pupil, double s, double theta);

/// U(x, y) = (1/area) ∬ exp(−2πi W − iπ(p·x)) d²p at x, y [λN] of image space; |U|² is 1 at the centre of the
/// unaberrated PSF. Error below 1e-9 within 200 λN. \throws InputError as validate().
std::complex<double> pupil_amplitude_at(const GeneralPupil& pupil, double x, double y);

/// As an Otf in the frame of stored pictures (x against x', y along y'), by a table in direction and
/// frequency, whose sectors end where the directions of blades lie, so that no interpolation crosses the
/// ridges that straight edges raise. Sixth order: error below 1e-6, but for 2e-5 within a step of the curves
/// on which a corner passes an edge, and 2e-4 there of those on which an obstruction touches a rim. \throws
/// InputError as validate(), or unless wavelength and f-number are positive.
std::unique_ptr<Otf> general_pupil_otf(const GeneralPupil& pupil, double wavelength_nm, double f_number);

}  // namespace petzval
