// SPDX-License-Identifier: BSD-3-Clause
// What `render` writes and tells.
#pragma once

#include <petzval/simulate/framing.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "flare_option.h"
#include "shot_option.h"

namespace petzval::app {

struct RenderOutputs {
  std::vector<std::string> pictures;   ///< of the light, and of what the sensor makes of it
  std::string depth, normals, albedo;  ///< of the first surfaces
  std::string segments;                ///< which things they are of
  std::string flow;                    ///< of a camera that moves
  std::string light_groups;            ///< what each light gives, with its number before the extension
  bool layers = false;                 ///< these in every .exr of the light, too
  ShotChoice shot;
  FlareChoice flare;

  void add_to(CLI::App& command);
  bool first_surfaces() const { return layers || !depth.empty() || !normals.empty() || !albedo.empty(); }
  /// \throws InputError for outputs and options that make no sense together. \param command  what add_to was
  /// given.
  OutputOptions checked(const std::optional<Sensor>& sensor, const CLI::App& command) const;
  /// \throws InputError if one of them, or of those, is a file of the scene.
  void keep_off(const std::vector<std::string>& files_of_scene,
                const std::vector<std::pair<std::string, std::string>>& others) const;
  /// Writes all or none. \param layers_of_flare  that the picture has, if any. \return what the sensor made
  /// of the light.
  Outputs write(const Rendering& picture, const PreparedScene& scene, const std::optional<Sensor>& sensor,
                const OutputOptions& options, const Context& context,
                const FlareLayers* layers_of_flare = nullptr) const;
};

/// How long it took.
struct RenderSeconds {
  double prepare = 0, light = 0;
};

nlohmann::ordered_json summary_json(const PreparedScene& scene, const Rendering& picture, const Outputs& made,
                                    const RenderSeconds& seconds, const std::vector<std::string>& outputs);

void print_summary(const PreparedScene& scene, const Rendering& picture, const Outputs& made,
                   const RenderSeconds& seconds);

/// To three digits: "1.53 m", "420 mm", "infinity".
std::string rounded_distance_text(double distance_m);
/// "40 s", "3 min", "2.5 h".
std::string duration_text(double seconds);

}  // namespace petzval::app
