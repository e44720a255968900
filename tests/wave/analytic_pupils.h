// SPDX-License-Identifier: BSD-3-Clause
// Pupils of known phase, as nodes and as smooth functions.
#pragma once

#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/wave/angle_characteristic.h>
#include <petzval/wave/smooth_pupil.h>

#include <array>
#include <cmath>
#include <functional>

namespace petzval {

inline constexpr double lambda_nm = 550;

using Phase = std::function<double(double, double)>;  ///< of (α, β) [waves]

/// A circular pupil of numerical aperture `na` with uniform amplitude.
inline PupilWaves disc(double na, const Phase& phase, int radial = 64, int azimuths = 200) {
  PupilWaves waves;
  waves.wavelength_nm = lambda_nm;
  const QuadratureRule rule = gauss_legendre(radial, 0, na);
  for (int i = 0; i < azimuths / 2; ++i) {
    const double azimuth = 2 * pi * (i + 0.5) / azimuths;
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const double a = rule.nodes[k] * std::sin(azimuth), b = rule.nodes[k] * std::cos(azimuth);
      waves.alpha.push_back(a);
      waves.beta.push_back(b);
      waves.phase_waves.push_back(phase(a, b));
      waves.amplitude.push_back(rule.nodes[k] * rule.weights[k] * 2 * pi / azimuths);
      waves.flux += 2 * waves.amplitude.back();
    }
  }
  return waves;
}

/// The same as a SmoothPupil; the phase must be a polynomial of degree 8 at most.
inline SmoothPupil smooth_disc(double na, const Phase& phase) {
  SmoothPupil pupil;
  pupil.wavelength_nm = lambda_nm;
  pupil.flux = pi * na * na;
  std::vector<double> alpha, beta, values, ones;
  constexpr int rim = 64;
  for (int i = 0; i <= rim; ++i) {
    pupil.outline_alpha.push_back(i % rim == 0 ? 0.0 : na * std::sin(pi * i / rim));
    pupil.outline_beta.push_back(na * std::cos(pi * i / rim));
  }
  const double step = 1e-4 * na, lambda_mm = lambda_nm * mm_per_nm;
  for (int ring = 1; ring <= 10; ++ring)
    for (int i = 0; i < 24; ++i) {
      const double r = 0.1 * na * ring, azimuth = pi * (i + 0.5) / 24;
      const double a = r * std::sin(azimuth), b = r * std::cos(azimuth);
      alpha.push_back(a);
      beta.push_back(b);
      values.push_back(phase(a, b));
      ones.push_back(1);
      const double s = -lambda_mm * (phase(a + step, b) - phase(a - step, b)) / (2 * step);
      const double t = -lambda_mm * (phase(a, b + step) - phase(a, b - step)) / (2 * step);
      pupil.reach_s_mm = std::max(pupil.reach_s_mm, std::abs(s));
      pupil.low_t_mm = std::min(pupil.low_t_mm, t);
      pupil.high_t_mm = std::max(pupil.high_t_mm, t);
    }
  const std::array<std::span<const double>, 2> both{values, ones};
  const std::vector<ChebyshevSurface> surfaces = ChebyshevSurface::fit(alpha, beta, both, 8);
  pupil.phase_waves = surfaces.at(0);
  pupil.amplitude = surfaces.at(1);
  return pupil;
}

}  // namespace petzval
