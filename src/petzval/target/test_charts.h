// SPDX-License-Identifier: BSD-3-Clause
// Test charts as polygons, for any size of picture.
#pragma once

#include <petzval/target/polygon.h>

#include <string>
#include <vector>

namespace petzval {

/// Names that test_chart takes.
std::vector<std::string> test_chart_names();

/// Dark figures on a light ground, centred in a picture of columns × rows [pixels]:
///
/// slanted-edges   squares turned by 5°, a third of the shorter side apart, as the low-contrast edges of an
///                 ISO 12233 e-SFR chart stand
/// slanted-star    twelve dark sectors whose edges run in 24 directions
/// checkerboard    8 by 8 fields turned by 5°
/// pinch           nine straight-sided bars that close up from a width of 8 pixels to 0.9 pixels each, 0.06
/// to 0.56
///                 cycles/pixel
/// text            lines of writing, ever smaller, down to capitals 3 pixels high; each begins with their
/// height trumpet         nine bars whose frequency grows evenly on the way down, 0.05 to 0.55 cycles/pixel
/// zone-plate      rings whose frequency grows with the distance from the centre, to 0.5 cycles/pixel at the
/// rim
///
/// and the charts of scenes that are figures alone, with their parameters: "siemens:72", "usaf1951",
/// "qr:TEXT" and others (scene/chart_figures.h).
///
/// Curves are chords within 1e-4 pixels. \throws InputError for another name, naming the nearest, or a
/// picture below 64 pixels a side.
TargetScene test_chart(const std::string& name, int columns, int rows);

}  // namespace petzval
