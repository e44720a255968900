// SPDX-License-Identifier: BSD-3-Clause
// A three-dimensional scene with its camera on the command line, for render and focus.
#pragma once

#include <petzval/render/camera/scene_camera.h>
#include <petzval/render/path_tracer.h>

#include <memory>
#include <optional>
#include <string>

#include "blade_option.h"
#include "command.h"
#include "loss_option.h"

namespace petzval::app {

/// SCENE.pbrt, the lens and how it is used, and the options of rendering that commands share.
struct RenderChoice {
  std::string scene;
  LensChoice lens;
  LossChoice losses;
  bool pinhole = false, absolute_spectra = false, diffraction = false;
  std::string sensor, size, wavelengths, sampling = "exit-pupil", camera_origin = "film";
  std::optional<double> film_diagonal_mm, aperture_diameter_mm, f_number, film_distance_mm, focus_distance_m;
  BladeChoice blades;
  double scene_unit_mm = 1000;
  int max_depth = 0;  ///< 0: as the scene has it
  std::optional<double> near_distance, far_distance;
  std::optional<double> sky_cd_m2;
  bool skip_unsupported = false;

  void add_to(CLI::App& command);
};

/// A scene read, its camera set up and its world built.
struct PreparedScene {
  render::SceneDescription description;
  render::SceneCamera camera;
  std::unique_ptr<const render::World> world;
  render::PathOptions path;
};

/// Reads everything; notes go to stderr unless quiet. \param wavelengths_nm  where --wavelengths is not
/// given.
PreparedScene prepare_scene(const RenderChoice& choice, const std::vector<double>& wavelengths_nm,
                            const Shared& shared);

/// Everything in a scene that is not supported, each with file, line and column.
std::vector<render::Complaint> unsupported_in(const RenderChoice& choice, const Shared& shared);

}  // namespace petzval::app
