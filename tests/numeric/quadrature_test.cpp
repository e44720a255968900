// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/numeric/quadrature.h>

#include <cmath>

namespace petzval {
namespace {

TEST(GaussLegendre, IntegratesItsPolynomialsExactly) {
  // Degree 2n − 1 is exact (Gauss 1814); the tolerance is rounding.
  for (const int n : {1, 2, 3, 7, 24, 64, 200}) {
    const QuadratureRule rule = gauss_legendre(n);
    for (const int power : {0, 1, n, 2 * n - 1}) {
      double sum = 0;
      for (std::size_t i = 0; i < rule.nodes.size(); ++i)
        sum += rule.weights[i] * std::pow(rule.nodes[i], power);
      EXPECT_NEAR(sum, 1.0 / (power + 1), 2e-14) << "n " << n << " power " << power;
    }
  }
}

TEST(GaussLegendre, MissesTheNextDegree) {
  const QuadratureRule rule = gauss_legendre(2);
  double sum = 0;
  for (std::size_t i = 0; i < 2; ++i) sum += rule.weights[i] * std::pow(rule.nodes[i], 4);
  EXPECT_GT(std::abs(sum - 0.2), 1e-3);
}

TEST(GaussLegendre, KnowsTheThreePointRule) {
  const QuadratureRule rule = gauss_legendre(3, -1, 1);
  EXPECT_NEAR(rule.nodes[0], -std::sqrt(0.6), 1e-15);
  EXPECT_NEAR(rule.nodes[1], 0, 1e-15);
  EXPECT_NEAR(rule.weights[1], 8.0 / 9, 1e-15);
  EXPECT_NEAR(rule.weights[2], 5.0 / 9, 1e-15);
}

TEST(GaussLegendre, RefusesNoNodes) {
  EXPECT_THROW(gauss_legendre(0), InputError);
}

}  // namespace
}  // namespace petzval
