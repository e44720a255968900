// SPDX-License-Identifier: BSD-3-Clause
// Sums of Chebyshev polynomials in two coordinates, on whatever SIMD the machine has.
#pragma once

#include <span>

namespace petzval {

/// Coefficients of T_i(x) T_j(y), for each i those of all j, the first of them `stride` apart.
struct ChebyshevTerms {
  static constexpr int most_across = 12;
  const double* coefficients;
  int along, across;  ///< at least one and two
  int stride;
};

/// Sums at (x[k], y[k]); coordinates beyond −1 to 1 are taken for these.
void chebyshev_sums(const ChebyshevTerms& terms, std::span<const double> x, std::span<const double> y,
                    std::span<double> sums);

}  // namespace petzval
