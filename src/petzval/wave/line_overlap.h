// SPDX-License-Identifier: BSD-3-Clause
// A wave times itself beside it, summed along a line, on whatever SIMD the machine has.
#pragma once

#include <petzval/numeric/chebyshev_surface.h>
#include <petzval/numeric/quadrature.h>

#include <complex>
#include <optional>

namespace petzval {

/// A wave a exp(2πi φ) along a line through a pupil.
struct WaveLine {
  ChebyshevSurface::Line phase_waves;
  std::optional<ChebyshevSurface::Line> amplitude = {};  ///< absent: 1; below 0 it counts as 0

  std::complex<double> operator()(double along) const;
};

/// ∫ P(x) P*(x − shift) dx over [low, low + length]. \param rule  on [0, 1].
std::complex<double> line_overlap(const WaveLine& wave, double low, double length, double shift,
                                  const QuadratureRule& rule);

}  // namespace petzval
