// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/gltf/gltf_accessors.h>
#include <petzval/render/gltf/gltf_extensions.h>
#include <petzval/render/gltf/gltf_mesh.h>

#include <algorithm>

namespace petzval::render {

namespace {

std::vector<std::uint32_t> read_indices(const GltfFile& file, const tinygltf::Primitive& primitive,
                                        const std::string& path, std::size_t vertices) {
  std::vector<std::uint32_t> indices;
  if (primitive.indices < 0) {
    indices.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) indices[i] = static_cast<std::uint32_t>(i);
    return indices;
  }
  const GltfNumbers numbers = read_accessor(file, primitive.indices, 1, path);
  indices.reserve(numbers.count);
  for (const double index : numbers.values) {
    if (!(index >= 0 && index < static_cast<double>(vertices)))
      throw scene_error(file.at(path),
                        fmt::format("names vertex {}; there are {}, counted from 0", index, vertices));
    indices.push_back(static_cast<std::uint32_t>(index));
  }
  return indices;
}

/// Corners as glTF 2.0, 3.7.2.1 has them, so that all triangles of a strip face the same way.
std::vector<std::array<std::uint32_t, 3>> triangles_of(const std::vector<std::uint32_t>& corners, int mode) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    triangles.reserve(corners.size() / 3);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    return triangles;
  }
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
      triangles.push_back({corners[i + 1], corners[i + 2], corners[0]});
    else
      triangles.push_back({corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
  }
  return triangles;
}

void report_attributes(const GltfFile& file, const tinygltf::Primitive& primitive, const std::string& path,
                       Unsupported& unsupported) {
  for (const auto& [name, accessor] : primitive.attributes) {
    // Normal maps are laid along u, not along tangents; other sets of coordinates may serve nothing.
    const bool known = name == "POSITION" || name == "NORMAL" || name == "TANGENT" || name == "COLOR_0" ||
                       name.starts_with("TEXCOORD_") || name.starts_with('_');
    if (!known)
      unsupported.report(
          file.at(fmt::format("{}.attributes.{}", path, name)),
          name.rfind("COLOR_", 0) == 0 ? "a second colour for every vertex" : "this attribute");
  }
  if (!primitive.targets.empty()) unsupported.report(file.at(path + ".targets"), "a morph target");
  report_gltf_extensions(file, primitive.extensions, path, {}, unsupported);
}

/// COLOR_0, three or four numbers from 0 to 1 a vertex.
std::vector<std::array<float, 4>> read_colours(const GltfFile& file, int index, const std::string& path) {
  const tinygltf::Accessor& accessor = file.entry(file.model.accessors, index, "accessors", path);
  const bool four = accessor.type == TINYGLTF_TYPE_VEC4;
  const GltfNumbers numbers = read_accessor(file, index, four ? 4 : 3, path);
  std::vector<std::array<float, 4>> colours(numbers.count, {1, 1, 1, 1});
  for (std::size_t i = 0; i < numbers.count; ++i)
    for (std::size_t c = 0; c < numbers.components; ++c)
      colours[i][c] = static_cast<float>(std::clamp(numbers.values[i * numbers.components + c], 0.0, 1.0));
  return colours;
}

}  // namespace

std::shared_ptr<const TriangleMesh> read_gltf_triangles(const GltfFile& file,
                                                        const tinygltf::Primitive& primitive,
                                                        const std::string& path, int uv_set,
                                                        Unsupported& unsupported,
                                                        std::vector<std::string>& notes) {
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  report_attributes(file, primitive, path, unsupported);
  if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    notes.push_back(
        fmt::format("{}: points or lines, which have no surface, are left out", file.at(path).text()));
    return nullptr;
  }
  const auto attribute = [&](const std::string& name) {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
  };
  const int position = attribute("POSITION"), normal = attribute("NORMAL");
  const std::string uv_name = fmt::format("TEXCOORD_{}", uv_set);
  const int uv = attribute(uv_name);
  if (position < 0) return nullptr;  // without positions there is nothing to be drawn (3.7.2.1)
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = read_accessor(file, position, 3, path + ".attributes.POSITION").tuples<3>();
  if (normal >= 0) mesh->normals = read_accessor(file, normal, 3, path + ".attributes.NORMAL").tuples<3>();
  if (const int colour = attribute("COLOR_0"); colour >= 0)
    mesh->colours = read_colours(file, colour, path + ".attributes.COLOR_0");
  if (uv >= 0) mesh->uvs = read_accessor(file, uv, 2, path + ".attributes." + uv_name).tuples<2>();
  for (auto& each : mesh->uvs) each[1] = 1 - each[1];
  mesh->triangles =
      triangles_of(read_indices(file, primitive, path + ".indices", mesh->positions.size()), mode);
  try {
    mesh->validate();
  } catch (const InputError& error) {
    throw scene_error(file.at(path), error.what());
  }
  return mesh->triangles.empty() ? nullptr : mesh;
}

}  // namespace petzval::render
