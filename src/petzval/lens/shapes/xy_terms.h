// SPDX-License-Identifier: BSD-3-Clause
// Polynomials of x and y for freeform surfaces.
#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace petzval {

/// Powers of x and of y → coefficient.
using XyTerms = std::map<std::pair<int, int>, double>;

/// Up to degree 20, as files of other programs have them.
inline constexpr std::size_t most_xy_terms = 230;
/// Zernike polynomials up to degree 20.
inline constexpr std::size_t most_zernike_sag_terms = 231;

/// In the order x, y, x², xy, y², x³, ….
XyTerms xy_terms_of_list(const std::vector<double>& coefficients);
/// Σ A_j Z_j, j from 1 in Noll's order.
XyTerms xy_terms_of_zernike(const std::vector<double>& coefficients);
/// What on_conic_with_xy() reads: 1/R, then for each power of x from the highest the coefficients of the
/// powers of y from the highest that the degree allows.
std::vector<double> packed_xy_terms(double radius_mm, const XyTerms& terms);

}  // namespace petzval
