// SPDX-License-Identifier: BSD-3-Clause
// What a surface may do to rays in place of plain refraction or reflection: send them into an order of a
// grating, or bend them as an ideal lens does.
//
// A kind is a struct of its numbers here, its case in bend() and bend_data(), its key in the native format
// and, where other formats have it, in theirs. Rays, single, in vectors and derived, need nothing more.
#pragma once

#include <string>

namespace petzval {

struct Lens;
struct Surface;

/// Straight lines ruled on a plane, a sphere or a conic: planes parallel to the axis of the surface cut it in
/// them. All light goes into one order.
struct Grating {
  double lines_per_mm = 0;
  double order = 0;         ///< > 0 sends light towards where `rotation_deg` turns +y
  double rotation_deg = 0;  ///< of the lines, which lie along x, from +x towards +y
};

/// A plane that images one plane, that of the lens's object as the surfaces before make it, perfectly: slopes
/// n' tan u' = n tan u − y/f, and equal paths from each point to its image.
struct IdealLens {
  double focal_length_mm = 0;  ///< in air
};

/// \throws InputError that what is done needs surfaces of glass, if one is a grating or an ideal lens.
void require_no_bends(const Lens& lens, const char* what);

/// "ruled with 600 lines/mm, order 1", "ideal lens of 50 mm", "" for neither.
std::string bend_remark(const Surface& surface);

}  // namespace petzval
