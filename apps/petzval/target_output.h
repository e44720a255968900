// SPDX-License-Identifier: BSD-3-Clause
// What a synthetic target is written as.
#pragma once

#include <petzval/base/staged_files.h>
#include <petzval/simulate/target.h>

#include <string>
#include <vector>

#include "command.h"
#include "shot_option.h"

namespace petzval::app {

/// -o, --black, --white, --linear, and what a --sensor makes of the light.
struct TargetOutput {
  std::vector<std::string> paths;
  double black = 0, white = 1;
  bool linear = false;
  ShotChoice shot;

  void add_to(CLI::App& command);
  /// \param command  what add_to was given. \throws InputError for files and options that a target has not.
  void validate(const CLI::App& command) const;
  /// Whether a file holds light or what a sensor makes of it: irradiance (.exr), raw files (.dng) and
  /// developed pictures. The others hold levels.
  bool holds_light(const std::string& path) const;
  /// By extension: .png and .tif of --bits, .npy (float64).
  void write_levels(const std::string& path, const TargetImage& image) const;
  /// All that hold light. \throws InputError as write_outputs().
  void write_light(const TargetRequest& request, StagedFiles& files, const Context& context) const;
};

void print_target_summary(const TargetRequest& request, const std::string& psf, const Otf& otf,
                          const TargetImage& image, const Shared& shared);

}  // namespace petzval::app
