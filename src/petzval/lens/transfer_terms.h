// SPDX-License-Identifier: BSD-3-Clause
// The terms of a ray transfer's polynomials.
#pragma once

#include <petzval/lens/ray_transfer.h>

#include <array>
#include <cstddef>
#include <vector>

namespace petzval {

using TransferPowers = std::array<int, 3>;

/// The degree, in place and direction of a ray, of what a term stands for.
int output_degree(TransferVariables variables, const TransferPowers& powers);
/// The powers with all that they are made of, by degree.
std::vector<TransferPowers> closed(const std::vector<TransferPowers>& terms);
/// How many polynomials there are: place and direction, and two for each aperture unless ellipses stand for
/// them.
std::size_t outputs_of(const RayTransfer& transfer);

}  // namespace petzval
