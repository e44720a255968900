// SPDX-License-Identifier: BSD-3-Clause
// A three-dimensional scene with its camera on the command line, for render and focus.
#pragma once

#include <petzval/simulate/render.h>

#include <optional>
#include <string>
#include <vector>

#include "camera_option.h"

namespace petzval::app {

/// How a camera focuses by itself.
struct AutofocusChoice {
  std::string zones_file;
  std::vector<std::string> zones;  ///< "left,right,top,bottom" each
  std::string measure = "gradient", search = "brent";
  AutofocusOptions options;

  /// Everything but the file of zones, whose option has a name of its own in each command.
  void add_to(CLI::App& command);
  AutofocusOptions read() const;
};

/// SCENE.pbrt, the lens and how it is used, and the options of rendering that commands share.
struct RenderChoice {
  RenderRequest request;  ///< what options say as they stand
  CameraChoice camera;
  AutofocusChoice autofocus;
  std::string camera_at, look_at, camera_move, look_move;
  std::string size, wavelengths, sampling = "exit-pupil", camera_origin = "film";

  void add_to(CLI::App& command);
  /// Reads lens and sensor; their notes go to stderr unless quiet. \throws InputError.
  RenderRequest read(const Shared& shared) const;
};

}  // namespace petzval::app
