// SPDX-License-Identifier: BSD-3-Clause
// Where the corners of a stop with blades lie among the rays of a pencil.
#pragma once

#include <petzval/trace/pencil.h>

#include <array>
#include <vector>

namespace petzval {

/// The labels (u, v) of the rays through the corners of the polygon, by Newton's method on real rays from the
/// chief ray; corners that no ray reaches are left out. \param scale  how far from the chief ray, in v, the
/// rim of the stop lies to first order.
std::vector<std::array<double, 2>> aim_at_corners(const Tracer& tracer, const Pencil& pencil, double chief_v,
                                                  double scale);

}  // namespace petzval
