// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/gltf/gltf_volume.h>
#include <petzval/render/pbrt/entity_maker.h>

#include <algorithm>
#include <limits>

namespace petzval::render {

bool is_gltf_body(GltfExtension& volume) {
  volume.texture("thicknessTexture");  // for renderers that do not follow rays through the mesh
  return volume.number("thicknessFactor", 0, 0, std::numeric_limits<double>::max()) > 0;
}

int add_gltf_volume(const GltfFile& file, GltfExtension& volume, SceneDescription& scene) {
  const std::vector<double> colour = volume.numbers("attenuationColor", {1, 1, 1});
  if (!std::ranges::all_of(colour, [](double each) { return each >= 0 && each <= 1; }))
    throw scene_error(file.at(volume.path() + ".attenuationColor"), "3 numbers from 0 to 1 would be right");
  const bool far = !volume.has("attenuationDistance");
  const double distance = volume.number("attenuationDistance", 1, 0, std::numeric_limits<double>::max());
  if (!(distance > 0))
    throw scene_error(file.at(volume.path() + ".attenuationDistance"), "a number above 0 would be right");
  if (far || !is_gltf_body(volume) || std::ranges::all_of(colour, [](double each) { return each == 1; }))
    return -1;
  const int index = static_cast<int>(scene.media.size());
  scene.media.push_back({fmt::format("gltf {}", index),
                         EntityMaker("homogeneous", file.at(volume.path()))
                             .rgb("attenuation", {colour[0], colour[1], colour[2]})
                             .number("attenuationdistance", distance)
                             .made(),
                         {}});
  return index;
}

}  // namespace petzval::render
