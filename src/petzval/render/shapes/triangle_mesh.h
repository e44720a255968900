// SPDX-License-Identifier: BSD-3-Clause
// Surfaces made of triangles.
#pragma once

#include <petzval/render/pbrt/scene_description.h>

#include <array>
#include <cstdint>
#include <vector>

namespace petzval::render {

/// Triangles in the space of the world (or of the object that is placed). Every vertex may have a normal and
/// texture coordinates and a colour; else their lists are empty.
struct TriangleMesh {
  using Vertex = std::array<float, 3>;
  std::vector<Vertex> positions, normals;
  std::vector<std::array<float, 2>> uvs;
  std::vector<std::array<float, 4>> colours;  ///< linear RGB, which multiplies textures, and opacity; 0 to 1
  std::vector<std::array<std::uint32_t, 3>> triangles;

  Vector3 position(std::uint32_t vertex) const;
  std::array<Vector3, 3> corners(std::size_t triangle) const;
  double area(std::size_t triangle) const;

  /// Takes positions and normals to another space. \throws InputError if a place cannot be held as a float.
  void transform(const Transform& to);
  /// \throws InputError (message only) for indices beyond the vertices, lists of other lengths, or numbers
  /// that are not finite.
  void validate() const;
};

inline TriangleMesh::Vertex mesh_vertex(Vector3 p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// pbrt's "trianglemesh", "bilinearmesh" and "plymesh", or the mesh that the description holds, in world
/// space. Bilinear patches that are not flat become 2 × 16² triangles with the patch's own normals. \throws
/// InputError with file, line and column.
TriangleMesh read_triangle_mesh(const ShapeDescription& shape, Unsupported& unsupported);

/// A PLY file: ASCII or binary of either byte order; triangles and quads.
/// \throws InputError naming the file, and the line for ASCII.
TriangleMesh read_ply(const std::string& path);
TriangleMesh parse_ply(std::string_view bytes, const std::string& path);

}  // namespace petzval::render
