// SPDX-License-Identifier: BSD-3-Clause
// What `image` does with its light when the sensor is a whole one: it exposes it, and develops the raw image.
#pragma once

#include <petzval/base/staged_files.h>
#include <petzval/image/spectral_image.h>

#include <optional>
#include <string>
#include <vector>

#include "develop_option.h"
#include "sense_option.h"

namespace petzval::app {

/// What came of it, for the summary.
struct Shot {
  RawImage raw;
  std::optional<DevelopReport> development;  ///< if there is a picture
};

struct ShotChoice {
  SenseChoice sense;
  DevelopChoice develop;
  std::string picture = "auto";
  int bits = 8;

  /// Adds the options of `sense` and `develop`, in groups of their own.
  void add_to(CLI::App& command);
  /// Whether pictures are developed: those of a sensor that turns light into numbers, unless asked otherwise.
  bool develops(const std::optional<Sensor>& sensor) const;
  /// Refuses outputs and options that the sensor makes no sense of. \param command  what add_to was given.
  void check(const std::optional<Sensor>& sensor, const std::vector<std::string>& outputs,
             const CLI::App& command) const;
  /// Writes the raw files among the outputs, and the pictures if they are developed: what `sense` and
  /// `develop` make of the same irradiance, byte for byte. Nothing if there are none.
  std::optional<Shot> shoot(const SpectralImage& light, const std::optional<Sensor>& sensor,
                            const std::vector<std::string>& outputs, StagedFiles& files,
                            const Shared& shared) const;
};

}  // namespace petzval::app
