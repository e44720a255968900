// SPDX-License-Identifier: BSD-3-Clause
// Options that say how a sensor is exposed, for every command that makes raw images.
#pragma once

#include <petzval/image/spectral_image.h>
#include <petzval/sensor/capture.h>

#include <optional>
#include <string>
#include <vector>

#include "command.h"

namespace petzval::app {

struct SenseChoice {
  std::string exposure = "auto", metering = "highlights", conversion_gain, illuminant;
  double compensation_ev = 0, gain = 1;
  std::optional<double> temperature_c, exit_pupil_mm, f_number;
  std::optional<std::uint64_t> serial;
  std::vector<std::string> without;
  std::vector<double> bracket_ev;
  int frames = 1;

  /// \param after_image  of `image`, which has an --f-number and an --illuminant of its own.
  void add_to(CLI::App& command, bool after_image = false);
  /// Exposes the sensor to the light; complete with colours, white balance and facts of the lens.
  RawImage expose(const SpectralImage& image, const Sensor& sensor, const Shared& shared) const;
};

}  // namespace petzval::app
