// SPDX-License-Identifier: BSD-3-Clause
// Where in the picture it is to be sharp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// A rectangle of the film in fractions of its sides: 0 is left and top, 1 right and bottom of the upright
/// picture.
struct FocusZone {
  double left = 0, right = 1, top = 0, bottom = 1;

  double area() const { return (right - left) * (bottom - top); }
};

/// Reads the zones of a file: four numbers a line, left right top bottom, as the camera assignment of CS348B
/// (2006) has them; '#' begins a comment. \throws InputError with file and line unless 0 ≤ left < right ≤ 1
/// and 0 ≤ top < bottom ≤ 1, or if there is no zone.
std::vector<FocusZone> read_focus_zones(const std::string& path);
std::vector<FocusZone> parse_focus_zones(std::string_view text, const std::string& file);

}  // namespace petzval
