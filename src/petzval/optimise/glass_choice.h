// SPDX-License-Identifier: BSD-3-Clause
// Which glasses could stand in a lens's place of another.
#pragma once

#include <petzval/lens/lens.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace petzval {

/// How far apart two glasses are: √(Δnd² + 10⁻⁴ ΔVd²), so that 0.01 of nd counts as much as 1 of Vd.
double glass_distance(const AbbeNumbers& a, const AbbeNumbers& b);

/// The glasses of the same maker that are nearest to this one, itself not among them, the nearest first; of
/// equally near ones in the order of their names. Fewer than `count` where the maker has no more that are
/// valid at all wavelengths. Needs a glass whose range holds the lines F, d and C; else none.
std::vector<std::shared_ptr<const Glass>> nearest_glasses(const Glass& glass, std::size_t count,
                                                          const std::vector<double>& wavelengths_nm);

/// The glass of a catalogue that follows a surface; null for air and for materials of other kinds.
std::shared_ptr<const Glass> catalogue_glass(const Lens& lens, std::size_t surface);

}  // namespace petzval
