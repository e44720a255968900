// SPDX-License-Identifier: BSD-3-Clause
// Surfaces and elements as outlines in the y-z plane; used by lens_drawing.cpp.
#pragma once

#include <petzval/lens/lens.h>

#include <array>
#include <vector>

namespace petzval {

using PlanePoint = std::array<double, 2>;  ///< z, y [mm]

/// The surface from y = −semi_diameter to +semi_diameter.
std::vector<PlanePoint> profile(const Surface& surface, double vertex_z_mm, double semi_diameter_mm);

/// The same where a pose has brought it, seen along x.
std::vector<PlanePoint> placed(std::vector<PlanePoint> points, const Frame& frame, double vertex_z_mm);

/// The closed outline of the glass between two profiles that run upwards. The smaller one is carried on as a
/// flat annulus to the height of the larger one, and a cylinder joins them there; where that would cross the
/// other surface, the rims are joined by a cone.
std::vector<PlanePoint> element_outline(const std::vector<PlanePoint>& front,
                                        const std::vector<PlanePoint>& back);

}  // namespace petzval
