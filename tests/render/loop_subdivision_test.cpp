// SPDX-License-Identifier: BSD-3-Clause
// Loop's surfaces by what a limit must be: the same from every level.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/render/shapes/loop_subdivision.h>

#include <cmath>
#include <random>

#include "scene_text.h"

namespace petzval::render {
namespace {

/// A lattice of n × n places, each moved at random; with one place lifted out of the rule by a split
/// triangle.
TriangleMesh rough_lattice(std::uint32_t n) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> move(-0.2f, 0.2f);
  TriangleMesh mesh;
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i)
      mesh.positions.push_back(
          {static_cast<float>(i) + move(random), static_cast<float>(j) + move(random), move(random)});
  for (std::uint32_t j = 0; j + 1 < n; ++j)
    for (std::uint32_t i = 0; i + 1 < n; ++i) {
      const std::uint32_t a = j * n + i;
      mesh.triangles.push_back({a, a + 1, a + n + 1});
      mesh.triangles.push_back({a, a + n + 1, a + n});
    }
  const auto last = mesh.triangles.back();  // a vertex of three neighbours within it
  mesh.triangles.pop_back();
  const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back({static_cast<float>(n) - 1.6f, static_cast<float>(n) - 1.3f, 0.3f});
  for (std::size_t c = 0; c < 3; ++c) mesh.triangles.push_back({last[c], last[(c + 1) % 3], middle});
  return mesh;
}

TriangleMesh octahedron() {
  TriangleMesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

TEST(LoopSurface, HasTheSameLimitFromEveryLevel) {
  for (const TriangleMesh& mesh : {rough_lattice(5), octahedron()}) {
    const TriangleMesh first = loop_surface(mesh, 0);
    for (const int levels : {1, 2, 4}) {
      const TriangleMesh later = loop_surface(mesh, levels);
      EXPECT_EQ(later.triangles.size(), mesh.triangles.size() << (2 * levels));
      for (std::size_t v = 0; v < mesh.positions.size(); ++v)  // vertices keep their places in the list
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_NEAR(later.positions[v][c], first.positions[v][c], 2e-6) << v;
          EXPECT_NEAR(later.normals[v][c], first.normals[v][c], 2e-5) << v;
        }
    }
  }
}

TEST(LoopSurface, HasTheNormalsOfItsTriangles) {
  for (const TriangleMesh& mesh : {rough_lattice(5), octahedron()}) {
    const TriangleMesh fine = loop_surface(mesh, 5);
    for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
      const auto [a, b, c] = fine.corners(t);
      const Vector3 flat = normalised(cross(b - a, c - a));
      for (const std::uint32_t v : fine.triangles[t]) {
        const auto& n = fine.normals[v];
        EXPECT_GT(dot(flat, {n[0], n[1], n[2]}), 0.95);  // a 32nd of a cell away
      }
    }
  }
}

/// The limit of a vertex of four neighbours: β = 3/32, γ = 1/(4 + 3/(8β)) = 1/8: half its place, and an
/// eighth of each neighbour's.
TEST(LoopSurface, TakesAnOctahedronToItsKnownRadius) {
  const TriangleMesh limit = loop_surface(octahedron(), 3);
  EXPECT_NEAR(limit.positions[0][0], 0.5, 1e-6);
  EXPECT_NEAR(limit.positions[5][2], -0.5, 1e-6);
  EXPECT_NEAR(limit.normals[4][2], 1, 1e-6);
}

TEST(LoopSurface, RefusesWhatIsNoSurface) {
  TriangleMesh three = octahedron();
  three.triangles.push_back({0, 2, 1});
  EXPECT_THROW(loop_surface(three, 1), InputError);
  EXPECT_THROW(loop_surface(octahedron(), -1), InputError);
  EXPECT_THROW(loop_surface(octahedron(), 30), InputError);
  const auto world = world_of(
      "Shape \"loopsubdiv\" \"integer levels\" 2 \"integer indices\" [ 0 1 2 0 2 3 ] \"point3 P\" "
      "[ 0 0 0 1 0 0 1 1 0 0 1 0 ]\n");
  EXPECT_EQ(world->geometries.at(0).primitives(), 32u);
  EXPECT_THROW(
      world_of("Shape \"loopsubdiv\" \"integer indices\" [ 0 1 2 0 1 2 ] \"point3 P\" [ 0 0 0 1 0 0 1 1 0 ]"),
      InputError);
}

}  // namespace
}  // namespace petzval::render
