// SPDX-License-Identifier: BSD-3-Clause
// What `image` is asked for on the command line.
#pragma once

#include <petzval/imaging/depth_layers.h>
#include <petzval/imaging/image_formation.h>

#include <optional>
#include <string>
#include <vector>

#include "field_option.h"
#include "scene_option.h"
#include "shot_option.h"

namespace petzval::app {

struct ImageChoice {
  SceneChoice scene;
  LensChoice lens;
  FieldChoice apertures;  ///< only --apertures and --ignore-apertures of it
  std::string optics, sensor;
  std::vector<std::string> sensor_settings;
  std::string focus = "auto", method = "product", interpolate = "psf", fit = "monotone", surround = "error";
  std::optional<double> f_number, scene_angle_least;
  SectionOptions sections;
  ProductOptions product;
  int supersample = 1;
  DepthOptions depth;
  ShotChoice shot;
  std::vector<std::string> outputs;

  void add_to(CLI::App& command);
  /// \throws InputError for an output of no known format or in no folder, and for options of a lens together
  /// with a stored table.
  void check() const;
  /// \throws InputError for options of one method together with another.
  ImagingOptions imaging_options() const;

 private:
  void add_lens_options(CLI::App& command);
  void add_method_options(CLI::App& command);
};

}  // namespace petzval::app
