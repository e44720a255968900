// SPDX-License-Identifier: BSD-3-Clause
// Charge that does not fit into its pixel.
#pragma once

#include <span>

namespace petzval {

/// What a pixel of a charge-coupled device cannot hold flows along its column, half of it each way, into the
/// next pixels that have room, and leaves the sensor at the ends of the column. No charge is lost otherwise.
/// \param electrons  of the pixels of one column, in order. \param capacity_e  of each: what its well and its
/// drain take.
void bloom_column(std::span<double> electrons, double capacity_e);

}  // namespace petzval
