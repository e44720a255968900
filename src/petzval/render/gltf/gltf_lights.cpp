// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/units.h>
#include <petzval/colour/observer.h>
#include <petzval/render/gltf/gltf_extensions.h>
#include <petzval/render/gltf/gltf_lights.h>
#include <petzval/render/pbrt/entity_maker.h>

#include <algorithm>

namespace petzval::render {

namespace {

constexpr const char* lights_extension = "KHR_lights_punctual";

/// A cone from `innerConeAngle` to `outerConeAngle`.
void with_cone(const GltfFile& file, const tinygltf::SpotLight& spot, const std::string& path,
               EntityMaker& maker) {
  const double inner = spot.innerConeAngle, outer = spot.outerConeAngle;
  if (!(inner >= 0 && inner < outer && outer <= pi / 2 + 1e-6))
    throw scene_error(
        file.at(path + ".spot"),
        fmt::format("a cone from {:g} to {:g}; 0 or more, then more than that up to pi/2 would be right",
                    inner, outer));
  maker.number("coneangle", degrees(outer)).number("conedeltaangle", degrees(outer - inner));
}

}  // namespace

void add_gltf_light(const GltfFile& file, const GltfNode& node, Unsupported& unsupported,
                    SceneDescription& scene) {
  GltfExtension extension(file, node.node->extensions, lights_extension, node.path);
  if (!extension.is_there()) return;
  const int index = extension.index("light");
  extension.report_rest(unsupported);
  const tinygltf::Light& light = file.entry(file.model.lights, index, "extensions.KHR_lights_punctual.lights",
                                            extension.path() + ".light");
  const std::string path = fmt::format("extensions.{}.lights[{}]", lights_extension, index);
  const std::vector<double> colour = light.color.empty() ? std::vector<double>{1, 1, 1} : light.color;
  const bool right =
      colour.size() == 3 && std::all_of(colour.begin(), colour.end(), [](double c) { return c >= 0; });
  if (!right) throw scene_error(file.at(path + ".color"), "three numbers, none below 0, would be right");
  if (!(light.intensity >= 0)) throw scene_error(file.at(path + ".intensity"), "0 or more would be right");
  if (light.intensity == 0 || *std::max_element(colour.begin(), colour.end()) == 0) return;

  const bool distant = light.type == "directional", spot = light.type == "spot";
  if (!distant && !spot && light.type != "point")
    return unsupported.report(file.at(path + ".type"), fmt::format("a light of type \"{}\"", light.type));
  EntityMaker maker(distant ? "distant" : light.type, file.at(path));
  maker.rgb(distant ? "L" : "I", {colour[0], colour[1], colour[2]})
      .number("scale", light.intensity / lumens_per_watt);
  if (distant || spot) maker.point("from", {0, 0, 0}).point("to", {0, 0, -1});
  if (spot) with_cone(file, light.spot, path, maker);
  report_gltf_extensions(file, light.extensions, path, {}, unsupported);
  scene.lights.push_back({maker.made(), node.world_from_node});
}

}  // namespace petzval::render
