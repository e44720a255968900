// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/base/units.h>
#include <petzval/render/shapes/loop_subdivision.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace petzval::render {

namespace {

constexpr double most_loop_triangles = 1 << 26;
constexpr std::uint32_t no_vertex = 0xffffffff;

using Triangle = std::array<std::uint32_t, 3>;

/// Vertices in double precision, and who stands beside whom.
class LoopMesh {
 public:
  LoopMesh(std::vector<Vector3> positions, std::vector<Triangle> triangles)
      : positions_(std::move(positions)), triangles_(std::move(triangles)) {
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (i % 4096 == 0) check_stop();
      for (std::size_t c = 0; c < 3; ++c)
        add_edge(triangles_[i][c], triangles_[i][(c + 1) % 3], triangles_[i][(c + 2) % 3]);
    }
    find_rings();
  }

  LoopMesh parted() const {
    std::vector<Vector3> positions(positions_.size());
    for (std::uint32_t v = 0; v < positions_.size(); ++v)
      positions[v] = smoothed(v, vertex_share(v), 1.0 / 8);
    std::unordered_map<std::uint64_t, std::uint32_t> middle_of;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] = middle_of.emplace(key(std::min(a, b), std::max(a, b)),
                                                     static_cast<std::uint32_t>(positions.size()));
      if (is_new) positions.push_back(middle_place(a, b));
      return found->second;
    };
    std::vector<Triangle> triangles;
    triangles.reserve(4 * triangles_.size());
    for (const Triangle& t : triangles_) {
      const std::uint32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
      triangles.insert(triangles.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    }
    return {std::move(positions), std::move(triangles)};
  }

  TriangleMesh limit() const {
    TriangleMesh mesh;
    mesh.triangles = triangles_;
    for (std::uint32_t v = 0; v < positions_.size(); ++v) {
      const double n = static_cast<double>(rings_[v].size());
      mesh.positions.push_back(floats(smoothed(v, n > 0 ? 1 / (n + 3 / (8 * vertex_share(v))) : 0, 1.0 / 6)));
      mesh.normals.push_back(floats(normal_at(v)));
    }
    return mesh;
  }

 private:
  static std::uint64_t key(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }
  static TriangleMesh::Vertex floats(Vector3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  }

  void add_edge(std::uint32_t from, std::uint32_t to, std::uint32_t across) {
    if (from == to || !across_.emplace(key(from, to), across).second)
      throw InputError(fmt::format(
          "the edge from vertex {} to {} has two triangles on one side; one triangle on each side of an "
          "edge, all of them counted in one sense, would be right",
          from, to));
  }
  /// The corner of the triangle on the left of an edge.
  std::uint32_t across(std::uint32_t from, std::uint32_t to) const {
    const auto found = across_.find(key(from, to));
    return found == across_.end() ? no_vertex : found->second;
  }

  /// Neighbours anticlockwise; of an open fan from its first edge to its last.
  void find_rings() {
    rings_.resize(positions_.size());
    open_.resize(positions_.size());
    std::vector<std::uint32_t> start(positions_.size(), no_vertex);
    for (const Triangle& t : triangles_)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = t[c], next = t[(c + 1) % 3];
        if (start[v] == no_vertex) start[v] = next;
        if (across(next, v) == no_vertex) start[v] = next, open_[v] = true;  // nothing before this one
      }
    for (std::uint32_t v = 0; v < positions_.size(); ++v)
      for (std::uint32_t at = start[v]; at != no_vertex;) {
        rings_[v].push_back(at);
        at = across(v, at);
        if (at == start[v]) break;
      }
  }

  /// Of each neighbour, in what becomes of a vertex.
  double vertex_share(std::uint32_t v) const {
    const std::size_t n = rings_[v].size();
    return n == 3 ? 3.0 / 16 : 3.0 / (8 * static_cast<double>(std::max<std::size_t>(n, 1)));
  }

  Vector3 smoothed(std::uint32_t v, double share, double open_share) const {
    const std::vector<std::uint32_t>& ring = rings_[v];
    if (ring.empty()) return positions_[v];
    if (open_[v])
      return (1 - 2 * open_share) * positions_[v] +
             open_share * (positions_[ring.front()] + positions_[ring.back()]);
    Vector3 sum;
    for (const std::uint32_t each : ring) sum = sum + positions_[each];
    return (1 - share * static_cast<double>(ring.size())) * positions_[v] + share * sum;
  }

  Vector3 middle_place(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t left = across(a, b), right = across(b, a);
    const Vector3 ends = positions_[a] + positions_[b];
    if (left == no_vertex || right == no_vertex) return 0.5 * ends;
    return 3.0 / 8 * ends + 1.0 / 8 * (positions_[left] + positions_[right]);
  }

  Vector3 normal_at(std::uint32_t v) const {
    const std::vector<std::uint32_t>& ring = rings_[v];
    const std::size_t n = ring.size();
    if (n < 2) return {0, 0, 1};
    const auto at = [&](std::size_t i) { return positions_[ring[i]]; };
    Vector3 one, other;
    if (!open_[v]) {
      for (std::size_t i = 0; i < n; ++i) {
        const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(n);
        one = one + std::cos(angle) * at(i), other = other + std::sin(angle) * at(i);
      }
      return normalised(cross(one, other));
    }
    // Along the edge, and across it: left eigenvectors of what one level does to the vertex and its ring.
    one = at(n - 1) - at(0);
    const Vector3 here = positions_[v];
    if (n == 2) {
      other = at(0) + at(1) - 2 * here;
    } else {
      // Of the eigenvalue 3/8 + cos(step)/4: sin(i step) within; ends and middle follow from it, the sum is
      // 0.
      const double step = pi / static_cast<double>(n - 1), within = 1 / std::tan(step / 2);
      const double end = -(within - std::sin(step)) / (1 + 2 * std::cos(step));
      other = end * (at(0) + at(n - 1)) - (2 * end + within) * here;
      for (std::size_t i = 1; i + 1 < n; ++i) other = other + std::sin(static_cast<double>(i) * step) * at(i);
    }
    return normalised(cross(other, one));
  }

  std::vector<Vector3> positions_;
  std::vector<Triangle> triangles_;
  std::unordered_map<std::uint64_t, std::uint32_t> across_;
  std::vector<std::vector<std::uint32_t>> rings_;
  std::vector<bool> open_;
};

}  // namespace

TriangleMesh loop_surface(const TriangleMesh& mesh, int levels) {
  if (levels < 0 || static_cast<double>(mesh.triangles.size()) * std::pow(4.0, levels) > most_loop_triangles)
    throw InputError(
        fmt::format("{} levels of {} triangles; from 0 on, with at most {:.0f} triangles in the end, "
                    "would be right",
                    levels, mesh.triangles.size(), most_loop_triangles));
  std::vector<Vector3> positions;
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) positions.push_back(mesh.position(i));
  LoopMesh loop(std::move(positions), mesh.triangles);
  for (int level = 0; level < levels; ++level) loop = loop.parted();
  return loop.limit();
}

}  // namespace petzval::render
