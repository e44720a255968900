// SPDX-License-Identifier: BSD-3-Clause
// The optics of a synthetic target on the command line.
#pragma once

#include <petzval/simulate/target.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "pupil_option.h"

namespace petzval::app {

/// --psf, --f-number, --wavelength, --weights, the pupil, --sigma, --pixel-pitch and the photosite.
struct TargetOptics {
  std::string psf = "airy", photosite = "square", low_pass;
  double f_number = 8, pitch_um = 4.73, sigma_um = 0, mtf50_cpp = 0, psf_ratio = 1, fill_factor = 1;
  std::vector<double> wavelengths_nm{550}, weights;
  std::optional<double> field;
  PupilChoice pupil;
  LensChoice lens;

  void add_to(CLI::App& command);
  /// Optics, wavelengths, pitch and photosite, but those of a sensor that is there already.
  /// \throws InputError for options that contradict each other.
  void fill(TargetRequest& request, const Shared& shared) const;

 private:
  void validate(bool has_sensor) const;
  Photosite site() const;
  GaussianBlur gaussian(const TargetRequest& request) const;
};

/// "3.5x2" → two numbers. \throws InputError naming the option.
std::pair<double, double> pair_of(const std::string& text, char separator, const std::string& option);

}  // namespace petzval::app
