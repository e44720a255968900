// SPDX-License-Identifier: BSD-3-Clause
// The sensor that records a synthetic target.
#pragma once

#include <petzval/sensor/sensor.h>
#include <petzval/target/render_target.h>

#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "target_optics.h"

namespace petzval::app {

/// --sensor, --exposure, --gain and --without: photosite, low-pass filter and pitch of a sensor, its noise,
/// its well and its converter.
struct TargetSensor {
  std::string name;
  double exposure_s = 0.01, gain = 1;
  std::vector<std::string> without;

  /// After the options that a sensor settles in their stead.
  void add_to(CLI::App& command);
  /// Reads the sensor, if one is named, and gives the optics its pitch and photosite.
  void prepare(TargetOptics& optics);
  bool is_named() const { return sensor_.has_value(); }
  /// Level 1 is saturation in each pixel, whatever its colour. Comes back as numbers of the converter, over
  /// their range from black to white. \throws InputError for a picture larger than the sensor, and as
  /// capture().
  void expose(TargetImage& image, const Shared& shared) const;

 private:
  std::optional<Sensor> sensor_;
};

}  // namespace petzval::app
