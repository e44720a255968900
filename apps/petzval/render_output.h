// SPDX-License-Identifier: BSD-3-Clause
// What `render` writes and tells.
#pragma once

#include <petzval/simulate/render.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "shot_option.h"

namespace petzval::app {

struct RenderOutputs {
  std::vector<std::string> pictures;   ///< of the light, and of what the sensor makes of it
  std::string depth, normals, albedo;  ///< of the first surfaces
  ShotChoice shot;

  void add_to(CLI::App& command);
  bool first_surfaces() const { return !depth.empty() || !normals.empty() || !albedo.empty(); }
  /// \throws InputError for outputs and options that make no sense together. \param command  what add_to was
  /// given.
  OutputOptions checked(const std::optional<Sensor>& sensor, const CLI::App& command) const;
  /// \throws InputError if one of them, or of those, is a file of the scene.
  void keep_off(const std::vector<std::string>& files_of_scene,
                const std::vector<std::pair<std::string, std::string>>& others) const;
  /// Writes all or none. \return what the sensor made of the light.
  Outputs write(const Rendering& picture, const std::optional<Sensor>& sensor, const OutputOptions& options,
                const Context& context) const;
};

/// How long it took.
struct RenderSeconds {
  double prepare = 0, light = 0;
};

nlohmann::ordered_json summary_json(const PreparedScene& scene, const Rendering& picture, const Outputs& made,
                                    const RenderSeconds& seconds, const std::vector<std::string>& outputs);

void print_summary(const PreparedScene& scene, const Rendering& picture, const Outputs& made,
                   const RenderSeconds& seconds);

}  // namespace petzval::app
