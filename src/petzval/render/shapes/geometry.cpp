// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/shapes/geometry.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

/// Of the largest coordinate: some thirty roundings of a float.
constexpr double float_clearance = 0x1p-19;

std::array<double, 2> uv_of(const TriangleMesh& mesh, std::uint32_t vertex, std::size_t corner) {
  static constexpr std::array<std::array<double, 2>, 3> standard{{{0, 0}, {1, 0}, {1, 1}}};
  if (mesh.uvs.empty()) return standard[corner];
  return {static_cast<double>(mesh.uvs[vertex][0]), static_cast<double>(mesh.uvs[vertex][1])};
}

/// ∂p/∂u of a triangle; any direction in it where the texture coordinates give none.
Vector3 triangle_along_u(const std::array<Vector3, 3>& p, const std::array<std::array<double, 2>, 3>& uv) {
  const double du1 = uv[1][0] - uv[0][0], dv1 = uv[1][1] - uv[0][1], du2 = uv[2][0] - uv[0][0],
               dv2 = uv[2][1] - uv[0][1];
  const double determinant = du1 * dv2 - dv1 * du2;
  if (determinant == 0) return p[1] - p[0];
  return 1 / determinant * (dv2 * (p[1] - p[0]) - dv1 * (p[2] - p[0]));
}

SurfacePoint triangle_point(const Geometry& geometry, const TriangleMesh& mesh, std::size_t triangle,
                            double b1, double b2) {
  const auto& index = mesh.triangles[triangle];
  const std::array<Vector3, 3> p = mesh.corners(triangle);
  const std::array<double, 3> b{1 - b1 - b2, b1, b2};
  SurfacePoint point;
  point.position = b[0] * p[0] + b[1] * p[1] + b[2] * p[2];
  const Vector3 counted = cross(p[1] - p[0], p[2] - p[0]);
  point.normal = normalised(counted);
  std::array<std::array<double, 2>, 3> uv;
  for (std::size_t i = 0; i < 3; ++i) {
    uv[i] = uv_of(mesh, index[i], i);
    point.u += b[i] * uv[i][0];
    point.v += b[i] * uv[i][1];
  }
  point.along_u = triangle_along_u(p, uv);
  const double uv_area =
      (uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) - (uv[1][1] - uv[0][1]) * (uv[2][0] - uv[0][0]);
  if (!mesh.colours.empty()) {
    point.tint = {0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        point.tint[c] += b[i] * static_cast<double>(mesh.colours[index[i]][c]);
  }
  if (mesh.normals.empty()) {
    if (geometry.reversed != geometry.swaps_handedness) point.normal = -point.normal;
    point.shading_normal = point.normal;
    point.mirrored_uv = (uv_area < 0) != (dot(counted, point.shading_normal) < 0);
    return point;
  }
  Vector3 shading;
  for (std::size_t i = 0; i < 3; ++i) {
    const TriangleMesh::Vertex& n = mesh.normals[index[i]];
    shading = shading + b[i] * Vector3{n[0], n[1], n[2]};
  }
  if (geometry.reversed) shading = -shading;
  point.normal = facing(point.normal, shading);
  point.shading_normal = dot(shading, shading) > 0 ? normalised(shading) : point.normal;
  point.mirrored_uv = (uv_area < 0) != (dot(counted, point.shading_normal) < 0);
  return point;
}

SurfacePoint quadric_point(const Geometry& geometry, const Quadric::Point& on) {
  SurfacePoint point;
  point.position = on.position;
  point.normal = geometry.reversed ? -on.normal : on.normal;
  point.shading_normal = point.normal;
  point.along_u = on.along_u;
  point.u = on.u, point.v = on.v;
  return point;
}

/// Embree finds curves nearly: to this share of the radius.
constexpr double tube_clearance = 0.01;
/// A ribbon turns about its middle line to face the next ray, too, which must be beyond it by then.
constexpr double ribbon_clearance = 2;

/// \param from  unit direction of the ray that meets it.
SurfacePoint curve_point(const Geometry& geometry, const CurveSegments& curve, const Hit& hit,
                         Vector3 position, Vector3 from) {
  const auto segment = static_cast<std::size_t>(hit.primitive);
  const CurveSegments::Place place = curve.at(segment, hit.b1);
  const Vector3 tangent = normalised(place.tangent), off = position - place.centre;
  const bool tube = curve.kind == CurveSegments::Kind::cylinder;
  const Vector3 outwards = tube ? off : -from;
  SurfacePoint point;
  point.position = position;
  point.normal = normalised(outwards - dot(outwards, tangent) * tangent);
  if (!(dot(point.normal, point.normal) > 0)) point.normal = -from;  // straight along the curve
  if (geometry.reversed) point.normal = -point.normal;
  point.shading_normal = point.normal;
  point.along_u = place.tangent;
  point.u = (static_cast<double>(segment) + hit.b1) / static_cast<double>(curve.segments());
  const double across = dot(off, normalised(cross(tangent, -from))) / std::max(2 * place.radius, 1e-30);
  point.v = std::clamp(0.5 + across, 0.0, 1.0);
  point.clearance = (tube ? tube_clearance : ribbon_clearance) * place.radius;
  return point;
}

}  // namespace

