// SPDX-License-Identifier: BSD-3-Clause
// The fields of a centred lens whose PSFs an image needs.
#pragma once

#include <petzval/imaging/spread_wanted.h>
#include <petzval/optics/build.h>

#include <cstddef>
#include <vector>

namespace petzval {

/// What build_image_table() says of places by height.
struct ChosenFields {
  std::vector<std::size_t> fields;  ///< increasing, the first and the last among them
  double error = 0;                 ///< LensDataTable::interpolation_error
};

/// Adds PSFs to `parts` at the wavelengths by which it chooses; of those, only PSFs of chosen fields stay.
/// \param options  of `parts`. \param finer  every so many fields there is one that was asked for; where the
/// image turns back inwards, there is no choice of others.
ChosenFields choose_fields(HeightTable& parts, const TableOptions& options, std::size_t finer,
                           const SpreadWanted& wanted, const ProgressCallback& progress);

/// The fewest fields among which there is a choice.
inline constexpr int fewest_to_choose = 7;

}  // namespace petzval
