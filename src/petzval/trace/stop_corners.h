// SPDX-License-Identifier: BSD-3-Clause
// Where the corners of a stop with blades lie among the rays of a pencil.
#pragma once

#include <petzval/trace/pencil.h>

#include <array>
#include <optional>
#include <vector>

namespace petzval {

/// How far from the chief ray, in v, the rim of the stop lies to first order.
double pupil_scale(const Tracer& tracer, const Pencil& pencil, const std::array<double, 2>& chief);

/// The labels (u, v) of the rays through the corners of the polygon, by Newton's method on real rays from the
/// chief ray; corners that no ray reaches are left out. \param scale  as pupil_scale().
std::vector<std::array<double, 2>> aim_at_corners(const Tracer& tracer, const Pencil& pencil,
                                                  const std::array<double, 2>& chief, double scale);

/// The label (u, v) of the ray that meets a point of the stop [mm, in the stop's own axes], by Newton from
/// `label`; nothing where that fails. \param scale  of the pupil, in labels. \param tolerance  of the stop's
/// radius.
std::optional<std::array<double, 2>> aim_at_stop(const Tracer& tracer, const Pencil& pencil,
                                                 const std::array<double, 2>& point,
                                                 std::array<double, 2> label, double scale, double tolerance);

}  // namespace petzval
