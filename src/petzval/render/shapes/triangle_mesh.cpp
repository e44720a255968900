// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/stop.h>
#include <petzval/render/shapes/loop_subdivision.h>
#include <petzval/render/shapes/triangle_mesh.h>

#include <cmath>

namespace petzval::render {

namespace {

/// Pieces a side of a patch that is not flat.
constexpr int patch_pieces = 16;
/// A patch counts as flat when its corners lie this near (relative) to a parallelogram, where a bilinear
/// patch and two triangles are the same surface with the same texture coordinates.
constexpr double flat_patch = 1e-6;

template <std::size_t Size>
std::vector<std::array<float, Size>> tuples(const Parameters& parameters, const std::string& name,
                                            std::initializer_list<const char*> types) {
  const std::vector<double> numbers = parameters.numbers(name, types);
  if (numbers.size() % Size != 0)
    throw scene_error(
        parameters.location_of(name),
        fmt::format("\"{}\" has {} numbers; a multiple of {} would be right", name, numbers.size(), Size));
  std::vector<std::array<float, Size>> result(numbers.size() / Size);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    result[i / Size][i % Size] = static_cast<float>(numbers[i]);
  return result;
}

std::vector<std::uint32_t> indices(const Parameters& parameters, std::size_t each, std::size_t vertices) {
  std::vector<std::uint32_t> result;
  for (const int index : parameters.integers("indices")) {
    if (index < 0 || static_cast<std::size_t>(index) >= vertices)
      throw scene_error(
          parameters.location_of("indices"),
          fmt::format("\"indices\" names vertex {}; there are {}, counted from 0", index, vertices));
    result.push_back(static_cast<std::uint32_t>(index));
  }
  if (result.empty() && vertices == each)
    for (std::uint32_t i = 0; i < each; ++i) result.push_back(i);
  if (result.empty() || result.size() % each != 0)
    throw scene_error(parameters.location(),
                      fmt::format("the mesh has {} indices; a positive multiple of {} would be right",
                                  result.size(), each));
  return result;
}

void read_vertices(const Parameters& parameters, TriangleMesh& mesh) {
  mesh.positions = tuples<3>(parameters, "P", {"point3", "point"});
  mesh.normals = tuples<3>(parameters, "N", {"normal", "normal3"});
  mesh.uvs = tuples<2>(parameters, "uv", {"point2", "float", "vector2"});
  if (mesh.uvs.empty()) mesh.uvs = tuples<2>(parameters, "st", {"point2", "float", "vector2"});
  if (mesh.positions.empty()) throw scene_error(parameters.location(), "the mesh has no \"point3 P\"");
  parameters.find("S");  // tangents: no material here needs them
  parameters.find("faceIndices");
}

/// One patch with corners p00, p10, p01, p11.
struct Patch {
  std::array<Vector3, 4> p;

