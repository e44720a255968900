// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/wave/zernike.h>

#include <cmath>
#include <functional>
#include <vector>

namespace petzval {
namespace {

/// Points over the disc, or the part of it that `inside` keeps, with weights that are areas over π.
struct DiscPoints {
  std::vector<double> x, y, weight;

  explicit DiscPoints(
      int radial, int azimuths,
      const std::function<bool(double, double)>& inside = [](double, double) { return true; }) {
    const QuadratureRule rule = gauss_legendre(radial);
    for (int i = 0; i < radial; ++i)
      for (int k = 0; k < azimuths; ++k) {
        const double theta = 2 * pi * k / azimuths, r = rule.nodes[static_cast<std::size_t>(i)];
        if (!inside(r * std::cos(theta), r * std::sin(theta))) continue;
        x.push_back(r * std::cos(theta));
        y.push_back(r * std::sin(theta));
        weight.push_back(rule.weights[static_cast<std::size_t>(i)] * r * 2 / azimuths);
      }
  }
};

TEST(Zernike, NollTableOfThePaper) {
  // Noll (1976), table I: Z1 … Z11 in polar form.
  const double r = 0.7, t = 0.4, x = r * std::cos(t), y = r * std::sin(t);
  const double table[] = {1,
                          2 * r * std::cos(t),
                          2 * r * std::sin(t),
                          std::sqrt(3) * (2 * r * r - 1),
                          std::sqrt(6) * r * r * std::sin(2 * t),
                          std::sqrt(6) * r * r * std::cos(2 * t),
                          std::sqrt(8) * (3 * r * r * r - 2 * r) * std::sin(t),
                          std::sqrt(8) * (3 * r * r * r - 2 * r) * std::cos(t),
                          std::sqrt(8) * r * r * r * std::sin(3 * t),
                          std::sqrt(8) * r * r * r * std::cos(3 * t),
                          std::sqrt(5) * (6 * std::pow(r, 4) - 6 * r * r + 1)};
  for (int j = 1; j <= 11; ++j)
    EXPECT_NEAR(zernike(ZernikeOrder::noll, j, x, y), table[j - 1], 1e-14) << j;  // rounding
}

TEST(Zernike, NollOrderingOfHigherTerms) {
  // The same table's rows of n and m, to j = 22, and the first of the next row.
  EXPECT_EQ(zernike_term(ZernikeOrder::noll, 12), (ZernikeTerm{4, 2}));
  EXPECT_EQ(zernike_term(ZernikeOrder::noll, 13), (ZernikeTerm{4, -2}));
  EXPECT_EQ(zernike_term(ZernikeOrder::noll, 14), (ZernikeTerm{4, 4}));
  EXPECT_EQ(zernike_term(ZernikeOrder::noll, 15), (ZernikeTerm{4, -4}));
  EXPECT_EQ(zernike_term(ZernikeOrder::noll, 16), (ZernikeTerm{5, 1}));
  EXPECT_EQ(zernike_term(ZernikeOrder::noll, 17), (ZernikeTerm{5, -1}));
  EXPECT_EQ(zernike_term(ZernikeOrder::noll, 21), (ZernikeTerm{5, -5}));
  EXPECT_EQ(zernike_term(ZernikeOrder::noll, 22), (ZernikeTerm{6, 0}));
}

TEST(Zernike, FringeTable) {
  // The published list of the Fringe set, as polynomials: 1-9, 16, 25, 36, 37.
  const double r = 0.83, t = -1.1, x = r * std::cos(t), y = r * std::sin(t), q = r * r;
  const auto value = [&](int j) { return zernike(ZernikeOrder::fringe, j, x, y); };
  const double tolerance = 1e-13;  // rounding of terms of size 1e3 with cancellation
  EXPECT_NEAR(value(2), r * std::cos(t), tolerance);
  EXPECT_NEAR(value(3), r * std::sin(t), tolerance);
  EXPECT_NEAR(value(4), 2 * q - 1, tolerance);
  EXPECT_NEAR(value(5), q * std::cos(2 * t), tolerance);
  EXPECT_NEAR(value(6), q * std::sin(2 * t), tolerance);
  EXPECT_NEAR(value(7), (3 * q - 2) * r * std::cos(t), tolerance);
  EXPECT_NEAR(value(8), (3 * q - 2) * r * std::sin(t), tolerance);
  EXPECT_NEAR(value(9), 6 * q * q - 6 * q + 1, tolerance);
  EXPECT_NEAR(value(10), r * q * std::cos(3 * t), tolerance);
  EXPECT_NEAR(value(12), (4 * q - 3) * q * std::cos(2 * t), tolerance);
  EXPECT_NEAR(value(15), (10 * q * q - 12 * q + 3) * r * std::sin(t), tolerance);
  EXPECT_NEAR(value(16), 20 * q * q * q - 30 * q * q + 12 * q - 1, tolerance);
  EXPECT_NEAR(value(25), 70 * std::pow(q, 4) - 140 * std::pow(q, 3) + 90 * q * q - 20 * q + 1, tolerance);
  EXPECT_NEAR(value(36),
              252 * std::pow(q, 5) - 630 * std::pow(q, 4) + 560 * std::pow(q, 3) - 210 * q * q + 30 * q - 1,
              tolerance);
  EXPECT_NEAR(value(37),
              924 * std::pow(q, 6) - 2772 * std::pow(q, 5) + 3150 * std::pow(q, 4) - 1680 * std::pow(q, 3) +
                  420 * q * q - 42 * q + 1,
              1e-12);
}

TEST(Zernike, NollTermsAreOrthonormal) {
  // Products of two terms of degree ≤ 8 are polynomials: 9 nodes in r² dr and 20 azimuths are exact.
  const DiscPoints disc(12, 40);
  for (int i = 1; i <= 45; ++i)
    for (int j = 1; j <= i; ++j) {
      double product = 0;
      for (std::size_t k = 0; k < disc.x.size(); ++k)
        product += disc.weight[k] * zernike(ZernikeOrder::noll, i, disc.x[k], disc.y[k]) *
                   zernike(ZernikeOrder::noll, j, disc.x[k], disc.y[k]);
      EXPECT_NEAR(product, i == j ? 1 : 0, 1e-12) << i << ", " << j;
    }
}

TEST(Zernike, RadialPolynomialsKeepTheirDigitsAtHighOrder) {
  // R_n^0 = P_{n/2}(2ρ² − 1), and |R| ≤ 1 on the disc; the explicit sum has lost all digits at n = 60.
  for (const double rho : {0.0, 0.1, 0.45, 0.8, 0.99, 1.0}) {
    EXPECT_NEAR(zernike_radial(60, 0, rho), std::legendre(30, 2 * rho * rho - 1), 1e-12);
    EXPECT_LE(std::abs(zernike_radial(81, 7, rho)), 1 + 1e-12);
  }
  for (const int m : {0, 2, 10, 60}) EXPECT_NEAR(zernike_radial(60, m, 1), 1, 1e-12);
}

/// A fit of known coefficients gives them back, whatever part of the disc is there.
void expect_recovered(ZernikeOrder order, const DiscPoints& points, double tolerance) {
  std::vector<double> known;
  for (int j = 0; j < 28; ++j) known.push_back(std::sin(1.7 * j) / (1 + j));
  std::vector<double> values;
  for (std::size_t k = 0; k < points.x.size(); ++k)
    values.push_back(zernike_sum(order, known, points.x[k], points.y[k]));
  const ZernikeFit fit = fit_zernike(order, 28, points.x, points.y, values, points.weight);
  for (std::size_t j = 0; j < known.size(); ++j) EXPECT_NEAR(fit.coefficients[j], known[j], tolerance) << j;
  EXPECT_LT(fit.rms_residual, 1e-13);
}

TEST(ZernikeFit, RecoversCoefficients) {
  for (const ZernikeOrder order : {ZernikeOrder::noll, ZernikeOrder::fringe}) {
    expect_recovered(order, DiscPoints(12, 40), 1e-12);
    // A cat's eye, where the polynomials are no longer orthogonal: the condition of the fit costs digits.
    const auto cats_eye = [](double x, double y) { return std::hypot(x, y - 0.5) < 1; };
    expect_recovered(order, DiscPoints(24, 80, cats_eye), 1e-9);
  }
}

TEST(ZernikeFit, CoefficientsOfAFullPupilDoNotDependOnTheNumberOfTerms) {
  const DiscPoints disc(16, 48);
  std::vector<double> values;
  for (std::size_t k = 0; k < disc.x.size(); ++k)
    values.push_back(std::exp(disc.x[k] - 0.5 * disc.y[k] * disc.y[k]));
  const ZernikeFit few = fit_zernike(ZernikeOrder::noll, 6, disc.x, disc.y, values, disc.weight),
                   many = fit_zernike(ZernikeOrder::noll, 28, disc.x, disc.y, values, disc.weight);
  double variance = 0, explained = 0, mean = 0;
  for (std::size_t k = 0; k < values.size(); ++k) mean += disc.weight[k] * values[k];
  for (std::size_t k = 0; k < values.size(); ++k) variance += disc.weight[k] * std::pow(values[k] - mean, 2);
  for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR(few.coefficients[j], many.coefficients[j], 1e-12);
  for (std::size_t j = 1; j < 28; ++j) explained += std::pow(many.coefficients[j], 2);
  // Parseval: what the terms do not explain is left.
  EXPECT_NEAR(explained + std::pow(many.rms_residual, 2), variance, 1e-12);
}

TEST(ZernikeFit, RefusesWhatItCannotFit) {
  const DiscPoints disc(4, 8);
  const std::vector<double> values(disc.x.size(), 1.0);
  const auto fit = [&](int terms) {
    return fit_zernike(ZernikeOrder::fringe, terms, disc.x, disc.y, values, disc.weight);
  };
  EXPECT_THROW(fit(0), InputError);
  EXPECT_THROW(fit(38), InputError);
  EXPECT_THROW(fit(33), InputError);  // more terms than points
  EXPECT_THROW(fit(30), InputError);  // cos 4θ and sin 4θ: eight azimuths cannot tell all apart
  EXPECT_NO_THROW(fit(9));
  EXPECT_THROW(zernike_term(ZernikeOrder::noll, 0), InputError);
}

TEST(Zernike, NamesAreThoseOfTheTextbooks) {
  const auto name = [](int j) { return zernike_name(zernike_term(ZernikeOrder::fringe, j)); };
  EXPECT_EQ(name(1), "piston");
  EXPECT_EQ(name(3), "tilt y");
  EXPECT_EQ(name(4), "defocus");
  EXPECT_EQ(name(5), "astigmatism 0°");
  EXPECT_EQ(name(8), "coma y");
  EXPECT_EQ(name(9), "spherical");
  EXPECT_EQ(name(15), "secondary coma y");
  EXPECT_EQ(name(16), "secondary spherical");
  EXPECT_EQ(name(25), "tertiary spherical");
  EXPECT_EQ(name(36), "Z(10, 0)");
}

}  // namespace
}  // namespace petzval
