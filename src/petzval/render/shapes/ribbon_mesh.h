// SPDX-License-Identifier: BSD-3-Clause
// Ribbons: curves that face where they are told to.
#pragma once

#include <petzval/render/shapes/curve_segments.h>
#include <petzval/render/shapes/triangle_mesh.h>

namespace petzval::render {

/// The surface c(t) + s · n(t) × c′(t)/|n × c′| of a curve of kind ribbon, s within its radius: 64 triangles
/// a segment, 512 where it twists. Between the ends of a segment its normals turn evenly on the sphere
/// (pbrt-v4). u runs along the whole curve, v across.
TriangleMesh ribbon_mesh(const CurveSegments& ribbon);

}  // namespace petzval::render
