// SPDX-License-Identifier: BSD-3-Clause
// The optics of a synthetic target on the command line.
#pragma once

#include <petzval/wave/otf.h>
#include <petzval/wave/photosite.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "pupil_option.h"

namespace petzval::app {

/// --psf, --f-number, --wavelength, --weights, the pupil, --sigma, --pixel-pitch and the photosite.
struct TargetOptics {
  std::string psf = "airy", photosite = "square", low_pass;
  double f_number = 8, pitch_um = 4.73, sigma_um = 0, fill_factor = 1;
  std::vector<double> wavelengths_nm{550}, weights;
  std::optional<double> field;
  PupilChoice pupil;
  std::optional<Photosite> sensor_site;  ///< in place of --photosite and --low-pass
  LensChoice lens;

  /// Reads the lens, if one is named. Call it before the others.
  void prepare(const Shared& shared);
  void add_to(CLI::App& command);
  /// \throws InputError for options that contradict each other.
  void validate() const;
  /// Diameter of the blur that geometry alone would make, twice the largest transverse aberration [um].
  double geometric_blur_um() const;
  /// Of one wavelength: the aberrations are waves of the first wavelength.
  std::shared_ptr<const Otf> at_wavelength(double wavelength_nm) const;
  /// Of all wavelengths with their weights.
  std::shared_ptr<const Otf> mixed() const;
  Photosite site() const;

 private:
  std::optional<Lens> lens_;
};

/// "3.5x2" → two numbers. \throws InputError naming the option.
std::pair<double, double> pair_of(const std::string& text, char separator, const std::string& option);

}  // namespace petzval::app
