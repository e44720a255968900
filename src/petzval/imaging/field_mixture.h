// SPDX-License-Identifier: BSD-3-Clause
// How much of each field of a table goes into what lies between fields.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace petzval {

/// What one field of a table contributes.
struct FieldShare {
  std::size_t field = 0;
  double weight = 0;
  bool across_axis = false;  ///< of the field mirrored at the axis: turned by 180°
};

/// The four fields about a height, weighted by the cubic whose slopes at the fields are those of the parabola
/// through three of them (Keys, IEEE Trans. Acoust. Speech Signal Process. 29 (1981) 1153, for even spacing):
/// fields are met, parabolas are followed, and the first derivative has no jump at a field. A jump in how
/// PSFs change would be seen on a wall as a ring. The weights sum to 1; the outer two are negative, −2/27 at
/// most where fields are evenly spaced. A table that begins on the axis goes on beyond it, turned by 180°;
/// where there is no further field, the parabola ends with the last three. Beyond the last field that one
/// holds, and before the first.
///
/// \param height_mm  of the fields, increasing; at least one.
std::array<FieldShare, 4> field_shares(std::span<const double> height_mm, double at_mm);

}  // namespace petzval
