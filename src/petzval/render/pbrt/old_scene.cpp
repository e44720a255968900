// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/pbrt/old_scene.h>

#include <algorithm>
#include <map>
#include <optional>

namespace petzval::render {

namespace {

using Names = std::map<std::string, std::string>;

/// One material of old, and what its parameters are called now. Those of `plain` are dropped where all their
/// numbers are `as_plain`, as they usually are.
struct OldMaterial {
  const char* now;
  Names parameters;
  const char* colour = nullptr;  ///< the parameter that is 1 where the scene has none
  std::map<std::string, double> plain = {};
};

const std::map<std::string, OldMaterial>& old_materials() {
  static const std::map<std::string, OldMaterial> materials{
      {"matte", {"diffuse", {{"Kd", "reflectance"}}, "reflectance", {{"sigma", 0}}}},
      {"mirror", {"conductor", {{"Kr", "reflectance"}}, "reflectance"}},
      {"glass", {"dielectric", {{"index", "eta"}}, nullptr, {{"Kr", 1}, {"Kt", 1}}}},
      {"plastic", {"coateddiffuse", {{"Kd", "reflectance"}}, "reflectance", {{"Ks", 1}}}},
      {"shinymetal", {"conductor", {{"Kr", "reflectance"}}, "reflectance", {{"Ks", 1}}}},
      {"metal", {"conductor", {}}}};
  return materials;
}

bool is_plain(const Parameter& parameter, double as_plain) {
  return !parameter.numbers.empty() && std::all_of(parameter.numbers.begin(), parameter.numbers.end(),
                                                   [&](double x) { return x == as_plain; });
}

Parameters renamed(const Parameters& parameters, const OldMaterial& old) {
  Parameters result(parameters.location());
  bool coloured = false;
  for (Parameter each : parameters.list()) {
    const auto plain = old.plain.find(each.name);
    if (plain != old.plain.end() && is_plain(each, plain->second)) continue;
    const auto now = old.parameters.find(each.name);
    if (now != old.parameters.end()) each.name = now->second;
    if (each.name == "type") each.strings = {old.now};
    coloured = coloured || (old.colour && each.name == old.colour);
    result.add(std::move(each));
  }
  if (old.colour && !coloured) result.add({"rgb", old.colour, parameters.location(), {1, 1, 1}, {}, {}});
  return result;
}

Parameters without(const Parameters& parameters, std::initializer_list<const char*> names) {
  Parameters result(parameters.location());
  for (const Parameter& each : parameters.list())
    if (std::find(names.begin(), names.end(), each.name) == names.end()) result.add(each);
  return result;
}

}  // namespace

void translate_old_scene(SceneDescription& scene) {
  scene.notes.push_back(
      "a scene of pbrt before version 4: its materials are the nearest of version 4, its light is scaled as "
      "there");
  for (Entity& material : scene.materials) {
    const auto old = old_materials().find(material.type);
    if (old == old_materials().end()) continue;
    material.type = old->second.now;
    material.parameters = renamed(material.parameters, old->second);
  }
  for (Entity& light : scene.area_lights) {
    if (light.type == "area") light.type = "diffuse";
    light.parameters = without(light.parameters, {"nsamples", "samples"});
  }
  for (LightDescription& light : scene.lights)
    light.entity.parameters = without(light.entity.parameters, {"nsamples", "samples"});
  scene.film.parameters = without(scene.film.parameters,
                                  {"premultiplyalpha", "writefrequency", "display", "gamma", "bloomwidth"});
  // How paths end, and how much the old program cached.
  if (scene.integrator.type == "directlighting" || scene.integrator.type == "whitted")
    scene.integrator.type = "path";
}

}  // namespace petzval::render
