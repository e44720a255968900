// SPDX-License-Identifier: BSD-3-Clause
// Point spread and transfer of round pupils against other methods: Nijboer's expansion, closed forms, a
// Hankel transform.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/wave/otf.h>
#include <petzval/wave/radial_pupil.h>

#include <boost/math/special_functions/bessel.hpp>
#include <cmath>
#include <complex>

namespace petzval {
namespace {

/// Nijboer (1942): exp(2πiW) = Σ β_n P_n(2t − 1), t = ρ², and ∫ P_n(2ρ² − 1) J0(vρ) ρ dρ = (−1)^n
/// J_{2n+1}(v)/v. The coefficients come from a quadrature in t that never meets the oscillation of J0.
std::vector<std::complex<double>> nijboer_coefficients(const RadialPupil& pupil) {
  constexpr int terms = 400;
  const QuadratureRule rule = gauss_legendre(900);
  std::vector<std::complex<double>> beta(terms);
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double t = rule.nodes[i], x = 2 * t - 1;
    double w = 0, power = 1;
    for (const double coefficient : pupil.w_waves) w += coefficient * (power *= t);
    const std::complex<double> value = rule.weights[i] * std::polar(1.0, 2 * pi * w);
    double previous = 0, legendre = 1;
    for (int n = 0; n < terms; ++n) {
      beta[static_cast<std::size_t>(n)] += (2.0 * n + 1) * legendre * value;
      const double next = ((2 * n + 1) * x * legendre - n * previous) / (n + 1);
      previous = legendre;
      legendre = next;
    }
  }
  return beta;
}

double nijboer_psf(const std::vector<std::complex<double>>& beta, double r) {
  const double v = pi * r;
  std::complex<double> sum = 0;
  for (std::size_t n = 0; n < beta.size(); ++n)
    sum +=
        (n % 2 == 0 ? 1.0 : -1.0) * beta[n] * boost::math::cyl_bessel_j(2 * static_cast<int>(n) + 1, v) / v;
  return std::norm(2.0 * sum);
}

TEST(RadialPsf, AgreesWithNijboersExpansionOutTo120LambdaN) {
  const std::vector<double> r{0.01, 0.3, 1.0, 1.22, 2.5, 7.7, 20, 41.3, 77, 100.5, 119.9, 120};
  for (const auto& w : std::vector<std::vector<double>>{
           {0, 0}, {1, 0}, {0, 0.75}, {2, -2}, {-2, 2}, {0, 2}, {10, 0}, {10, 20}, {1, -2, 3}}) {
    const RadialPupil pupil{w, 0};
    const std::vector<double> psf = radial_psf(pupil, r);
    const auto beta = nijboer_coefficients(pupil);
    for (std::size_t i = 0; i < r.size(); ++i)
      EXPECT_NEAR(psf[i], nijboer_psf(beta, r[i]), 1e-10) << w[0] << " r " << r[i];
  }
}

TEST(RadialPsf, ReducesToTheAiryPattern) {
  const std::vector<double> r{1e-6, 0.5, 1.2196698912665045, 3.2, 60, 120};
  const std::vector<double> psf = radial_psf({}, r);
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double v = pi * r[i], airy = 2 * boost::math::cyl_bessel_j(1, v) / v;
    EXPECT_NEAR(psf[i], airy * airy, 1e-13);
  }
  EXPECT_LT(psf[2], 1e-28) << "the first dark ring, 1.21967 lambda N";
}

TEST(RadialPsf, OnAxisDefocusIsSincSquared) {
  for (const double w : {0.1, 0.5, 1.0, 1.5, 7.3}) {
    const double expected = std::sin(pi * w) / (pi * w);
    EXPECT_NEAR(radial_psf({{w}, 0}, std::vector<double>{0})[0], expected * expected, 1e-13);
  }
}

