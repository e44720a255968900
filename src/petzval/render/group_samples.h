// SPDX-License-Identifier: BSD-3-Clause
// The random numbers of one group of wavelengths.
#pragma once

#include <petzval/numeric/sobol.h>
#include <petzval/render/world.h>

#include <cstdint>

namespace petzval::render {

/// What the samples of a group are made from. Groups share their seeds and fill each other's gaps: light of
/// all wavelengths is then as even as if one group had the samples of all.
struct GroupSamples {
  std::uint32_t stream = 0;  ///< to be hashed with the pixel
  const DigitalShifts* shifts = &digital_shifts(0, 1);

  /// \param part  tells samples apart that are to be independent.
  static GroupSamples of(const WavelengthGroups& groups, int group, std::uint64_t seed,
                         std::uint32_t part = 0) {
    const auto apart = static_cast<std::uint32_t>(group / most_shifted_sets) ^ part << 16;
    return {hashed(static_cast<std::uint32_t>(seed),
                   static_cast<std::uint32_t>(seed >> 32) ^ apart * 0x9e3779b9u),
            &digital_shifts(group, groups.count())};
  }
};

}  // namespace petzval::render
