// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/textures/bump_map.h>

namespace petzval::render {

Vector3 BumpMap::normal_at(const SurfacePoint& point, Vector3 along_v) const {
  const auto height = [&](double du, double dv) {
    return height_->at(
        {point.position + du * point.along_u + dv * along_v, point.u + du, point.v + dv, point.tint}, 0);
  };
  const double slope_u = (height(step_, 0) - height(-step_, 0)) / (2 * step_);
  const double slope_v = (height(0, step_) - height(0, -step_)) / (2 * step_);
  const Vector3 n = point.shading_normal;
  const auto raised = [&](Vector3 along, double slope) { return along + (slope - dot(along, n)) * n; };
  const Vector3 normal = normalised(cross(raised(point.along_u, slope_u), raised(along_v, slope_v)));
  return dot(normal, normal) > 0 ? facing(facing(normal, n), point.normal) : n;
}

}  // namespace petzval::render
