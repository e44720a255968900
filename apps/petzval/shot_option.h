// SPDX-License-Identifier: BSD-3-Clause
// What a command does with the light that it makes: it keeps it, exposes the sensor to it, develops the raw
// image.
#pragma once

#include <petzval/simulate/outputs.h>

#include <optional>
#include <string>
#include <vector>

#include "develop_option.h"
#include "sense_option.h"

namespace petzval::app {

struct ShotChoice {
  SenseChoice sense;
  DevelopChoice develop;
  std::string picture = "auto";
  int bits = 8;
  std::optional<double> white;
  std::string display = "linear";
  std::vector<std::string> insets;

  /// Adds --picture, --bits, and the options of `sense` and `develop`, in groups of their
  /// own.
  void add_to(CLI::App& command);
  /// Adds --white and --display, of pictures of the light itself.
  void add_display_to(CLI::App& command);
  OutputOptions options() const;
  /// The options, tried on outputs and sensor. \param command  what add_to was given. \throws InputError for
  /// outputs and options that the sensor makes no sense of.
  OutputOptions checked(const std::optional<Sensor>& sensor, const std::vector<std::string>& outputs,
                        const CLI::App& command) const;
  /// \throws InputError for an option of the development without a developed picture, and for an inset
  /// without a picture that takes one.
  void refuse_unused(const CLI::App& command, bool developed, bool insettable) const;

 private:
  bool shows_light_ = false;
};

}  // namespace petzval::app
