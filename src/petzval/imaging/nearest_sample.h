// SPDX-License-Identifier: BSD-3-Clause
// For every sample of a picture the nearest one of a kind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace petzval {

/// The index (row-major) of the nearest wanted sample to each sample, by Euclidean distance; of several as
/// near one. Exact, in time that grows with the number of samples (Felzenszwalb & Huttenlocher 2012, Theory
/// of Computing 8, 415: lower envelopes of parabolas, first down the columns, then along the rows). \param
/// wanted  columns × rows flags. \throws InputError if none is wanted, or there are 2^32 and more.
std::vector<std::uint32_t> nearest_samples(int columns, int rows, std::span<const std::uint8_t> wanted);

}  // namespace petzval
