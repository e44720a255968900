// SPDX-License-Identifier: BSD-3-Clause
// What is wrong with a ray transfer.
#pragma once

#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/transfer_data.h>

#include <cstddef>

namespace petzval {

/// Folds and starts are sought on rays of so many places and about so many squared directions.
inline constexpr std::size_t check_radii = 9, check_across = 9;

/// \throws InputError for numbers that no ray transfer has: lengths, terms, wavelengths, coefficients,
/// ellipses.
void require_sound(const RayTransfer& transfer);
/// \throws InputError where the polynomials of a wavelength fold, or let no ray pass.
void require_unfolded(const RayTransfer& transfer, const TransferData<double>& data, double nm);

}  // namespace petzval
