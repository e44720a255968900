// SPDX-License-Identifier: BSD-3-Clause
// Which numbers of a lens an optimiser may alter, and how far.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/trace/ray_derivatives.h>

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// A number that varies between two limits, or without any.
struct LensVariable {
  LensNumber number;
  /// Of the number itself: of a radius the limits are those of its curvature [1/mm].
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();

  bool is_bounded() const { return low > -std::numeric_limits<double>::infinity(); }
};

/// What a text stands for:
///
/// | text | numbers | limits unless given |
/// |---|---|---|
/// | `radii` | of all curved surfaces | none |
/// | `thicknesses` | of all glass, at the centre | half to twice the present one |
/// | `gaps` | of air between surfaces | a tenth of the present one (at least 0.05 mm) to three times it |
/// | `image` | from the last surface to the sensor | none |
/// | `poses` | of all poses that are set and not 0 | none |
/// | `surfaces[3].radius_mm`, `….thickness_mm`, `….conic`, `….asphere.4` | that one | none |
/// | `surfaces[3].pose.tilt_x_deg`, `groups[0].pose.…`, `sensor_pose.…` | that one | none |
///
/// followed by `=LOW:HIGH` for limits in the unit of the number; a radius then keeps its sign. Gaps, glass
/// and the way to the sensor count along the light, also where mirrors throw it back. \throws InputError
/// saying what is wrong and what would be right.
std::vector<LensVariable> parse_lens_variables(const Lens& lens, std::string_view text);

/// "surfaces[3].radius_mm".
std::string name_of(const LensNumber& number);
/// The number as people give it: of a curvature the radius [mm].
double shown_value(const Lens& lens, const LensNumber& number);

}  // namespace petzval
