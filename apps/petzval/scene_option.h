// SPDX-License-Identifier: BSD-3-Clause
// A scene on the command line.
#pragma once

#include <petzval/simulate/image.h>

#include <optional>
#include <string>

#include "command.h"

namespace petzval::app {

/// SCENE with --scene-angle, --scene-distance, --scene-luminance, --scene-size, --wavelengths,
/// --illuminant and --scene-encoding.
struct SceneChoice {
  std::string path_or_name;
  /// As typed; empty: not given.
  std::string angle, distance, luminance, size, wavelengths, illuminant, illuminance, band_width, encoding;
  std::string projection, yaw, pitch, width, tilt;
  std::string depth, depth_scale, depth_from;
  std::string quantity, unit, scale, file_bands, temperature, emissivity, background;
  bool negative_is_zero = false;

  /// Adds the positional SCENE (or `--scene` when `positional` is false) and the options.
  void add_to(CLI::App& command, bool positional = true, bool required = true);
  /// What the user said, and `defaults` where nothing was said. (A size of a command's own choosing must not
  /// be among the defaults of a scene that is a file: see is_chart().) \throws InputError naming the option
  /// that is wrong.
  SceneOptions options(SceneOptions defaults = {}) const;
  SceneRequest request() const { return {path_or_name, options()}; }
  /// Reads the scene with these options.
  Scene read(const SceneOptions& defaults = {}) const { return read_scene(path_or_name, options(defaults)); }
  /// Reads it and prints its notes.
  Scene read(const Shared& shared) const;
  void print_notes(const Scene& scene, const Shared& shared) const;
  /// Whether the scene is a chart, which can be made in any size.
  bool is_chart() const { return is_builtin_scene(path_or_name); }
  /// Whether it is a chart that has depth of its own.
  bool is_deep() const { return is_deep_chart(path_or_name); }
  bool is_panorama() const { return projection == "equirectangular"; }
  /// Whether it takes any angle and distance: a chart or a photograph on a plane.
  bool is_open() const { return !is_panorama() && is_open_scene(path_or_name); }

 private:
  void add_cube_options(CLI::App& command);
  void take_illuminance(SceneOptions& options) const;
  void take_panorama(SceneOptions& options) const;
  void take_cube(SceneOptions& options) const;
};

}  // namespace petzval::app
