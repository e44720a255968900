// SPDX-License-Identifier: BSD-3-Clause
// The plane-wave sum against closed forms for a circular pupil of uniform amplitude.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/wave/angle_characteristic.h>

#include <cmath>

#include "wave/analytic_pupils.h"

namespace petzval {
namespace {

double no_phase(double, double) {
  return 0;
}

/// Irradiance per flux at a sample, times (λN)²: π/4 at the centre of an Airy disc.
double density(const Psf& psf, int i, int j, double na) {
  const double lambda_n_um = lambda_nm * 1e-3 / (2 * na);
  return psf.at(i, j) * psf.captured * (lambda_n_um * lambda_n_um) / (psf.spacing_um * psf.spacing_um);
}

TEST(PlaneWaveSum, IsAnAiryDiscForSeveralApertures) {
  for (const double na : {0.05, 0.1, 0.25}) {
    const double lambda_n_um = lambda_nm * 1e-3 / (2 * na);
    const Psf psf = sum_plane_waves(disc(na, no_phase), 65, 0.25 * lambda_n_um);
    for (int i = 0; i < psf.size; i += 5)
      for (int j = 0; j < psf.size; j += 3) {
        const double r = 0.25 * std::hypot(i - 32, j - 32);  // in λN
        const double x = pi * r;
        const double airy = pi / 4 * (r == 0 ? 1.0 : std::pow(2 * std::cyl_bessel_j(1.0, x) / x, 2));
        EXPECT_NEAR(density(psf, i, j, na), airy, 2e-7) << na << " " << i << " " << j;  // float storage
      }
  }
}

TEST(PlaneWaveSum, CapturesTheShareThatTheAiryPatternHasInTheWindow) {
  const double na = 0.125, lambda_n_um = lambda_nm * 1e-3 / (2 * na);
  const Psf psf = sum_plane_waves(disc(na, no_phase), 40, 0.5 * lambda_n_um);
  // Encircled energy 1 − J0² − J1² of the inscribed and the circumscribed circle bound the square window's
  // share.
  const auto encircled = [](double r) {
    const double j0 = std::cyl_bessel_j(0.0, pi * r), j1 = std::cyl_bessel_j(1.0, pi * r);
    return 1 - j0 * j0 - j1 * j1;
  };
  EXPECT_GT(psf.captured, encircled(9.5));
  EXPECT_LT(psf.captured, encircled(10.5 * std::sqrt(2.0)));
  double sum = 0;
  for (const float value : psf.values) sum += value;
  EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(PlaneWaveSum, DefocusOnAxisFollowsSincSquared) {
  const double na = 0.1;
  for (const double w020 : {0.25, 0.5, 1.0, 1.5}) {
    const Psf psf = sum_plane_waves(
        disc(na, [&](double a, double b) { return w020 * (a * a + b * b) / (na * na); }), 9, 0.4);
    const double x = pi * w020, sinc = std::sin(x) / x;
    EXPECT_NEAR(density(psf, 4, 4, na) / (pi / 4), sinc * sinc, 1e-6) << w020;
  }
}

TEST(PlaneWaveSum, APhaseSlopeMovesTheImageAgainstIt) {
  // φ = −β t₀/λ moves the peak to t = +t₀: the sign that puts a coma tail on the right side.
  const double na = 0.1, t0_mm = 2.0e-3;
  const Psf psf =
      sum_plane_waves(disc(na, [&](double, double b) { return -b * t0_mm / (lambda_nm * 1e-6); }), 41, 0.5);
  int best_i = 0, best_j = 0;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j)
      if (psf.at(i, j) > psf.at(best_i, best_j)) best_i = i, best_j = j;
  EXPECT_EQ(best_i, 20 + 4);
  EXPECT_EQ(best_j, 20);
}

TEST(PlaneWaveSum, EvenSizesCentreOnTheUpperMiddleSample) {
  const Psf psf = sum_plane_waves(disc(0.1, no_phase), 32, 1.0);
  for (int i = 0; i < 32; ++i)
    for (int j = 0; j < 32; ++j) EXPECT_LE(psf.at(i, j), psf.at(16, 16));
}

TEST(PlaneWaveSum, ImageIndexShrinksThePattern) {
  PupilWaves waves = disc(0.1, no_phase);
  const Psf in_air = sum_plane_waves(waves, 21, 1.5);
  waves.image_index = 1.5;
  const Psf in_glass = sum_plane_waves(waves, 21, 1.0);
  for (std::size_t i = 0; i < in_air.values.size(); ++i)
    EXPECT_NEAR(in_air.values[i], in_glass.values[i], 1e-7);
}

TEST(PlaneWaveSum, RefusesEmptyGrids) {
  EXPECT_THROW(sum_plane_waves(disc(0.1, no_phase), 0, 1), InputError);
  EXPECT_THROW(sum_plane_waves(disc(0.1, no_phase), 8, 0), InputError);
}

}  // namespace
}  // namespace petzval
