// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/seidel.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>

#include <array>
#include <cmath>

#include "golden_lenses.h"

namespace petzval {
namespace {

std::array<double, 7> as_array(const SeidelTerms& terms) {
  return {terms.s1, terms.s2, terms.s3, terms.s4, terms.s5, terms.cl, terms.ct};
}

class GoldenSeidel : public GoldenLensTest {};

TEST_P(GoldenSeidel, SurfaceBySurface) {
  const SeidelSums ours = seidel_sums(lens);
  const nlohmann::json& theirs = reference["seidel"];
  EXPECT_NEAR(ours.lagrange_invariant_mm / theirs["lagrange_H"].get<double>(), 1, 1e-9);
  ASSERT_EQ(ours.surfaces.size(), theirs["per_surface"].size());
  for (std::size_t k = 0; k < 7; ++k) {
    double largest = 0;  // rounding of a term is relative to the largest of its kind
    for (const nlohmann::json& row : theirs["per_surface"])
      largest = std::max(largest, std::abs(row[k].get<double>()));
    for (std::size_t i = 0; i < ours.surfaces.size(); ++i)
      EXPECT_NEAR(as_array(ours.surfaces[i])[k], theirs["per_surface"][i][k].get<double>(), 1e-10 * largest)
          << "surface " << i << ", term " << k;
    const double sum = theirs["sum"][k];
    EXPECT_NEAR(as_array(ours.sum)[k], sum, 1e-6 * std::abs(sum)) << "term " << k;
  }
}

TEST_P(GoldenSeidel, PetzvalSumLaw) {
  // S4 = H² P with the Petzval curvature 1/r_p = −n' P: paraxial matrices against surface sums.
  const SeidelSums sums = seidel_sums(lens);
  const double curvature = -1 / first_order(lens).petzval_radius_mm;
  EXPECT_NEAR(sums.sum.s4, std::pow(sums.lagrange_invariant_mm, 2) * curvature, 1e-12);
}

TEST_P(GoldenSeidel, AxialColourIsTheShiftOfTheFocus) {
  // Paraxial foci of the two wavelengths differ by δl' = CL/(n' u'²), up to the second order of dispersion.
  const SeidelSums sums = seidel_sums(lens);
  const FirstOrder first = first_order(lens, lens.wavelengths_nm.front()),
                   last = first_order(lens, lens.wavelengths_nm.back());
  const double na = first_order(lens).image_space_na;
  EXPECT_NEAR(-(first.bfl_mm - last.bfl_mm) * na * na, sums.sum.cl, 0.1 * std::abs(sums.sum.cl));
}

INSTANTIATE_TEST_SUITE_P(Lenses, GoldenSeidel, golden_lenses());

Lens singlet(double conic, double quartic) {
  Lens lens;
  lens.name = "plano-convex lens";
  Surface front, back;
  front.thickness_mm = 2;
  front.material = Material(Material::Constant{1.5});
  front.stop = true;
  back.curvature_per_mm = -1.0 / 20;
  back.conic = conic;
  if (quartic != 0) back.asphere[4] = quartic;
  back.thickness_mm = 40;
  lens.surfaces = {front, back};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 0.5};
  lens.fields.values = {0, 5};
  lens.wavelengths_nm = {550};
  lens.reference_wavelength_nm = 550;
  return lens;
}

TEST(Seidel, PlanoHyperbolicLensHasNoSphericalAberration) {
  // Its conic constant is −n²: exactly stigmatic for an object at infinity.
  const double sphere = seidel_sums(singlet(0, 0)).sum.s1;
  EXPECT_GT(sphere, 1e-6);
  EXPECT_NEAR(seidel_sums(singlet(-2.25, 0)).sum.s1, 0, 1e-12 * sphere);
  // k c³/8 in the sag is what the r⁴ term is.
  EXPECT_NEAR(seidel_sums(singlet(0, -2.25 * std::pow(-1.0 / 20, 3) / 8)).sum.s1, 0, 1e-12 * sphere);
}

TEST(Seidel, SphericalAberrationIsThatOfRealRays) {
  // At f/40 the fourth order is all there is, up to a share of NA² and so on, 1e-3: an OPD at the rim of W040
  // = S1/8 in the paraxial image plane, of which the lens keeps PV = W040.
  for (const double conic : {0.0, -4.0, 3.0}) {
    const Lens lens = singlet(conic, 0);
    const WavefrontRow row = wavefront_table(lens, {Fields::Kind::angle_deg, {0}, {550}}).front();
    const double w040 = seidel_sums(lens).sum.s1 / 8 / 550e-6;
    EXPECT_NEAR(row.pv_waves, std::abs(w040), 5e-3 * std::abs(w040)) << conic;
  }
}

TEST(Seidel, SumsOfAFiniteObjectHaveTheLagrangeInvariantOfTheLens) {
  const Lens lens = read_lens("edmund-54852").lens;
  ASSERT_TRUE(lens.object_distance_mm);
  const SeidelSums sums = seidel_sums(lens);
  const FirstOrder first = first_order(lens);
  EXPECT_GT(sums.lagrange_invariant_mm, 0);
  EXPECT_NEAR(sums.sum.s4 / std::pow(sums.lagrange_invariant_mm, 2), -1 / first.petzval_radius_mm, 1e-12);
}

/// What the bundled lenses to teach with were solved for.
TEST(Seidel, TeachingLensesHaveTheAberrationTheyAreFor) {
  const auto sums = [](const char* name) { return seidel_sums(read_lens(name).lens).sum; };
  // A thin lens in parallel light, shape factor X (Welford, 1986, section 12.2):
  // S1 = h⁴K³/4 · (n²/(n−1)² + (n+2)/(n (n−1)²) · (X − 2 (n²−1)/(n+2))² − n/(n+2)).
  const Lens singlet = read_lens("plano-convex").lens;
  const double n = singlet.surfaces[0].material.index(singlet.reference_wavelength_nm);
  const auto s1 = [n](double shape) {
    const double h = 6.25, power = 1 / 50.0, off = shape - 2 * (n * n - 1) / (n + 2);
    return std::pow(h, 4) * std::pow(power, 3) / 4 *
           (n * n / std::pow(n - 1, 2) + (n + 2) / (n * std::pow(n - 1, 2)) * off * off - n / (n + 2));
  };
  // Parallel light passes a flat front as if it were not there: thickness does not matter.
  EXPECT_NEAR(sums("plano-convex-reversed").s1 / s1(-1), 1, 1e-6);
  // The other way round the marginal ray is 5 % lower at the second surface.
  EXPECT_NEAR(sums("plano-convex").s1 / s1(1), 1, 0.05);

  const SeidelTerms coma = sums("coma-singlet"), landscape = sums("landscape-lens");
  EXPECT_LT(std::abs(coma.s1), 1e-6 * std::abs(coma.s2));
  EXPECT_GT(std::abs(coma.s2), 3 * std::abs(coma.s3));
  EXPECT_LT(std::abs(landscape.s2), 1e-6 * landscape.s1);
  EXPECT_NEAR(3 * landscape.s3 / landscape.s4, -1, 1e-5);  // a flat tangential field
  // One focus at both ends of the spectrum: nothing is left of what a singlet of the same focal length has.
  EXPECT_LT(std::abs(sums("achromat-50mm").cl), 1e-3 * sums("plano-convex").cl);
}

TEST(Seidel, NeedAParaxialField) {
  Lens lens = read_lens("cooke-triplet").lens;
  lens.fields.values = {0, 95};
  EXPECT_THROW(seidel_sums(lens), InputError);
}

}  // namespace
}  // namespace petzval
