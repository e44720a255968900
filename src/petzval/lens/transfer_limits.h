// SPDX-License-Identifier: BSD-3-Clause
// How large a ray transfer can be.
#pragma once

#include <cstddef>

namespace petzval {

/// Terms with those that they are made of.
constexpr std::size_t most_transfer_terms = 512;
/// Powers of a ray's length.
constexpr std::size_t most_transfer_degree = 24;
constexpr std::size_t most_transfer_apertures = 7;
constexpr std::size_t most_transfer_bands = 64;
/// Nodes of the integral over a pupil that gives optical paths: exact for terms of the fifteenth degree.
constexpr std::size_t transfer_path_nodes = 8;
/// Turns of the iteration that inverts it.
constexpr int most_transfer_turns = 60;
/// Beyond so many radii of the stop, squared, polynomials say nothing any more.
constexpr double transfer_reach_sq = 4;
/// The inverse is found if it misses by no more than this many times what it may.
constexpr double transfer_found_within = 8;
/// Rays at a rim exactly are not lost to rounding.
constexpr double transfer_rim = 1 + 1e-9;

}  // namespace petzval
