// SPDX-License-Identifier: BSD-3-Clause
// Smooth surfaces from coarse meshes.
#pragma once

#include <petzval/render/shapes/triangle_mesh.h>

namespace petzval::render {

/// The surface that Loop's scheme tends to (Loop 1987), as triangles: each is parted in four `levels` times,
/// vertices lie on the limit and have its normals. Only positions and triangles of `mesh` count. On open
/// edges the limit is that of cubic B-splines (pbrt-v4 takes 1/5 3/5 1/5 of the last vertices there, where
/// 1/6 2/3 1/6 is the limit). \throws InputError for an edge of more than two triangles, for two triangles
/// that run along it in one sense, and for more triangles than fit.
TriangleMesh loop_surface(const TriangleMesh& mesh, int levels);

}  // namespace petzval::render
