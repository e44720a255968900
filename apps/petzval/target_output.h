// SPDX-License-Identifier: BSD-3-Clause
// What a synthetic target is written as.
#pragma once

#include <petzval/target/render_target.h>

#include <string>
#include <vector>

#include "command.h"
#include "target_optics.h"

namespace petzval::app {

/// -o, --black, --white, --bits and --linear.
struct TargetOutput {
  std::vector<std::string> paths;
  double black = 0, white = 1;
  int bits = 8;
  bool linear = false;

  void add_to(CLI::App& command);
  void validate() const;
  /// 0 becomes black and 1 white.
  void to_levels(TargetImage& image) const;
  /// By extension: .png and .tif of --bits, .npy (float64), .exr (float, with pitch and wavelength).
  void write(const std::string& path, const TargetImage& image, const TargetOptics& optics) const;
};

/// A row for every edge and frequency: polygon, edge, angle_deg, length_px, frequency_cpp, sfr (signed).
void write_exact_sfr(const std::string& path, const TargetScene& scene, const Otf& otf,
                     const TargetOptions& options);

void print_target_summary(const TargetOptics& optics, const Otf& otf, const TargetOptions& options,
                          const TargetScene& scene, const TargetImage& image, const Shared& shared);

}  // namespace petzval::app
