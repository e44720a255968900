// SPDX-License-Identifier: BSD-3-Clause
// Curves with a width: hair, grass, wires.
#pragma once

#include <petzval/render/pbrt/scene_description.h>

#include <array>
#include <vector>

namespace petzval::render {

/// The pieces of one of pbrt's curves, each a cubic Bézier curve with a radius that runs evenly from its
/// beginning to its end.
struct CurveSegments {
  enum class Kind {
    flat,      ///< turns its face to whoever looks
    cylinder,  ///< a tube
    ribbon     ///< faces along its normals (ribbon_mesh.h)
  };
  Kind kind = Kind::flat;
  using ControlPoint = std::array<float, 4>;  ///< x, y, z, radius
  std::vector<ControlPoint> points;           ///< four for each segment
  std::vector<Vector3> normals;               ///< of a ribbon, where segments begin and end; unit

  std::size_t segments() const { return points.size() / 4; }
  struct Place {
    Vector3 centre, tangent;  ///< tangent: d centre/dt, not of unit length
    double radius = 0;
  };
  /// \param t  0 … 1 along the segment.
  Place at(std::size_t segment, double t) const;
};

/// Bézier and B-spline curves of degree 2 and 3; in world space. \throws InputError with file, line and
/// column for points that make no whole number of segments, and through `unsupported`.
CurveSegments read_curve(const ShapeDescription& shape, Unsupported& unsupported);

}  // namespace petzval::render
