// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/wave/ray_density.h>

#include <cmath>

#include "wave/analytic_pupils.h"

namespace petzval {
namespace {

constexpr double cone_na = 0.1;
constexpr double f_number = 1 / (2 * cone_na), lambda_um = lambda_nm * 1e-3;

TEST(RayDensity, DefocusMakesADiscOfEightNLambdaW) {
  const double w020 = 60;
  const SmoothPupil pupil =
      smooth_disc(cone_na, [&](double a, double b) { return w020 * (a * a + b * b) / (cone_na * cone_na); });
  const double radius_um = 4 * f_number * lambda_um * w020;
  const Psf psf = sum_rays(pupil, {101, 2.4 * radius_um / 101});
  const double flat = psf.spacing_um * psf.spacing_um / (pi * radius_um * radius_um);
  double second_moment = 0;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) {
      const double s = (j - 50) * psf.spacing_um, t = (i - 50) * psf.spacing_um, r = std::hypot(s, t);
      second_moment += psf.at(i, j) * r * r;
      // Uniform inside, dark outside; two cells for the edge. Patches overlap by a few per cent.
      if (r < radius_um - 2 * psf.spacing_um) {
        EXPECT_NEAR(psf.at(i, j) / flat, 1, 0.06) << i << " " << j;
      } else if (r > radius_um + 2 * psf.spacing_um) {
        EXPECT_EQ(psf.at(i, j), 0) << i << " " << j;
      }
    }
  EXPECT_NEAR(std::sqrt(2 * second_moment) / radius_um, 1, 2e-3);  // cells of a fortieth of it add (1/40)²/12
  EXPECT_GT(psf.captured, 0.999);
  EXPECT_LT(psf.captured, 1);
}

TEST(RayDensity, ComaFlaresToTheSideThatTheSlopeOfThePhaseSays) {
  const SmoothPupil pupil = smooth_disc(
      cone_na, [](double a, double b) { return 40 * b * (a * a + b * b) / (cone_na * cone_na * cone_na); });
  const Psf psf = sum_rays(pupil, {65, 20});
  double centroid_um = 0;
  for (int i = 0; i < 65; ++i)
    for (int j = 0; j < 65; ++j) centroid_um += psf.at(i, j) * (i - 32) * psf.spacing_um;
  // t = −λ ∂φ/∂β, whose mean over the disc is −λ·40·(α² + 3β²)/na³ = −λ·40/na.
  EXPECT_NEAR(centroid_um, -lambda_um * 40 / cone_na, 1.0);  // a twentieth of a cell
}

TEST(RayDensity, CountsWhatFallsOutsideTheGrid) {
  const SmoothPupil pupil =
      smooth_disc(cone_na, [](double a, double b) { return 60 * (a * a + b * b) / (cone_na * cone_na); });
  const double radius_um = 4 * f_number * lambda_um * 60;
  // The square inside the disc: 2/π of it.
  const Psf psf = sum_rays(pupil, {40, std::sqrt(2.0) * radius_um / 40});
  EXPECT_NEAR(psf.captured, 2 / pi,
              0.02);  // the even grid stands half a cell off, and the wings are less than 0.01
  EXPECT_THROW(sum_rays(pupil, {0, 1.0}), InputError);
}

}  // namespace
}  // namespace petzval
