// SPDX-License-Identifier: BSD-3-Clause
// What `image` is asked for on the command line.
#pragma once

#include <petzval/simulate/image.h>

#include <string>
#include <vector>

#include "camera_option.h"
#include "flare_option.h"
#include "scene_option.h"
#include "shot_option.h"

namespace petzval::app {

struct ImageChoice {
  SceneChoice scene;
  CameraChoice camera;
  std::string optics;
  std::string method = "product", interpolate = "psf", fit = "monotone", surround = "error";
  ImageOptions image;
  FlareChoice flare;
  ShotChoice shot;
  std::vector<std::string> outputs;

  void add_to(CLI::App& command);
  /// What makes the light alone: the scene, the lens, the sensor, the method.
  void add_light_to(CLI::App& command);
  /// The lens or the stored table, with the sensor. \throws InputError for an output of no known format or in
  /// no folder, and for options of a lens together with a stored table.
  Optics read_optics(const Shared& shared) const;
  /// \throws InputError for options of one method together with another.
  ImageOptions image_options() const;

 private:
  void check() const;
  void add_method_options(CLI::App& command);
};

}  // namespace petzval::app
