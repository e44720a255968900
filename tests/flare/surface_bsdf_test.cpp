// SPDX-License-Identifier: BSD-3-Clause
// What surfaces scatter against closed forms.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/surface_bsdf.h>

#include <cmath>

namespace petzval {
namespace {

/// 2π ∫ b (1 + (τ/l)²)^(s/2) τ dτ over τ ≤ 1 (J. E. Harvey 1976).
double harvey_total(double b0, double l, double s) {
  if (s == -2) return pi * b0 * l * l * std::log1p(1 / (l * l));
  return 2 * pi * b0 * l * l / (s + 2) * (std::pow(1 + 1 / (l * l), (s + 2) / 2) - 1);
}

Scatter harvey_scatter(double b0, double l, double s) {
  Scatter scatter;
  scatter.b0_per_sr = b0, scatter.l = l, scatter.s = s, scatter.wavelength_nm = 550;
  return scatter;
}

// The logarithm is linear over steps of 0.0138 of ln τ, its second derivative up to |s|/2: 0.0138²/8 times
// that is 6e-5 at s = −5.
constexpr double step_error = 1e-4;

TEST(SurfaceBsdf, SumsUpToHarveysClosedForm) {
  for (const double l : {1e-3, 0.01, 0.3})
    for (const double s : {-0.5, -1.5, -2.0, -3.0, -5.0}) {
      const double b0 = 0.01 / harvey_total(1, l, s);
      const SurfaceBsdf bsdf(harvey_scatter(b0, l, s), 550, 1, 1.5);
      const ScatterShares shares = bsdf.shares(1, 1);
      EXPECT_NEAR(shares.polish / 0.01, 1, step_error) << l << " " << s;
      EXPECT_NEAR(bsdf.at(shares, 0) / b0, 1, step_error);
      EXPECT_NEAR(bsdf.at(shares, l) / (b0 * std::pow(2, s / 2)), 1, step_error);
      EXPECT_EQ(bsdf.at(shares, 1.01), 0);
      EXPECT_NEAR(bsdf.within(shares, 1), shares.polish, 1e-12);
      // Within τ: the same closed form up to there, which is that of l/τ.
      const double tau = 0.05;
      EXPECT_NEAR(bsdf.within(shares, tau) / (tau * tau * harvey_total(b0, l / tau, s)), 1, 2 * step_error);
    }
}

// The same irregularities: b₀ with λ⁻⁴, l with λ.
TEST(SurfaceBsdf, GoesWithTheWavelengthAsOneSurfaceDoes) {
  const SurfaceBsdf red(harvey_scatter(0.5, 0.02, -1.5), 700, 1, 1.5);
  const double ratio = 700.0 / 550;
  EXPECT_NEAR(red.shares(1, 1).polish / harvey_total(0.5 * std::pow(ratio, -4), 0.02 * ratio, -1.5), 1,
              step_error);
  Scatter rough;
  rough.roughness_nm = 1;
  const double blue = SurfaceBsdf(rough, 400, 1, 1.5).shares(1, 1).polish,
               twice = SurfaceBsdf(rough, 800, 1, 1.5).shares(1, 1).polish;
  EXPECT_NEAR(blue / twice, 4, 1e-3);
}

TEST(SurfaceBsdf, RoughnessScattersAsItsPhaseDoes) {
  Scatter scatter;
  scatter.roughness_nm = 0.5;
  const double waves = 0.5 / 550;
  const double normal = SurfaceBsdf(scatter, 550, 1, 1.5).shares(1, 1).polish;
  EXPECT_NEAR(normal / std::pow(2 * pi * 0.5 * waves, 2), 1, 1e-5);
  // From behind as from the front.
  EXPECT_NEAR(SurfaceBsdf(scatter, 550, 1.5, 1).shares(1, 1).polish, normal, 1e-15);
  const double cosine = 0.6;
  EXPECT_NEAR(SurfaceBsdf(scatter, 550, 1, 1, true).shares(cosine, cosine).polish /
                  std::pow(4 * pi * waves * cosine, 2),
              1, 1e-4);
  // Nothing to scatter at where the index does not change.
  EXPECT_EQ(SurfaceBsdf(scatter, 550, 1, 1).shares(1, 1).polish, 0);
}

TEST(SurfaceBsdf, KeepsAllLight) {
  Scatter scatter;
  scatter.roughness_nm = 20;
  scatter.cleanliness_level = 500;
  const SurfaceBsdf bsdf(scatter, 450, 1, 1.8);
  for (const double cosine : {1.0, 0.7, 0.2}) {
    const double after = std::sqrt(1 - (1 - cosine * cosine) / (1.8 * 1.8));
    const ScatterShares shares = bsdf.shares(cosine, after);
    EXPECT_GT(shares.specular(), 0);
    EXPECT_NEAR(shares.specular() + bsdf.within(shares, 1) + shares.blocked, 1, 1e-12);
    // 2π ∫ BSDF τ dτ by the midpoint rule in ln τ.
    double sum = 0;
    constexpr int steps = 20000;
    const double low = std::log(1e-5), step = -low / steps;
    for (int i = 0; i < steps; ++i) {
      const double tau = std::exp(low + (i + 0.5) * step);
      sum += 2 * pi * bsdf.at(shares, tau) * tau * tau * step;
    }
    EXPECT_NEAR(sum / shares.scattered(), 1, 1e-4);
  }
}

TEST(SurfaceBsdf, OfATableIsTheTable) {
  Scatter scatter;
  scatter.table = {
      {1, 0.2}, {10, 0.2}, {30, 0.2 * std::pow(std::sin(radians(30)) / std::sin(radians(10)), -2)}};
  scatter.wavelength_nm = 550;
  const SurfaceBsdf bsdf(scatter, 550, 1, 1.5);
  const ScatterShares shares = bsdf.shares(1, 1);
  const double ten = std::sin(radians(10)), thirty = std::sin(radians(30));
  // Even up to 10 degrees, then with the square of the sine up to 30.
  const double expected = 0.2 * pi * ten * ten * (1 + 2 * std::log(thirty / ten));
  // The step of ln τ that 30 degrees cut may be lost: 2 · 0.0138 of 1 + 2 ln 2.88.
  EXPECT_NEAR(shares.polish / expected, 1, 9e-3);
  EXPECT_NEAR(bsdf.at(shares, std::sin(radians(5))), 0.2, 1e-9);
  EXPECT_NEAR(bsdf.at(shares, std::sin(radians(20))), 0.2 * std::pow(std::sin(radians(20)) / ten, -2), 2e-4);
  EXPECT_LT(bsdf.at(shares, std::sin(radians(31))), 1e-9);
}

// Particles of a level counted by their sizes, one by one from the largest.
TEST(Dust, CoversWhatItsParticlesDo) {
  for (const double level : {100.0, 300.0, 750.0}) {
    double covered_um2 = 0, before = 1;
    for (double d = level; d > 1; d -= 0.01) {
      const double larger =
          std::pow(10, 0.926 * (std::pow(std::log10(level), 2) - std::pow(std::log10(d - 0.01), 2)));
      covered_um2 += (larger - before) * pi / 4 * d * (d - 0.01);
      before = larger;
    }
    Scatter scatter;
    scatter.cleanliness_level = level;
    EXPECT_NEAR(scatter.dust_share() / (covered_um2 / 1e11), 1, 1e-3) << level;
    Scatter by_share;
    by_share.dust_percent = 100 * scatter.dust_share();
    EXPECT_NEAR(by_share.dust_level() / level, 1, 1e-6);
  }
}

// Airy's patterns of all sizes, with every fringe, by another quadrature.
TEST(Dust, DiffractsAsDiscsOfItsSizes) {
  Scatter scatter;
  scatter.cleanliness_level = 300;
  const SurfaceBsdf bsdf(scatter, 550, 1, 1.5);
  const ScatterShares shares = bsdf.shares(1, 1);
  EXPECT_EQ(shares.dust, shares.blocked);
  for (const double tau : {1e-3, 0.01, 0.03, 0.1, 0.3}) {
    double sum = 0, weights = 0, evanescent = 0;
    constexpr int sizes = 20000;
    const double top = std::log10(300.0), step = top / sizes;
    for (int i = 0; i < sizes; ++i) {
      const double log_d = (i + 0.5) * step, d = std::pow(10, log_d) / 0.55;
      const double weight = log_d * std::pow(10, 2 * log_d - 0.926 * log_d * log_d);
      const double x = pi * d * tau, pattern = std::pow(2 * std::cyl_bessel_j(1.0, x) / x, 2);
      sum += weight * pi / 4 * d * d * pattern;
      weights += weight;
      // Beyond τ = 1: J₀² + J₁² (Rayleigh's encircled light).
      const double edge = pi * d;
      evanescent +=
          weight * (std::pow(std::cyl_bessel_j(0.0, edge), 2) + std::pow(std::cyl_bessel_j(1.0, edge), 2));
    }
    EXPECT_NEAR(bsdf.at(shares, tau) / shares.dust / (sum / (weights - evanescent)), 1, 0.01) << tau;
  }
}

TEST(ScatterText, IsReadAndRefused) {
  const Scatter scatter = parse_scatter("roughness=1.5, l=0.02,s=-2,dust=0.03");
  EXPECT_EQ(scatter.roughness_nm, 1.5);
  EXPECT_EQ(scatter.l, 0.02);
  EXPECT_EQ(scatter.s, -2);
  EXPECT_EQ(scatter.dust_percent, 0.03);
  for (const char* wrong :
       {"", "rough", "rough=1", "roughness=x", "roughness=-1", "roughness=1,roughness=2", "roughness=1,b0=1",
        "l=0.1", "dust=20", "dust=1,level=300", "level=1", "b0=0", "roughness=1,l=2", "roughness=1,s=1",
        "roughness=1,wavelength=-5", "b0=1,table=", "roughness=nan"})
    EXPECT_THROW(parse_scatter(wrong), InputError) << wrong;
  Scatter too_much;
  too_much.b0_per_sr = 10, too_much.l = 1;
  EXPECT_THROW(SurfaceBsdf(too_much, 550, 1, 1.5), InputError);
  EXPECT_EQ(parse_scatter_table("# by a goniometer\nangle_deg,bsdf_per_sr\n1,0.1\n10,1e-3\n", "t.csv").size(),
            2U);
  for (const char* wrong :
       {"", "angle,bsdf\n1,2\n", "angle_deg,bsdf_per_sr\n", "angle_deg,bsdf_per_sr\n1,0.1\n",
        "angle_deg,bsdf_per_sr\n1\n2,3\n", "angle_deg,bsdf_per_sr\n2,1\n1,1\n",
        "angle_deg,bsdf_per_sr\n1,1\n91,1\n", "angle_deg,bsdf_per_sr\n1,1\n2,-1\n"})
    EXPECT_THROW(parse_scatter_table(wrong, "t.csv"), InputError) << wrong;
}

}  // namespace
}  // namespace petzval
