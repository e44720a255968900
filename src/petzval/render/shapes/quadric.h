// SPDX-License-Identifier: BSD-3-Clause
// Spheres, disks and cylinders, whole or in part.
#pragma once

#include <petzval/render/pbrt/scene_description.h>

#include <array>
#include <optional>

namespace petzval::render {

/// One of pbrt's quadrics in a space of its own, z its axis: a sphere or cylinder of a radius between z_min
/// and z_max, or a disk at z_min with a hole of inner_radius; all from azimuth 0 to phi_max.
struct Quadric {
  enum class Kind { sphere, disk, cylinder };
  Kind kind = Kind::sphere;
  double radius = 1, inner_radius = 0, z_min = -1, z_max = 1, phi_max = 0;
  Transform world_from_object;  ///< or from the object that is placed
  /// Of a whole sphere that is only moved, turned and scaled evenly: in world space, where it is met sooner.
  struct Ball {
    Vector3 centre;
    double radius;
    Vector3 axis;  ///< unit; along it ∂p/∂u turns anticlockwise
  };
  std::optional<Ball> ball;  ///< set by find_ball()

  struct Point {
    Vector3 position;  ///< in world space
    Vector3
        normal;  ///< unit: outwards of sphere and cylinder, +z of the disk, as the transformation takes them
    Vector3 along_u;      ///< ∂p/∂u, u the azimuth
    double u = 0, v = 0;  ///< if they are asked for
  };

  /// The first t in (t_min, t_max) at which origin + t·direction (world space) meets the surface.
  std::optional<double> hit(Vector3 origin, Vector3 direction, double t_min, double t_max) const;
  /// Everything about a point of the surface, given nearly. \param coordinates  whether u and v are asked
  /// for.
  Point at(Vector3 world_position, bool coordinates = true) const;
  /// ∂p/∂v at a point of the surface.
  Vector3 along_v(Vector3 world_position) const;

  /// Corners of the box around it in world space: {least, greatest}.
  std::array<Vector3, 2> bounds() const;
  /// A point, without u and v, with density `per_area` (in world space) over the surface; even over it unless
  /// the transformation stretches it.
  struct Sample {
    Point point;
    double per_area = 0;
  };
  Sample sample(double u, double v) const;
  /// The density of sample() at a point.
  double density(const Point& point) const;
  /// In its own space [unit²]; exact area in world space when the transformation only moves, turns and scales
  /// evenly.
  double object_area() const;
  double area() const;
  /// Whether it is a whole sphere moved, turned and scaled evenly; then `centre` and `radius` are those in
  /// world space.
  bool is_round_sphere(Vector3& centre, double& world_radius) const;
  void find_ball();

 private:
  Point at_ball(Vector3 world_position) const;
  bool covers(Vector3 p) const;
  Vector3 object_normal(Vector3 p) const;
  void set_coordinates(Vector3 p, Point& point) const;
};

/// \throws InputError with file, line and column.
Quadric read_quadric(const ShapeDescription& shape, Unsupported& unsupported);

}  // namespace petzval::render
