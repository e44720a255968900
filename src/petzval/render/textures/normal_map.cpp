// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/textures/normal_map.h>

#include <array>

namespace petzval::render {

Vector3 NormalMap::normal_at(const SurfacePoint& point) const {
  double s, t;
  mapping_.coordinates({point.position, point.u, point.v}, s, t);
  const std::array<double, 3> rgb = picture_.at(s, t);
  const Frame frame(point.shading_normal, point.along_u);
  const double across = towards_v_ && point.mirrored_uv ? -1 : 1;
  const Vector3 lean{scale_ * (2 * rgb[0] - 1), across * scale_ * (2 * rgb[1] - 1), 2 * rgb[2] - 1};
  const Vector3 normal = normalised(frame.from_local(lean));
  return dot(normal, normal) > 0 ? facing(normal, point.normal) : point.shading_normal;
}

}  // namespace petzval::render
