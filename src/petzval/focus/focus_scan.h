// SPDX-License-Identifier: BSD-3-Clause
// The focus measure everywhere: the truth that searches are held to.
#pragma once

#include <petzval/focus/autofocus.h>

namespace petzval {

/// No search: the measure at `count` places evenly over a range, and the peak of the cubic that fits the
/// logarithms of the best and its neighbours above four fifths of it. What a search must find, if the places
/// are dense and the pictures good. \throws InputError as find_focus(), and for fewer than 3 places.
FocusResult scan_focus(const PicturesAt& pictures_at, const std::vector<FocusZone>& zones,
                       const FocusMeasureOptions& measure, double nearest_mm, double farthest_mm, int count);

}  // namespace petzval
