// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/seidel.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/analysis/wavefront_zernike.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>

#include <cmath>

#include "golden_lenses.h"

namespace petzval {
namespace {

class GoldenZernike : public GoldenLensTest {};

TEST_P(GoldenZernike, CoefficientsAddUpToAnotherTracersRms) {
  // The mean of Z² is 1: the RMS is the root of the sum of squares without piston, plus the residual.
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.clip = Tracer::Clip::stop_only;
  const std::vector<WavefrontZernikeRow> rows = zernike_table(lens, request, ZernikeOrder::noll, 37);
  for_each_row([&](const FieldTracer& tracer, const ChiefRay&, const nlohmann::json& row) {
    for (const WavefrontZernikeRow& ours : rows) {
      if (ours.field != row["field_deg"].get<double>() ||
          std::abs(ours.wavelength_nm - tracer.tracer().wavelength_nm()) > 1e-6)
        continue;
      double sum = ours.rms_residual_waves * ours.rms_residual_waves;
      for (std::size_t j = 3; j < ours.coefficients.size(); ++j) sum += std::pow(ours.coefficients[j], 2);
      EXPECT_NEAR(std::sqrt(sum), row["rms_wfe_waves_piston_tilt_removed"], 1e-5);
      sum += std::pow(ours.coefficients[1], 2) + std::pow(ours.coefficients[2], 2);
      EXPECT_NEAR(std::sqrt(sum), row["rms_wfe_waves_piston_removed"], 1e-5);
      // The lens is mirror symmetric in x: no term that is odd in it.
      for (int j = 1; j <= 37; ++j) {
        const ZernikeTerm term = zernike_term(ZernikeOrder::noll, j);
        const bool odd_in_x = term.m > 0 ? term.m % 2 == 1 : term.m < 0 && -term.m % 2 == 0;
        if (!odd_in_x) continue;
        EXPECT_NEAR(ours.coefficients[static_cast<std::size_t>(j - 1)], 0, 1e-10);
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Lenses, GoldenZernike, golden_lenses());

TEST(WavefrontZernike, OfSmallAperturesIsSeidel) {
  // At f/20: W = W040 ρ⁴ + W131 ρ³ sin θ + …; Fringe Z9 = W040/6 (ρ⁴ = (Z9 + 3 Z4 + 2)/6), Z8 = W131/3.
  // Higher orders are shares of the squares of aperture and field.
  Lens lens = read_lens("cooke-triplet").lens;
  lens.aperture = {Aperture::Kind::f_number, 20};
  lens.fields.values = {2};
  lens.surfaces.back().thickness_mm = first_order(lens).paraxial_image_mm;
  const SeidelTerms sum = seidel_sums(lens).sum;
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.wavelengths_nm = {lens.reference_wavelength_nm};
  request.clip = Tracer::Clip::stop_only;
  const WavefrontZernikeRow row = zernike_table(lens, request, ZernikeOrder::fringe, 16).front();
  const double wave_mm = lens.reference_wavelength_nm * mm_per_nm;
  EXPECT_NEAR(row.coefficients[8], sum.s1 / 8 / wave_mm / 6, 0.03 * std::abs(sum.s1) / 8 / wave_mm / 6);
  EXPECT_NEAR(row.coefficients[7], sum.s2 / 2 / wave_mm / 3, 0.05 * std::abs(sum.s2) / 2 / wave_mm / 3);
  // Astigmatism of field along y: W222 (ρ sin θ)² = W222 (ρ² − ρ² cos 2θ)/2.
  EXPECT_NEAR(row.coefficients[4], -sum.s3 / 4 / wave_mm, 0.05 * std::abs(sum.s3) / 4 / wave_mm);
}

TEST(WavefrontMap, IsTheSumOfItsZernikePolynomials) {
  const Lens lens = read_lens("double-gauss").lens;
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.fields = {0, 10};
  request.wavelengths_nm = {587.5618};
  const std::vector<WavefrontMap> maps = wavefront_maps(lens, request, 21);
  const std::vector<WavefrontZernikeRow> fits = zernike_table(lens, request, ZernikeOrder::noll, 66);
  for (std::size_t f = 0; f < maps.size(); ++f) {
    int compared = 0;
    for (int i = 0; i < 21; ++i)
      for (int k = 0; k < 21; ++k) {
        const double waves = maps[f].waves[static_cast<std::size_t>(21 * i + k)];
        if (!std::isfinite(waves)) continue;
        ++compared;
        // Ten orders leave some 1e-4 waves at the rim.
        EXPECT_NEAR(waves, zernike_sum(ZernikeOrder::noll, fits[f].coefficients, 0.1 * k - 1, 0.1 * i - 1),
                    2e-3);
      }
    EXPECT_GT(compared, f == 0 ? 310 : 200);
    EXPECT_NEAR(maps[f].waves[21 * 10 + 10], 0, 1e-9);  // the chief ray
  }
  EXPECT_THROW(wavefront_maps(lens, request, 2), InputError);
}

}  // namespace
}  // namespace petzval
