// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/fft_point_spread.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cmath>

#include "analysis/stigmatic_lens.h"

namespace petzval {
namespace {

double rms_difference(const Psf& one, const Psf& other) {
  double square = 0, norm = 0;
  for (std::size_t i = 0; i < one.values.size(); ++i) {
    square += std::pow(one.values[i] - other.values[i], 2);
    norm += std::pow(one.values[i], 2);
  }
  return std::sqrt(square / norm);
}

TEST(FftPointSpread, IsAnAiryDiscOfTheParaxialFNumber) {
  const Lens lens = stigmatic_lens(1);
  FieldTracer tracer(lens, 550);
  const double lambda_n_um = 0.55 * 20;
  const Psf psf = *fft_point_spread(tracer, *tracer.chief_ray(0), {41, 0.25 * lambda_n_um}, 512);
  for (int j = 20; j < 41; j += 2) {
    const double x = pi * 0.25 * (j - 20);
    const double airy = x == 0 ? 1 : std::pow(2 * std::cyl_bessel_j(1.0, x) / x, 2);
    EXPECT_NEAR(psf.at(20, j) / psf.at(20, 20), airy, 2e-3) << j;  // the ragged edge of 512 points across
  }
}

TEST(FftPointSpread, AgreesOnTheAxisAndPartsFromRealRaysOffIt) {
  // The paper's complaint. At 30 degrees a pupil looks foreshortened, cos θ wide, and the sensor is oblique,
  // cos² θ: the real pattern is wider by much, along t.
  const Lens lens = read_lens("cooke-triplet").lens;
  FieldTracer tracer(lens, 550);
  double last = 0;
  for (const auto& [field, least, most] : {std::tuple{0.0, 0.0, 0.02}, {10.0, 0.02, 0.3}, {20.0, 0.1, 2.0}}) {
    const ChiefRay chief = *tracer.chief_ray(field);
    PsfOptions options;
    options.size = 65;
    options.spacing_um = 1;
    const Psf rays = *point_spread(tracer, chief, options);
    const double difference = rms_difference(rays, *fft_point_spread(tracer, chief, {65, 1.0}));
    EXPECT_GE(difference, least) << field;
    EXPECT_LT(difference, most) << field;
    EXPECT_GT(difference, last);
    last = difference;
  }
}

TEST(FftPointSpread, RefusesGridsThatItCannotHave) {
  const Lens lens = stigmatic_lens(1);
  FieldTracer tracer(lens, 550);
  const ChiefRay chief = *tracer.chief_ray(0);
  EXPECT_THROW(fft_point_spread(tracer, chief, {32, 1.0}, 7), InputError);
  EXPECT_THROW(fft_point_spread(tracer, chief, {32, 1.0}, 4096), InputError);
  EXPECT_THROW(fft_point_spread(tracer, chief, {32, 1.0, 2}), InputError);
}

}  // namespace
}  // namespace petzval