Vector3 along_v(const Geometry& geometry, const Hit& hit, const SurfacePoint& point, const Transform* place) {
  const auto primitive = static_cast<std::size_t>(hit.primitive);
  if (const auto* curve = std::get_if<CurveSegments>(&geometry.shape))
    return 2 * curve->at(primitive, hit.b1).radius * normalised(cross(point.along_u, point.normal));
  const auto* mesh = std::get_if<TriangleMesh>(&geometry.shape);
  if (!mesh) {
    const auto& quadric = std::get<Quadric>(geometry.shape);
    return place ? place->direction(quadric.along_v(place->inverse_point(point.position)))
                 : quadric.along_v(point.position);
  }
  // What ∂p/∂u leaves of the edge along which v changes most.
  const auto& index = mesh->triangles[primitive];
  const std::array<Vector3, 3> p = mesh->corners(primitive);
  const std::array<double, 2> from = uv_of(*mesh, index[0], 0);
  Vector3 along;
  double most = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    const std::array<double, 2> to = uv_of(*mesh, index[i], i);
    const double dv = to[1] - from[1];
    if (std::abs(dv) <= most) continue;
    most = std::abs(dv);
    const Vector3 edge = place ? place->direction(p[i] - p[0]) : p[i] - p[0];
    along = 1 / dv * (edge - (to[0] - from[0]) * point.along_u);
  }
  return along;
}

double opacity_at(const Geometry& geometry, std::size_t triangle, double b1, double b2) {
  const auto& mesh = std::get<TriangleMesh>(geometry.shape);
  const auto& index = mesh.triangles[triangle];
  const std::array<Vector3, 3> p = mesh.corners(triangle);
  const std::array<double, 3> b{1 - b1 - b2, b1, b2};
  TexturePoint point;
  double of_vertices = mesh.colours.empty() ? 1 : 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::array<double, 2> uv = uv_of(mesh, index[i], i);
    point.world = point.world + b[i] * p[i];
    point.u += b[i] * uv[0], point.v += b[i] * uv[1];
    if (!mesh.colours.empty()) of_vertices += b[i] * static_cast<double>(mesh.colours[index[i]][3]);
  }
  const double opacity = geometry.opacity->texture->at(point, 0) * of_vertices;
  if (geometry.opacity->cutoff) return opacity >= *geometry.opacity->cutoff ? 1 : 0;
  return std::clamp(opacity, 0.0, 1.0);
}

std::size_t Geometry::primitives() const {
  if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) return mesh->triangles.size();
  if (const auto* curve = std::get_if<CurveSegments>(&shape)) return curve->segments();
  return 1;
}

double Geometry::primitive_area(std::size_t primitive) const {
  const auto* mesh = std::get_if<TriangleMesh>(&shape);
  return mesh ? mesh->area(primitive) : std::get<Quadric>(shape).area();
}

Vector3 SurfacePoint::origin_towards(Vector3 direction) const {
  const double size = std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)});
  return position + float_clearance * size * facing(normal, direction) + clearance * direction;
}

SurfacePoint surface_point(const Geometry& geometry, const Hit& hit, Vector3 origin, Vector3 direction,
                           const Transform* place) {
  const auto* mesh = std::get_if<TriangleMesh>(&geometry.shape);
  SurfacePoint point;
  if (mesh) {
    point = triangle_point(geometry, *mesh, static_cast<std::size_t>(hit.primitive), hit.b1, hit.b2);
  } else {
    Vector3 near = origin + hit.distance * direction;
    if (place) near = place->inverse_point(near);
    const auto* curve = std::get_if<CurveSegments>(&geometry.shape);
    point = curve ? curve_point(geometry, *curve, hit, near,
                                normalised(place ? place->inverse_direction(direction) : direction))
                  : quadric_point(geometry,
                                  std::get<Quadric>(geometry.shape).at(near, geometry.needs_coordinates));
  }
  if (!place) return point;
  point.position = place->point(point.position);
  point.normal = normalised(place->normal(point.normal));
  point.shading_normal = normalised(place->normal(point.shading_normal));
  if (point.clearance > 0) point.clearance *= length(place->direction(normalised(point.along_u)));
  point.along_u = place->direction(point.along_u);
  return point;
}

SurfaceSample sample_primitive(const Geometry& geometry, std::size_t primitive, double u, double v) {
  if (const auto* mesh = std::get_if<TriangleMesh>(&geometry.shape)) {
    // Even over the triangle (Heitz, "A low-distortion map between triangle and square", 2019).
    double b0 = u / 2, b1 = v - b0;
    if (v <= u) {
      b1 = v / 2;
      b0 = u - b1;
    }
    return {triangle_point(geometry, *mesh, primitive, b1, 1 - b0 - b1), 1 / mesh->area(primitive)};
  }
  const Quadric& quadric = std::get<Quadric>(geometry.shape);
  const Quadric::Sample sample = quadric.sample(u, v);
  return {quadric_point(geometry, sample.point), sample.per_area};
}

double primitive_density(const Geometry& geometry, std::size_t primitive, const SurfacePoint& point) {
  if (const auto* mesh = std::get_if<TriangleMesh>(&geometry.shape)) return 1 / mesh->area(primitive);
  Quadric::Point at;
  at.position = point.position;
  return std::get<Quadric>(geometry.shape).density(at);
}

}  // namespace petzval::render
