// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/render/lights/alter_lights.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace petzval::render {

namespace {

struct Named {
  const char* name;
  double least, most;
};
/// By LightChange::Kind.
constexpr std::array<Named, 3> kinds = {Named{"scale", 0, 1e12}, Named{"turn_deg", -1e6, 1e6},
                                        Named{"kelvin", 100, 1e6}};

std::string lights_text(const SceneDescription& scene) {
  const std::vector<std::string> lights = lights_of(scene);
  return lights.empty() ? "none" : fmt::format("{}", fmt::join(lights, ", "));
}

/// The axis of the world nearest to the camera's up.
Vector3 upright(const SceneDescription& scene) {
  const Vector3 up = scene.camera_from_world.inverse().direction({0, 1, 0});
  const double x = std::abs(up.x), y = std::abs(up.y), z = std::abs(up.z);
  if (y >= x && y >= z) return {0, std::copysign(1.0, up.y), 0};
  return z >= x ? Vector3{0, 0, std::copysign(1.0, up.z)} : Vector3{std::copysign(1.0, up.x), 0, 0};
}

/// The same with one parameter of this name.
Parameters with(const Parameters& before, Parameter parameter) {
  Parameters after(before.location());
  for (const Parameter& each : before.list())
    if (each.name != parameter.name) after.add(each);
  after.add(std::move(parameter));
  return after;
}

/// As lights_of() counts them.
std::vector<Entity*> entities_of(SceneDescription& scene) {
  std::vector<Entity*> entities;
  for (LightDescription& light : scene.lights) entities.push_back(&light.entity);
  for (Entity& light : scene.area_lights) entities.push_back(&light);
  for (MediumDescription& medium : scene.media)
    if (shines(medium)) entities.push_back(&medium.entity);
  return entities;
}

Parameter number(const Parameters& of, const char* type, const char* name, double value) {
  return {type, name, of.location(), {value}, {}, {}};
}

}  // namespace

bool shines(const MediumDescription& medium) {
  const std::vector<Parameter>& list = medium.entity.parameters.list();
  return std::ranges::any_of(
      list, [](const Parameter& each) { return each.name == "Le" || each.name == "temperature"; });
}

std::vector<std::string> lights_of(const SceneDescription& scene) {
  std::vector<std::string> lights;
  const auto add = [&](const std::string& name, const char* what) {
    lights.push_back(fmt::format("{} {}{}", lights.size(), what, name));
  };
  for (const LightDescription& light : scene.lights) add(light.entity.type, "");
  for (const Entity& light : scene.area_lights) add(light.type, "area ");
  for (const MediumDescription& medium : scene.media)
    if (shines(medium)) add(medium.name, "medium ");
  return lights;
}

std::string LightChange::text() const {
  return fmt::format("{}@{}={}", kinds[static_cast<std::size_t>(kind)].name, light, value);
}

LightChange parse_light_change(std::string_view text) {
  const std::size_t at = text.find('@'), equals = text.find('=');
  LightChange change;
  std::size_t kind = 0;
  while (kind < kinds.size() && text.substr(0, at) != kinds[kind].name) ++kind;
  const auto parsed = equals == text.npos ? std::nullopt : parse_number(text.substr(equals + 1));
  const double value = parsed.value_or(0);
  const char* const end = equals == text.npos ? text.data() : text.data() + equals;
  if (kind == kinds.size() || at == text.npos || equals < at || !parsed ||
      std::from_chars(text.data() + at + 1, end, change.light).ptr != end || at + 1 == equals)
    throw InputError(
        fmt::format("\"{}\" alters no light; write it like scale@0=2, turn_deg@0=30 or kelvin@1=3200", text));
  if (!(value >= kinds[kind].least && value <= kinds[kind].most))
    throw InputError(
        fmt::format("{}: {:g} to {:g} would be right", text, kinds[kind].least, kinds[kind].most));
  change.kind = static_cast<LightChange::Kind>(kind);
  change.value = value;
  return change;
}

void alter_lights(std::span<const LightChange> changes, SceneDescription& scene) {
  const std::size_t sources = scene.lights.size();
  const std::vector<Entity*> lights = entities_of(scene);
  for (const LightChange& change : changes) {
    if (change.light >= lights.size())
      throw InputError(fmt::format("{}: there is no light {}; the scene has {}", change.text(), change.light,
                                   lights_text(scene)));
    const bool is_source = change.light < sources,
               is_medium = change.light >= sources + scene.area_lights.size();
    const char* const scale = is_medium ? strength_of_medium : "scale";
    Parameters& parameters = lights[change.light]->parameters;
    switch (change.kind) {
      case LightChange::Kind::scale:
        parameters =
            with(parameters, number(parameters, "float", scale, parameters.number(scale, 1) * change.value));
        break;
      case LightChange::Kind::kelvin:
        parameters = with(parameters, number(parameters, "blackbody", colour_of_light, change.value));
        break;
      case LightChange::Kind::turn_deg:
        if (!is_source)
          throw InputError(fmt::format("{}: is a {} that shines, which stands where it is; the scene has {}",
                                       change.text(), is_medium ? "medium" : "surface", lights_text(scene)));
        Transform& place = scene.lights[change.light].world_from_light;
        place = Transform::rotation(change.value, upright(scene)) * place;
        break;
    }
  }
}

}  // namespace petzval::render
