// SPDX-License-Identifier: BSD-3-Clause
// The surfaces of a .zmx file.
#pragma once

#include <petzval/lens/formats/glass_lookup.h>
#include <petzval/lens/formats/zmx_records.h>
#include <petzval/lens/lens_file.h>

#include <string>
#include <vector>

namespace petzval {

struct ZmxContext {
  const ZmxFile& file;
  GlassLookup& glasses;
  double mm_per_unit = 1;
  std::vector<std::string> catalogues;  ///< in the file's order
  std::vector<std::string>& notes;
};

/// Surfaces 1 to the last but one, with the thickness that reaches the image, and the poses that coordinate
/// breaks give them. The object's distance must be known.
void put_zmx_surfaces(const ZmxContext& context, Lens& lens);
/// The block that holds a surface of the lens: coordinate breaks are none.
std::size_t zmx_block_of(const ZmxFile& file, std::size_t surface);
/// From the object to surface 1; absent: infinity.
std::optional<double> zmx_object_distance_mm(const ZmxContext& context);
/// DIAM of the stop, automatic or not. \throws InputError if there is none.
double zmx_stop_semi_diameter_mm(const ZmxContext& context);

}  // namespace petzval
