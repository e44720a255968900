// SPDX-License-Identifier: BSD-3-Clause
// What is done with a bordered band and eight vectors at once, on whatever SIMD the machine has.
#pragma once

namespace petzval {

/// The entries of a BorderedBand, column by column.
struct BorderedEntries {
  const double* entries;
  int band, border;
};

/// Takes a matrix to its Cholesky factor in place. Of the border's corner the upper half is written, too, and
/// not used. \param per_diagonal  becomes the reciprocals of the factor's diagonal. \returns whether the
/// matrix is positive definite.
bool factor_in_place(double* entries, int band, int border, double* per_diagonal);

/// Solves L Lᵀ x = right in place. \param per_diagonal  reciprocals of the factor's diagonal. \param x  rows
/// of eight.
void solve_eight(const BorderedEntries& factor, const double* per_diagonal, double* x);

/// The inverse of L Lᵀ where the pattern has entries, into entries of the same pattern. \param per_diagonal
/// reciprocals of the factor's diagonal.
void invert(const BorderedEntries& factor, const double* per_diagonal, double* inverse);

/// xᵀ M x of each vector. \param x  rows of eight. \param results  eight.
void quadratic_of_eight(const BorderedEntries& matrix, const double* x, double* results);

}  // namespace petzval
