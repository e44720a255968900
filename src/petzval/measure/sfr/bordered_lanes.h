// SPDX-License-Identifier: BSD-3-Clause
// What is done with a bordered band and eight vectors at once, on whatever SIMD the machine has.
#pragma once

namespace petzval {

/// The entries of a BorderedBand, column by column.
struct BorderedEntries {
  const double* entries;
  int band, border;
};

/// Solves L Lᵀ x = right in place. \param per_diagonal  reciprocals of the factor's diagonal. \param x  rows
/// of eight.
void solve_eight(const BorderedEntries& factor, const double* per_diagonal, double* x);

/// xᵀ M x of each vector. \param x  rows of eight. \param results  eight.
void quadratic_of_eight(const BorderedEntries& matrix, const double* x, double* results);

}  // namespace petzval
