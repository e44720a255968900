// SPDX-License-Identifier: BSD-3-Clause
// The surfaces of a scene as they are met by rays.
#pragma once

#include <petzval/render/shapes/curve_segments.h>
#include <petzval/render/shapes/quadric.h>
#include <petzval/render/shapes/triangle_mesh.h>
#include <petzval/render/textures/texture.h>

#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace petzval::render {

/// How much of a surface is there: rays meet it with this probability, and else go on.
struct Opacity {
  FloatTexture texture;
  std::optional<double> cutoff;  ///< from here on all of it is, below nothing
};

/// One shape of a scene.
struct Geometry {
  std::variant<TriangleMesh, Quadric, CurveSegments> shape;
  std::optional<Opacity> opacity;  ///< of a mesh; times that of its vertices
  bool is_interface = false;       ///< its material is none: light passes it as it is
  bool needs_coordinates = true;   ///< its material varies over it: SurfacePoint::u and v are asked for
  int material = 0;
  bool reversed = false;          ///< ReverseOrientation
  bool swaps_handedness = false;  ///< its transformation is a mirror image
  bool parts_media = false;       ///< else light stays in the medium that it is in
  int inside = -1, outside = -1;  ///< media of the scene; −1: none
  int first_light = -1;           ///< of its primitives, which shine one by one; −1: none do

  std::size_t primitives() const;
  double primitive_area(std::size_t primitive) const;
};

/// A ray's nearest meeting with a surface.
struct Hit {
  double distance = 0;  ///< in units of the direction's length
  int geometry = 0, primitive = 0, instance = -1;
  /// Barycentric coordinates of corners 1 and 2 of a triangle; b1 is the place along a segment of a curve.
  double b1 = 0, b2 = 0;
};

/// A point of a surface, in world space.
struct SurfacePoint {
  Vector3 position;
  Vector3 normal;          ///< of the surface; unit
  Vector3 shading_normal;  ///< of its interpolated normals, on the same side
  Vector3 along_u;
  double u = 0, v = 0;                  ///< if Geometry::needs_coordinates
  bool mirrored_uv = false;             ///< ∂p/∂u × ∂p/∂v looks away from the shading normal
  std::array<double, 3> tint{1, 1, 1};  ///< colour of the vertices
  double clearance = 0;                 ///< how far rays must get away before they may meet the surface again

  /// Where a ray to `direction` begins so that it does not meet the point's own surface again, for all that
  /// Embree computes in single precision.
  Vector3 origin_towards(Vector3 direction) const;
};

/// The point of a hit. \param place  world from the object for a hit on a placed object, else null.
SurfacePoint surface_point(const Geometry& geometry, const Hit& hit, Vector3 origin, Vector3 direction,
                           const Transform* place);

/// ∂p/∂v there, as SurfacePoint::along_u is ∂p/∂u. \param point  of surface_point().
Vector3 along_v(const Geometry& geometry, const Hit& hit, const SurfacePoint& point, const Transform* place);

/// 0 to 1, at a place on a triangle of a mesh with opacity.
double opacity_at(const Geometry& geometry, std::size_t triangle, double b1, double b2);

/// A point of a primitive, for lights, with its density per area.
struct SurfaceSample {
  SurfacePoint point;
  double per_area = 0;
};
SurfaceSample sample_primitive(const Geometry& geometry, std::size_t primitive, double u, double v);
/// The density of sample_primitive() at a point.
double primitive_density(const Geometry& geometry, std::size_t primitive, const SurfacePoint& point);

}  // namespace petzval::render
