// SPDX-License-Identifier: BSD-3-Clause
// What is wrong with a lens, and where: so that a reader can add the line of its file.
#pragma once

#include <petzval/lens/lens.h>

#include <optional>
#include <string>

namespace petzval {

/// The powers of r that an asphere may have. The upper end keeps a polynomial a short table.
inline constexpr int lowest_asphere_power = 1, highest_asphere_power = 40;
/// More surfaces than any lens has, few enough that a ray can carry the number of one in 16 bits.
inline constexpr std::size_t most_surfaces = 10'000;

/// An entry of a lens by its path in the native format ("surfaces[4].thickness_mm") and what it must be.
struct LensFault {
  std::string path, message;
};

/// The first thing that is wrong with a lens; nothing if it is valid.
std::optional<LensFault> find_fault(const Lens& lens);

}  // namespace petzval
