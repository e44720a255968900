// SPDX-License-Identifier: BSD-3-Clause
// Quadrature rules.
#pragma once

#include <vector>

namespace petzval {

struct QuadratureRule {
  std::vector<double> nodes, weights;
};

/// Gauss-Legendre rule of n ≥ 1 nodes on [from, to]: exact for polynomials of degree 2n − 1. Nodes by
/// Newton's method on the three-term recurrence, to rounding. \throws InputError for n < 1.
QuadratureRule gauss_legendre(int n, double from = 0, double to = 1);

}  // namespace petzval