TEST(RadialPsf, LargeDefocusTendsToTheGeometricDisc) {
  // W020 = 40: a disc of radius 4·40 = 160 λN. Light inside 0.5 of the radius is 1/4 of all; the edge of the
  // disc is soft over about √(8·40) λN, so that half-way in only diffraction rings of 1/√W remain: 2 %.
  const RadialPupil pupil{{40}, 0};
  EXPECT_NEAR(geometric_radius(pupil), 160, 1e-9);
  const auto light_within = [&](double radius) {
    const QuadratureRule rule = gauss_legendre(600, 0, radius);
    const std::vector<double> psf = radial_psf(pupil, rule.nodes);
    double sum = 0;
    for (std::size_t i = 0; i < psf.size(); ++i)
      sum += rule.weights[i] * 2 * pi * rule.nodes[i] * psf[i] * pi / 4;
    return sum;
  };
  EXPECT_NEAR(light_within(80), 0.25, 0.02 * 0.25);
  EXPECT_NEAR(light_within(120), 0.5625, 0.02 * 0.5625);
  EXPECT_GT(light_within(175), 0.99);
}

TEST(RadialOtf, OfAClearPupilIsTheChordFormula) {
  for (const double s : {0.0, 1e-6, 0.1, 0.5, 0.9, 0.9999, 1.0, 1.7}) {
    const double expected = s < 1 ? 2 / pi * (std::acos(s) - s * std::sqrt(1 - s * s)) : 0;
    EXPECT_NEAR(radial_otf({}, std::vector<double>{s})[0], expected, 1e-12);
  }
}

TEST(RadialOtf, OfAnAnnulusFollowsItsOverlapAreas) {
  // Areas of lenses of two circles, by the textbook formula.
  const auto lens = [](double a, double b, double d) {
    if (d >= a + b) return 0.0;
    if (d <= std::abs(a - b)) return pi * std::min(a, b) * std::min(a, b);
    const double x = (d * d + a * a - b * b) / (2 * d);
    return a * a * std::acos(x / a) + b * b * std::acos((d - x) / b) - d * std::sqrt(a * a - x * x);
  };
  for (const double e : {0.2, 0.33, 0.5, 0.8})
    for (const double s : {0.05, 0.11, 0.26, 0.36, 0.45, 0.6, 0.72, 0.95}) {
      const double expected =
          (lens(1, 1, 2 * s) - 2 * lens(1, e, 2 * s) + lens(e, e, 2 * s)) / (pi * (1 - e * e));
      EXPECT_NEAR(radial_otf({{}, e}, std::vector<double>{s})[0], expected, 1e-12) << e << " " << s;
    }
}

TEST(RadialOtf, OfDefocusAgreesWithStokseths1DIntegral) {
  // H. H. Hopkins 1955, eq. 20: for pure defocus the overlap integral over strips is elementary in one
  // direction; what is left is ∫ √(1 − (x + s)²) cos(8πW s x) dx, done here with sin-substitution and 2000
  // trapezia.
  for (const double w : {0.5, 2.0, 10.0})
    for (const double s : {0.03, 0.2, 0.5, 0.8}) {
      double sum = 0;
      constexpr int n = 20000;
      for (int i = 0; i < n; ++i) {
        const double theta = std::acos(s) * (i + 0.5) / n;  // x + s = cos θ
        sum += std::sin(theta) * std::sin(theta) * std::cos(8 * pi * w * s * (std::cos(theta) - s));
      }
      const double expected = 4 / pi * sum * std::acos(s) / n;
      EXPECT_NEAR(radial_otf({{w}, 0}, std::vector<double>{s})[0], expected, 2e-8)
          << "midpoint rule of 20000 steps";
    }
}

