// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/gltf/gltf_nodes.h>

namespace petzval::render {

namespace {

/// \throws InputError unless there are none, or as many as they should be.
bool has_all(const std::vector<double>& values, std::size_t count, const GltfFile& file,
             const std::string& path) {
  if (!values.empty() && values.size() != count)
    throw scene_error(file.at(path), fmt::format("{} numbers; {} would be right", values.size(), count));
  return !values.empty();
}

/// By a unit quaternion x, y, z, w.
Transform rotation(const std::vector<double>& q) {
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(norm > 0)) throw InputError("a quaternion without length; a length of 1 would be right");
  const double x = q[0] / norm, y = q[1] / norm, z = q[2] / norm, w = q[3] / norm;
  return Transform(Matrix4{{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0},
                            {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0},
                            {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0},
                            {0, 0, 0, 1}}});
}

Transform by_matrix(const std::vector<double>& columns) {
  Matrix4 matrix;
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column) matrix[row][column] = columns[4 * column + row];
  Transform transform(matrix);
  if (!transform.is_affine()) throw InputError("the last row of the matrix is not 0 0 0 1");
  return transform;
}

Transform parent_from_node(const GltfFile& file, const tinygltf::Node& node, const std::string& path) {
  if (has_all(node.matrix, 16, file, path + ".matrix")) return by_matrix(node.matrix);
  Transform transform;
  if (has_all(node.translation, 3, file, path + ".translation"))
    transform = Transform::translation({node.translation[0], node.translation[1], node.translation[2]});
  if (has_all(node.rotation, 4, file, path + ".rotation")) transform = transform * rotation(node.rotation);
  if (has_all(node.scale, 3, file, path + ".scale"))
    transform = transform * Transform::scaling({node.scale[0], node.scale[1], node.scale[2]});
  return transform;
}

/// \throws InputError if its own transformation, or all of them together, cannot be inverted.
Transform world_from_node(const GltfFile& file, const Transform& world_from_parent,
                          const tinygltf::Node& node, const std::string& path) {
  try {
    return Transform((world_from_parent * parent_from_node(file, node, path)).matrix());
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.rfind(*file.name, 0) == 0) throw;  // has its place
    throw scene_error(file.at(path), what);
  }
}

}  // namespace

std::vector<GltfNode> gltf_nodes(const GltfFile& file) {
  const tinygltf::Model& model = file.model;
  if (model.scenes.empty()) throw scene_error(file.at("scenes"), "the file holds no scene");
  const int chosen = std::max(model.defaultScene, 0);
  const tinygltf::Scene& scene = file.entry(model.scenes, chosen, "scenes", "scene");

  struct Waiting {
    int index;
    Transform world_from_parent;
    std::string named_at;
  };
  std::vector<Waiting> waiting;
  const auto add = [&](const std::vector<int>& list, const Transform& parent, const std::string& path) {
    for (std::size_t i = list.size(); i-- > 0;)
      waiting.push_back({list[i], parent, fmt::format("{}[{}]", path, i)});
  };
  add(scene.nodes, Transform(), fmt::format("scenes[{}].nodes", chosen));
  std::vector<bool> seen(model.nodes.size());
  std::vector<GltfNode> nodes;
  while (!waiting.empty()) {
    const Waiting next = std::move(waiting.back());
    waiting.pop_back();
    const tinygltf::Node& node = file.entry(model.nodes, next.index, "nodes", next.named_at);
    if (seen[static_cast<std::size_t>(next.index)])
      throw scene_error(
          file.at(next.named_at),
          fmt::format("nodes[{}] has a place in the scene already; one parent would be right", next.index));
    seen[static_cast<std::size_t>(next.index)] = true;
    const std::string path = fmt::format("nodes[{}]", next.index);
    nodes.push_back({next.index, &node, path, world_from_node(file, next.world_from_parent, node, path)});
    add(node.children, nodes.back().world_from_node, path + ".children");
  }
  return nodes;
}

}  // namespace petzval::render
