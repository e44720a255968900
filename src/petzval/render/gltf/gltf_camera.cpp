// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/units.h>
#include <petzval/render/gltf/gltf_camera.h>
#include <petzval/render/gltf/gltf_extensions.h>
#include <petzval/render/pbrt/entity_maker.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

constexpr int film_rows = 480;
constexpr double default_aspect = 4.0 / 3, default_view_deg = 40;
/// Wider or higher pictures than this are no pictures.
constexpr double most_aspect = 100;

/// glTF's cameras look along −z with +x to the right; ours along +z.
Transform facing_backwards() {
  return Transform::scaling({1, 1, -1});
}

void set_film(double aspect, double view_down_deg, const Location& at, SceneDescription& scene) {
  scene.film = EntityMaker("rgb", at)
                   .whole("xresolution", std::max(1, static_cast<int>(std::lround(aspect * film_rows))))
                   .whole("yresolution", film_rows)
                   .made();
  // "fov" is across the shorter side.
  const double half = std::tan(radians(view_down_deg) / 2) * std::min(aspect, 1.0);
  scene.camera = EntityMaker("perspective", at).number("fov", degrees(2 * std::atan(half))).made();
}

}  // namespace

void add_gltf_camera(const GltfFile& file, const std::vector<GltfNode>& nodes, Unsupported& unsupported,
                     SceneDescription& scene) {
  for (const GltfNode& node : nodes) {
    if (node.node->camera < 0) continue;
    const tinygltf::Camera& camera =
        file.entry(file.model.cameras, node.node->camera, "cameras", node.path + ".camera");
    const std::string path = fmt::format("cameras[{}]", node.node->camera);
    if (camera.type != "perspective") {
      unsupported.report(file.at(path + ".type"), "an orthographic camera");
      continue;
    }
    const double aspect =
        camera.perspective.aspectRatio > 0 ? camera.perspective.aspectRatio : default_aspect;
    const double view_deg = degrees(camera.perspective.yfov);
    if (!(view_deg > 0 && view_deg < 180))
      throw scene_error(file.at(path + ".perspective.yfov"), "an angle above 0 and below pi would be right");
    if (!(aspect <= most_aspect && aspect >= 1 / most_aspect))
      throw scene_error(
          file.at(path + ".perspective.aspectRatio"),
          fmt::format("{:g}; up to {:g}, and no less than its inverse, would be right", aspect, most_aspect));
    set_film(aspect, view_deg, file.at(path), scene);
    scene.camera_from_world = facing_backwards() * node.world_from_node.inverse();
    report_gltf_extensions(file, camera.extensions, path, {}, unsupported);
    return;
  }
  set_film(default_aspect, default_view_deg, file.at(""), scene);
  scene.camera_from_world = facing_backwards();
  scene.has_camera = false;
}

}  // namespace petzval::render