TEST(RadialOtf, IsTheHankelTransformOfThePsf) {
  // OTF → PSF at a point: PSF(r) = ∫ OTF(ν) J0(2πνr) 2πν dν, ν in 1/λN; times 4/π it is 1 for an Airy peak.
  for (const RadialPupil& pupil :
       {RadialPupil{{2, -2}, 0}, RadialPupil{{0, 2}, 0}, RadialPupil{{0.5, 0, 1}, 0.4}}) {
    const double area = 1 - pupil.obstruction * pupil.obstruction;
    for (const double r : {0.0, 1.0, 3.3, 12.0}) {
      double sum = 0;
      const double e = pupil.obstruction;
      std::vector<double> breaks{0, e, 0.5 * (1 - e), 0.5 * (1 + e), 1};
      std::sort(breaks.begin(), breaks.end());
      for (std::size_t b = 0; b + 1 < breaks.size(); ++b) {
        if (breaks[b + 1] <= breaks[b]) continue;
        const QuadratureRule rule = gauss_legendre(200, breaks[b], breaks[b + 1]);
        const std::vector<double> otf = radial_otf(pupil, rule.nodes);
        for (std::size_t i = 0; i < otf.size(); ++i)
          sum += rule.weights[i] * otf[i] * 2 * pi * rule.nodes[i] *
                 boost::math::cyl_bessel_j(0, 2 * pi * rule.nodes[i] * r);
      }
      // Gauss-Legendre against end points of the 3/2 power: 1e-8.
      EXPECT_NEAR(sum * 4 / (pi * area), radial_psf(pupil, std::vector<double>{r})[0], 2e-8);
    }
  }
}

TEST(RadialOtf, TableAgreesWithDirectQuadrature) {
  for (const RadialPupil& pupil :
       {RadialPupil{}, RadialPupil{{2, -2}, 0}, RadialPupil{{10, 20}, 0}, RadialPupil{{0, 1}, 0.35}}) {
    const int count = 997;
    const std::vector<double> table = radial_otf_table(pupil, count);
    for (const int i : {1, 5, 99, 350, 351, 500, 673, 900, 996})
      EXPECT_NEAR(table[static_cast<std::size_t>(i)], radial_otf(pupil, std::vector<double>{i / 997.0})[0],
                  1e-11)
          << i;
  }
}

TEST(RadialTail, IsTheMeanOfThePsfFarAway) {
  for (const RadialPupil& pupil :
       {RadialPupil{}, RadialPupil{{1}, 0}, RadialPupil{{2, -2}, 0}, RadialPupil{{0.5}, 0.3}}) {
    // Mean of r³ PSF over many ripples about r = 100 λN; what is left of the ripple after 40 periods and the
    // next term (blur/r)⁴ are below 1e-3.
    const RadialTail tail = radial_tail(pupil);
    double mean = 0, expected = 0;
    const double area = 1 - pupil.obstruction * pupil.obstruction;
    std::vector<double> r;
    constexpr int n = 8000;
    for (int i = 0; i < n; ++i) r.push_back(80 + 40 * (i + 0.5) / n);
    const std::vector<double> psf = radial_psf(pupil, r);
    for (int i = 0; i < n; ++i) {
      const double each = r[static_cast<std::size_t>(i)];
      mean += psf[static_cast<std::size_t>(i)] * area * pi / 4 * each * each * each / n;
      expected += (tail.k3 + tail.k5 / (each * each)) / n;
    }
    EXPECT_NEAR(mean, expected, 2e-3 * expected);
  }
}

TEST(RadialPupil, RefusesWhatIsNoPupil) {
  EXPECT_THROW(radial_psf({{NAN}, 0}, std::vector<double>{1}), InputError);
  EXPECT_THROW(radial_psf({{1e9}, 0}, std::vector<double>{1}), InputError);
  EXPECT_THROW(radial_psf({{}, 1.0}, std::vector<double>{1}), InputError);
  EXPECT_THROW(radial_psf({}, std::vector<double>{INFINITY}), InputError);
  EXPECT_THROW(radial_pupil_otf({}, 550, 0), InputError);
  EXPECT_THROW(radial_pupil_otf({}, -1, 8), InputError);
}

}  // namespace
}  // namespace petzval
