// SPDX-License-Identifier: BSD-3-Clause
// The random numbers of many places at once, in SIMD lanes.
#pragma once

#include <cstdint>
#include <span>

namespace petzval {

/// The first two uniform numbers of RandomStream(seed, purpose, place + i), for each i; the same bits.
/// \param second  as long as `first`, or empty if it is not wanted.
void uniform_numbers(std::uint64_t seed, std::uint32_t purpose, std::uint64_t place, std::span<double> first,
                     std::span<double> second);

/// normal_quantile() of each, in its place; to a few units in the last place.
void to_normal(std::span<double> probabilities);

/// RandomStream(seed, purpose, place + i).poisson(means[i]), for each i. `means` and `numbers` are of one
/// length. \throws InputError as RandomStream::poisson.
void poisson_numbers(std::uint64_t seed, std::uint32_t purpose, std::uint64_t place,
                     std::span<const double> means, std::span<double> numbers);

}  // namespace petzval
