// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/pbrt/parameter_reader.h>
#include <petzval/render/pbrt/scene_reader.h>

namespace petzval::render {

bool SceneReader::follow_option(const std::string& word, Tokens& tokens, const Location& at) {
  if (word == "Camera")
    camera(tokens, at);
  else if (word == "Film")
    scene_.film = entity(tokens, at, "film");
  else if (word == "Sampler")
    scene_.sampler = entity(tokens, at, "sampler");
  else if (word == "Integrator")
    scene_.integrator = entity(tokens, at, "integrator");
  else if (word == "PixelFilter")
    scene_.pixel_filter = entity(tokens, at, "filter");
  else if (word == "Accelerator")
    entity(tokens, at, "accelerator");  // rays meet what they meet, whatever finds it
  else if (word == "ColorSpace") {
    const std::string name = quoted(tokens, at, "colour space");
    if (name != "srgb") unsupported_.report(at, fmt::format("ColorSpace \"{}\"", name));
  } else if (word == "Option") {
    const Parameters parameters = read_parameters(tokens, at);
    for (const Parameter* parameter : parameters.unused())
      if (parameter->name != "seed" && parameter->name != "disablewavelengthjitter")
        unsupported_.report(parameter->at, fmt::format("Option \"{}\"", parameter->name));
  } else
    return false;
  return true;
}

void SceneReader::camera(Tokens& tokens, const Location& at) {
  scene_.camera = entity(tokens, at, "camera");
  scene_.camera_from_world = world_from_object(at);
  scene_.camera_medium = state_.media.outside;
  const MovingTransform& now = state_.world_from_object;
  coordinate_systems_["camera"] = {now.start.inverse(), now.end.inverse()};
}

}  // namespace petzval::render
