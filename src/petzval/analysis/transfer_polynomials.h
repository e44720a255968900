// SPDX-License-Identifier: BSD-3-Clause
// Polynomials that carry rays, fitted to samples by least squares.
#pragma once

#include <petzval/analysis/transfer_samples.h>

#include <array>
#include <vector>

namespace petzval {

/// Powers of r², of place times direction, and of the direction squared, as RayTransfer::terms has them.
using TransferPowers = std::array<int, 3>;
/// By wavelength, output and term, as RayTransfer::Band has the last two.
using TransferCoefficients = std::vector<std::vector<std::vector<double>>>;

std::vector<TransferPowers> powers_up_to(int degree);

/// The largest degree that twice as many equations as unknowns are there for.
int most_degree_for(const TransferSamples& samples);

/// The coefficients of each band. The first term is 1; where the first order is known, it is kept, and its
/// determinant is 1 anyway. \throws InputError if the rays do not tell the first order.
TransferCoefficients fitted_bands(const TransferSamples& samples, const std::vector<TransferPowers>& terms);

/// Of each ray that was held out, in front of the lens.
struct TransferErrors {
  std::vector<double> mm, rad;

  bool within(double most_mm, double most_rad) const;
};
TransferErrors errors_of(const TransferSamples& samples, const std::vector<TransferPowers>& terms,
                         const TransferCoefficients& bands);

/// Terms that move some ray by more than a small share of the tolerance.
std::vector<TransferPowers> needed_terms(const TransferSamples& samples,
                                         const std::vector<TransferPowers>& terms,
                                         const TransferCoefficients& bands, double mm, double rad);

}  // namespace petzval
