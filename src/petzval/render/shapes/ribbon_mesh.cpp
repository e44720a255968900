// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/shapes/ribbon_mesh.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

/// Along a segment, and across one that twists: flat triangles from rim to rim would be as steep everywhere
/// as the twist is at the rims.
constexpr std::uint32_t pieces = 32, twisted_strips = 8;

Vector3 turned(Vector3 from, Vector3 to, double share) {
  const double angle = std::acos(std::clamp(dot(from, to), -1.0, 1.0));
  if (std::sin(angle) < 1e-9) return from;
  return 1 / std::sin(angle) * (std::sin((1 - share) * angle) * from + std::sin(share * angle) * to);
}

/// Vertices across a ribbon at a place, from rim to rim.
void add_row(const CurveSegments& ribbon, std::size_t segment, double t, std::uint32_t strips,
             TriangleMesh& mesh) {
  const CurveSegments::Place place = ribbon.at(segment, t);
  const Vector3 tangent = normalised(place.tangent);
  const Vector3 wanted = turned(ribbon.normals[segment], ribbon.normals[segment + 1], t);
  Vector3 normal = normalised(wanted - dot(wanted, tangent) * tangent);
  if (!(dot(normal, normal) > 0)) normal = Frame(tangent).from_local({1, 0, 0});  // it points along the curve
  const Vector3 across = cross(normal, tangent);
  const double u = (static_cast<double>(segment) + t) / static_cast<double>(ribbon.segments());
  for (std::uint32_t k = 0; k <= strips; ++k) {
    const double v = static_cast<double>(k) / strips;
    mesh.positions.push_back(mesh_vertex(place.centre + (2 * v - 1) * place.radius * across));
    mesh.normals.push_back(mesh_vertex(normal));
    mesh.uvs.push_back({static_cast<float>(u), static_cast<float>(v)});
  }
}

}  // namespace

TriangleMesh ribbon_mesh(const CurveSegments& ribbon) {
  TriangleMesh mesh;
  for (std::size_t segment = 0; segment < ribbon.segments(); ++segment) {
    const bool twists = dot(ribbon.normals[segment], ribbon.normals[segment + 1]) < 1 - 1e-12;
    const std::uint32_t strips = twists ? twisted_strips : 1, row = strips + 1;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t i = 0; i <= pieces; ++i)
      add_row(ribbon, segment, static_cast<double>(i) / pieces, strips, mesh);
    for (std::uint32_t i = 0; i < pieces; ++i)
      for (std::uint32_t k = 0; k < strips; ++k) {
        const std::uint32_t at = first + i * row + k;
        mesh.triangles.push_back({at, at + row, at + row + 1});
        mesh.triangles.push_back({at, at + row + 1, at + 1});
      }
  }
  mesh.validate();
  return mesh;
}

}  // namespace petzval::render
