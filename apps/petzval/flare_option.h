// SPDX-License-Identifier: BSD-3-Clause
// Light that goes astray in the lens, as commands are asked for it.
#pragma once

#include <petzval/base/staged_files.h>
#include <petzval/simulate/flare.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli11.h"

namespace petzval::app {

struct FlareChoice {
  std::vector<std::string> suns;
  double sun_diameter_deg = Sun().diameter_deg;
  std::string sun_light = Sun().light;
  bool ghosts = false, starburst = false;
  std::string ghost_layer, scatter, scatter_layer, scatter_surround;
  FlareOptions flare = {};

  /// Adds --ghosts, --sun and what belongs to them. \param scene  whether sources are sought among the
  /// samples of a scene.
  void add_to(CLI::App& command, bool scene);
  /// \throws InputError for options that need another, and suns that are none.
  FlareOptions options() const;
  /// Writes the ghosts alone, and the scatter, if that is asked.
  void write(const FlareLayers& layers, StagedFiles& files) const;
};

nlohmann::ordered_json flare_json(const FlareLayers& layers);
inline constexpr const char* scatter_help =
    "Light that the surfaces of the lens scatter: roughness=NM (RMS) or b0=BSDF, l and s (Harvey), "
    "wavelength=NM, or table=FILE.csv; dust=PERCENT of the surface or level=L (IEST-STD-CC1246); separated "
    "by "
    "commas: roughness=1.5,dust=0.02; surfaces whose lens file says it keep their own; lens: as the file "
    "says "
    "alone";
/// What --scatter says: nothing for "lens", which leaves it to the lens. \throws InputError as
/// parse_scatter().
std::optional<Scatter> read_scatter_option(const std::string& text);
/// Lines of a summary.
void print_flare(const FlareLayers& layers);

}  // namespace petzval::app
