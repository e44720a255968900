// SPDX-License-Identifier: BSD-3-Clause
// Autofocus on a three-dimensional scene: joins the search to the renderer.
#pragma once

#include <petzval/focus/autofocus.h>

#include <optional>
#include <string>
#include <vector>

#include "render_option.h"

namespace petzval::app {

struct FocusChoice {
  std::string zones_file;
  std::vector<std::string> zones;  ///< "left,right,top,bottom" each
  std::string measure = "gradient", search = "brent";
  int step = 1, samples = 16, most_evaluations = 12;
  double threshold = 0;
  std::optional<double> from_mm, to_mm, depth_mm;

  /// Everything but where the zones come from.
  void add_to(CLI::App& command);
};

/// The zones of the file and of the command line; the middle ninth of the film if there are none.
std::vector<FocusZone> focus_zones(const FocusChoice& choice);

/// A search, and what it took.
struct FocusRun {
  FocusResult result;
  double depth_mm = 0;  ///< of focus: f-number × pixel, unless it was given
  std::uint64_t camera_rays = 0;
};

/// Searches for the film distance. Only the zones are rendered, twice over with different random numbers so
/// that noise cancels in the measure, and with the same random numbers for every film distance. \param scene
/// its camera has a lens. \throws InputError
FocusRun autofocus(const PreparedScene& scene, const FocusChoice& choice, const Shared& shared);

/// Eight wavelengths, which one path serves.
std::vector<double> focus_wavelengths_nm();

}  // namespace petzval::app
