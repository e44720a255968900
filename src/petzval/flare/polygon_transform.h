// SPDX-License-Identifier: BSD-3-Clause
// The Fourier transform of a polygon.
#pragma once

#include <array>
#include <complex>
#include <span>

namespace petzval {

/// Positive for corners that run anticlockwise (x to the right, y up).
double polygon_area(std::span<const std::array<double, 2>> corners);

/// ∬ exp(i q·r) over the inside of a polygon: the sum over its edges of what Gauss's theorem leaves (S. W.
/// Lee & R. Mittra, IEEE Trans. Antennas Propag. 31 (1983) 99). \param corners  anticlockwise. \param q  in
/// radians over the unit of the corners.
std::complex<double> polygon_transform(std::span<const std::array<double, 2>> corners,
                                       std::array<double, 2> q);

}  // namespace petzval
