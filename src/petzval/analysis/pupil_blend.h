// SPDX-License-Identifier: BSD-3-Clause
// Pupils between others, wavelength by wavelength.
#pragma once

#include <petzval/analysis/pupil_fit.h>

#include <cstddef>
#include <vector>

namespace petzval {

/// Place i of `count` on [0, 1], as Chebyshev's points with both ends are: dense there.
double chebyshev_place(std::size_t i, std::size_t count);

/// α² and β of an outline at places that stay the same share of each smooth piece.
struct Outline {
  std::vector<double> alpha_square, beta;
  std::vector<std::size_t> corners;
};

/// Whether two outlines are the same to 2e-5 of the pupil's half width, over shares of their smooth pieces.
bool same_outline(const SmoothPupil& one, const SmoothPupil& other);

/// Fitted pupils of a field at a few wavelengths, and what lies between them by Lagrange's polynomial over
/// the wavenumber: of outlines, phases and amplitudes.
class PupilBlend {
 public:
  /// \param at  wavenumbers, rising. \param fitted  must live as long. Nothing may be asked unless alike().
  PupilBlend(std::vector<double> at, std::vector<const FittedPupil*> fitted);

  /// Whether all have as many corners.
  bool alike() const { return alike_; }
  /// The largest residuals of the fits.
  double phase_rms() const { return phase_rms_; }
  double amplitude_rms() const { return amplitude_rms_; }

  /// Lagrange's weights at a wavenumber.
  std::vector<double> weights(double x) const;
  const FittedPupil& nearest(double x) const;
  /// \param x  wavenumber, within `at`.
  SmoothPupil pupil(double x, double wavelength_nm, double image_index) const;

 private:
  /// The line through the frames of the fits: polynomials that stand in it follow the wavelength.
  ChebyshevSurface::Frame frame_at(ChebyshevSurface SmoothPupil::*surface, double x) const;

  std::vector<double> at_;
  std::vector<const FittedPupil*> fitted_;
  std::vector<Outline> outlines_;
  std::vector<ChebyshevSurface> phases_, amplitudes_;
  double phase_rms_ = 0, amplitude_rms_ = 0;
  bool alike_ = true;
};

}  // namespace petzval
