// SPDX-License-Identifier: BSD-3-Clause
// Scenes from text, for tests.
#pragma once

#include <petzval/render/renderer.h>

#include <memory>
#include <string>
#include <vector>

namespace petzval::render {

/// The description of a scene with this text after WorldBegin.
inline SceneDescription described(const std::string& world, const std::string& before = "") {
  Unsupported unsupported;
  return parse_scene_description(before + "\nWorldBegin\n" + world, "test.pbrt", unsupported);
}

/// A world at these wavelengths; lights' tables as they stand.
inline std::unique_ptr<const World> world_of(const std::string& text,
                                             std::vector<double> wavelengths_nm = {450, 550, 650}) {
  Unsupported unsupported;
  return build_world(described(text), WavelengthGroups(std::move(wavelengths_nm)), {true}, unsupported);
}

/// Radiance 1 from everywhere, at every wavelength.
inline const char* const white_furnace = "LightSource \"infinite\" \"spectrum L\" [ 300 1 900 1 ]\n";

}  // namespace petzval::render
