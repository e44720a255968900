// SPDX-License-Identifier: BSD-3-Clause
// Which part of a camera ray may see something.
#pragma once

#include <petzval/render/vector3.h>

#include <limits>

namespace petzval::render {

/// Planes across the camera's axis, from its place [scene units]: only surfaces between them are seen, though
/// everything lights and is mirrored.
struct ClippingPlanes {
  double near = 0, far = std::numeric_limits<double>::infinity();

  /// The part of a ray of camera space between the planes, in lengths of its direction; none where `to` is
  /// not above `from`. A ray that runs across the axis or backwards has one only if there is no near plane.
  struct Part {
    double from = 0, to = 0;
  };
  Part part_of(Vector3 origin, Vector3 direction) const {
    constexpr double forever = std::numeric_limits<double>::infinity();
    if (!(direction.z > 0)) return {0, near > 0 ? 0 : forever};
    const double from = near > 0 ? (near - origin.z) / direction.z : 0;
    return {from > 0 ? from : 0, (far - origin.z) / direction.z};
  }
};

}  // namespace petzval::render
