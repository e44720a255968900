// SPDX-License-Identifier: BSD-3-Clause
// Options that say how a raw image is developed, for every command that makes pictures of raw images.
#pragma once

#include <petzval/isp/develop.h>

#include <string>
#include <vector>

#include "command.h"

namespace petzval::app {

struct DevelopChoice {
  std::string white_balance = "as-shot", demosaic = "auto", sensor, matrix = "auto", flat, space = "srgb",
              tone = "none";
  bool keep_defects = false;
  double denoise = 0, sharpen = 0, sharpen_radius_px = 1, brightness_ev = 0;
  std::vector<std::string> steps;  ///< NAME=FILE

  /// \param after_image  of `image`, whose --sensor is another.
  void add_to(CLI::App& command, bool after_image = false);
  /// Linear light of the display. Steps are written to where `stage` says that their files go.
  Planes develop(const RawImage& raw, DevelopReport& report,
                 const std::function<std::string(const std::string&)>& stage) const;
};

}  // namespace petzval::app