  Vector3 at(double u, double v) const {
    return (1 - u) * (1 - v) * p[0] + u * (1 - v) * p[1] + (1 - u) * v * p[2] + u * v * p[3];
  }
  Vector3 normal(double u, double v) const {
    const Vector3 du = (1 - v) * (p[1] - p[0]) + v * (p[3] - p[2]),
                  dv = (1 - u) * (p[2] - p[0]) + u * (p[3] - p[1]);
    return normalised(cross(du, dv));
  }
  bool is_flat() const {
    return length(p[0] - p[1] - p[2] + p[3]) <= flat_patch * (length(p[1] - p[0]) + length(p[2] - p[0]));
  }
};

void add_patch(const TriangleMesh& corners, const std::array<std::uint32_t, 4>& index, TriangleMesh& mesh) {
  Patch patch;
  for (std::size_t i = 0; i < 4; ++i) patch.p[i] = corners.position(index[i]);
  const int pieces = patch.is_flat() ? 1 : patch_pieces;
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int j = 0; j <= pieces; ++j)
    for (int i = 0; i <= pieces; ++i) {
      const double u = static_cast<double>(i) / pieces, v = static_cast<double>(j) / pieces;
      const std::array<double, 4> share{(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
      mesh.positions.push_back(mesh_vertex(patch.at(u, v)));
      Vector3 normal = patch.normal(u, v);
      if (!corners.normals.empty()) {
        normal = {};
        for (std::size_t c = 0; c < 4; ++c) {
          const TriangleMesh::Vertex& n = corners.normals[index[c]];
          normal = normal + share[c] * Vector3{n[0], n[1], n[2]};
        }
      }
      mesh.normals.push_back(mesh_vertex(normal));
      std::array<double, 2> uv{u, v};
      if (!corners.uvs.empty()) {
        uv = {};
        for (std::size_t c = 0; c < 4; ++c)
          for (std::size_t k = 0; k < 2; ++k)
            uv[k] += share[c] * static_cast<double>(corners.uvs[index[c]][k]);
      }
      mesh.uvs.push_back({static_cast<float>(uv[0]), static_cast<float>(uv[1])});
    }
  const auto row = static_cast<std::uint32_t>(pieces + 1);
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(pieces); ++j)
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(pieces); ++i) {
      const std::uint32_t a = first + j * row + i;
      mesh.triangles.push_back({a, a + 1, a + row + 1});
      mesh.triangles.push_back({a, a + row + 1, a + row});
    }
}

TriangleMesh read_bilinear(const Parameters& parameters) {
  TriangleMesh corners, mesh;
  read_vertices(parameters, corners);
  const std::vector<std::uint32_t> index = indices(parameters, 4, corners.positions.size());
  corners.validate();
  for (std::size_t i = 0; i < index.size(); i += 4)
    add_patch(corners, {index[i], index[i + 1], index[i + 2], index[i + 3]}, mesh);
  return mesh;
}

TriangleMesh read_triangles(const Parameters& parameters) {
  TriangleMesh mesh;
  read_vertices(parameters, mesh);
  const std::vector<std::uint32_t> index = indices(parameters, 3, mesh.positions.size());
  for (std::size_t i = 0; i < index.size(); i += 3)
    mesh.triangles.push_back({index[i], index[i + 1], index[i + 2]});
  return mesh;
}

TriangleMesh read_loop_surface(const Parameters& parameters) {
  constexpr int usual_levels = 3;
  const int levels = parameters.integer("levels", parameters.integer("nlevels", usual_levels));
  parameters.find("nlevels"), parameters.choice("scheme", "loop", {"loop"});
  const TriangleMesh coarse = read_triangles(parameters);
  try {
    coarse.validate();
    return loop_surface(coarse, levels);
  } catch (const InputError& error) {
    throw scene_error(parameters.location(), error.what());
  }
}

TriangleMesh read_ply_shape(const Parameters& parameters, Unsupported& unsupported) {
  const std::string name = parameters.string("filename", "");
  if (name.empty()) throw scene_error(parameters.location(), "a plymesh needs a \"string filename\"");
  if (const Parameter* displacement = parameters.find("displacement"))
    unsupported.report(displacement->at, "displacement of a mesh");
  parameters.find("edgelength");
  try {
    return read_ply(resolved_path(parameters.location(), name));
  } catch (const InputError& error) {
    throw scene_error(parameters.location_of("filename"), error.what());
  }
}

}  // namespace

Vector3 TriangleMesh::position(std::uint32_t index) const {
  const Vertex& p = positions[index];
  return {p[0], p[1], p[2]};
}

std::array<Vector3, 3> TriangleMesh::corners(std::size_t triangle) const {
  const auto& index = triangles[triangle];
  return {position(index[0]), position(index[1]), position(index[2])};
}

double TriangleMesh::area(std::size_t triangle) const {
  const auto [a, b, c] = corners(triangle);
  return length(cross(b - a, c - a)) / 2;
}

void TriangleMesh::transform(const Transform& to) {
  check_stop();
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = mesh_vertex(to.point(position(static_cast<std::uint32_t>(i))));
  for (Vertex& n : normals) n = mesh_vertex(normalised(to.normal({n[0], n[1], n[2]})));
  validate();
}

void TriangleMesh::validate() const {
  check_stop();
  const auto finite = [](const auto& list, const char* what) {
    for (std::size_t i = 0; i < list.size(); ++i)
      for (const float value : list[i])
        if (!std::isfinite(value)) throw InputError(fmt::format("{} {} of the mesh is not finite", what, i));
  };
  finite(positions, "vertex");
  finite(normals, "normal");
  finite(uvs, "texture coordinate");
  finite(colours, "colour");
  const auto fits = [&](const auto& list) { return list.empty() || list.size() == positions.size(); };
  if (!fits(normals) || !fits(uvs) || !fits(colours))
    throw InputError(fmt::format(
        "the mesh has {} vertices, {} normals, {} texture coordinates and {} colours; one or none "
        "a vertex would be right",
        positions.size(), normals.size(), uvs.size(), colours.size()));
  for (const auto& triangle : triangles)
    for (const std::uint32_t index : triangle)
      if (index >= positions.size())
        throw InputError(
            fmt::format("the mesh names vertex {}; there are {}, counted from 0", index, positions.size()));
}

TriangleMesh read_triangle_mesh(const ShapeDescription& shape, Unsupported& unsupported) {
  const Parameters& parameters = shape.entity.parameters;
  TriangleMesh mesh = shape.mesh                            ? *shape.mesh
                      : shape.entity.type == "plymesh"      ? read_ply_shape(parameters, unsupported)
                      : shape.entity.type == "bilinearmesh" ? read_bilinear(parameters)
                      : shape.entity.type == "loopsubdiv"   ? read_loop_surface(parameters)
                                                            : read_triangles(parameters);
  try {
    mesh.validate();
    mesh.transform(shape.world_from_object);
  } catch (const InputError& error) {
    throw scene_error(parameters.location(), error.what());
  }
  return mesh;
}

}  // namespace petzval::render
