// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/gltf/gltf_camera.h>
#include <petzval/render/gltf/gltf_extensions.h>
#include <petzval/render/gltf/gltf_lights.h>
#include <petzval/render/gltf/gltf_materials.h>
#include <petzval/render/gltf/gltf_mesh.h>
#include <petzval/render/gltf/gltf_scene.h>
#include <petzval/render/pbrt/entity_maker.h>

#include <algorithm>
#include <limits>

namespace petzval::render {

namespace {

/// What a file may require of its reader.
constexpr std::initializer_list<const char*> known_extensions{
    "KHR_lights_punctual",  "KHR_materials_emissive_strength", "KHR_materials_clearcoat",
    "KHR_materials_ior",    "KHR_materials_specular",          "KHR_materials_transmission",
    "KHR_materials_volume", "KHR_mesh_quantization",           "KHR_texture_transform"};

void report_file(const GltfFile& file, Unsupported& unsupported) {
  const tinygltf::Model& model = file.model;
  if (model.asset.version.rfind("2.", 0) != 0)
    throw scene_error(file.at("asset.version"),
                      fmt::format("glTF {}; 2.0 would be right", model.asset.version.substr(0, 20)));
  for (std::size_t i = 0; i < model.extensionsRequired.size(); ++i) {
    const std::string& name = model.extensionsRequired[i];
    if (std::find(known_extensions.begin(), known_extensions.end(), name) == known_extensions.end())
      unsupported.report(file.at(fmt::format("extensionsRequired[{}]", i)),
                         fmt::format("the extension {}", name));
  }
  for (std::size_t i = 0; i < model.animations.size(); ++i)
    unsupported.report(file.at(fmt::format("animations[{}]", i)), "motion");
  for (const auto& [name, value] : model.extensions)
    if (name != "KHR_lights_punctual") unsupported.report(file.at("extensions." + name), "this extension");
}

/// Turns the meshes of nodes into shapes: those that several nodes show into objects.
class MeshPlacer {
 public:
  MeshPlacer(const GltfFile& file, const std::vector<GltfNode>& nodes, SceneDescription& scene,
             Unsupported& unsupported)
      : file_(file),
        nodes_(nodes),
        scene_(scene),
        unsupported_(unsupported),
        materials_(file, scene, unsupported),
        uses_(file.model.meshes.size()),
        shapes_(file.model.meshes.size()),
        objects_(file.model.meshes.size(), -1) {}

  void place_all() {
    for (const GltfNode& node : nodes_)
      if (node.node->mesh >= 0) {
        file_.entry(file_.model.meshes, node.node->mesh, "meshes", node.path + ".mesh");
        if (++uses_[static_cast<std::size_t>(node.node->mesh)] == 1) read(node.node->mesh);
      }
    for (const GltfNode& node : nodes_)
      if (node.node->mesh >= 0) place(node);
  }

 private:
  void read(int index) {
    const tinygltf::Mesh& mesh = file_.model.meshes[static_cast<std::size_t>(index)];
    report_gltf_extensions(file_, mesh.extensions, fmt::format("meshes[{}]", index), {}, unsupported_);
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const tinygltf::Primitive& primitive = mesh.primitives[i];
      const std::string path = fmt::format("meshes[{}].primitives[{}]", index, i);
      const bool tinted = primitive.attributes.count("COLOR_0") > 0;
      const GltfSurface surface = materials_.surface(primitive.material, tinted, path);
      ShapeDescription shape;
      shape.entity = mesh_entity(surface, tinted, path);
      shape.material = surface.material, shape.area_light = surface.area_light;
      shape.media.inside = surface.medium;
      shape.mesh = read_gltf_triangles(file_, primitive, path, std::max(surface.uv_set, 0), unsupported_,
                                       scene_.notes);
      if (!shape.mesh) continue;
      if (surface.uv_set >= 0 && shape.mesh->uvs.empty())
        throw scene_error(
            file_.at(path + ".attributes"),
            fmt::format("its material has a texture; TEXCOORD_{} would be right", surface.uv_set));
      shapes_[static_cast<std::size_t>(index)].push_back(std::move(shape));
    }
  }

  Entity mesh_entity(const GltfSurface& surface, bool tinted, const std::string& path) const {
    EntityMaker entity("mesh", file_.at(path));
    if (!surface.see_through) return entity.made();
    if (!surface.opacity_texture.empty())
      entity.texture("alpha", surface.opacity_texture);
    else if (tinted || surface.opacity < std::max(1.0, surface.cutoff.value_or(1)))
      entity.number("alpha", surface.opacity);
    if (surface.cutoff) entity.number("alphacutoff", *surface.cutoff);
    return entity.made();
  }

  void place(const GltfNode& node) {
    const auto index = static_cast<std::size_t>(node.node->mesh);
    const bool often = uses_[index] > 1;
    for (const ShapeDescription& shape : shapes_[index]) {
      if (often && shape.area_light < 0) continue;  // what shines must be a shape of its own
      scene_.shapes.push_back(shape);
      scene_.shapes.back().world_from_object = node.world_from_node;
    }
    if (often) place_object(index, node);
  }

  void place_object(std::size_t index, const GltfNode& node) {
    if (objects_[index] < 0) {
      std::vector<ShapeDescription> object;
      for (const ShapeDescription& shape : shapes_[index])
        if (shape.area_light < 0) object.push_back(shape);
      if (object.empty()) return;
      objects_[index] = static_cast<int>(scene_.objects.size());
      scene_.objects.push_back(std::move(object));
    }
    scene_.instances.push_back({objects_[index], node.world_from_node, file_.at(node.path)});
  }

  const GltfFile& file_;
  const std::vector<GltfNode>& nodes_;
  SceneDescription& scene_;
  Unsupported& unsupported_;
  GltfMaterials materials_;
  std::vector<int> uses_;                              ///< by nodes, of each mesh
  std::vector<std::vector<ShapeDescription>> shapes_;  ///< of each mesh, its place still open
  std::vector<int> objects_;                           ///< into SceneDescription::objects; −1: none yet
};

void report_node(const GltfFile& file, const GltfNode& node, Unsupported& unsupported) {
  if (node.node->skin >= 0) unsupported.report(file.at(node.path + ".skin"), "a skin that bones move");
  report_gltf_extensions(file, node.node->extensions, node.path, {"KHR_lights_punctual"}, unsupported);
}

}  // namespace

bool has_gltf_name(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == ".gltf" || extension == ".glb";
}

SceneDescription parse_gltf_scene(const std::string& bytes, const std::string& path,
                                  Unsupported& unsupported) {
  const GltfFile file = parse_gltf(bytes, path);
  SceneDescription scene;
  scene.file = path;
  scene.files = {path};
  scene.files.insert(scene.files.end(), file.files.begin(), file.files.end());
  scene.materials.push_back({"diffuse", {}});
  report_file(file, unsupported);
  const std::vector<GltfNode> nodes = gltf_nodes(file);
  for (const GltfNode& node : nodes) {
    report_node(file, node, unsupported);
    add_gltf_light(file, node, unsupported, scene);
  }
  MeshPlacer placer(file, nodes, scene, unsupported);
  placer.place_all();
  add_gltf_camera(file, nodes, unsupported, scene);
  return scene;
}

SceneDescription read_gltf_scene(const std::string& path, Unsupported& unsupported) {
  return parse_gltf_scene(read_whole_file(path), path, unsupported);
}

}  // namespace petzval::render
