// SPDX-License-Identifier: BSD-3-Clause
// A pupil on the command line: radial terms, Zernike terms, blades and obstruction.
#pragma once

#include <petzval/wave/pupil_otf.h>

#include <optional>
#include <string>

#include "cli11.h"

namespace petzval::app {

/// --w020 … --w080, --zernike, --zernike-order, --zernike-unit, --obstruction, --blades, --blade-rotation and
/// --blade-curvature.
struct PupilChoice {
  std::optional<double> w020, w040, w060, w080;
  std::string zernike, zernike_order = "fringe", zernike_unit = "waves";
  double obstruction = 0, blade_rotation_deg = 0, blade_curvature = 0;
  int blades = 0;

  void add_to(CLI::App& command);
  bool is_aberrated() const { return w020 || w040 || w060 || w080 || !zernike.empty(); }
  bool is_shaped() const { return blades != 0 || obstruction != 0; }
  /// Waves are those of this wavelength. \throws InputError for options that contradict each other, a list or
  /// file of coefficients that is none, and as GeneralPupil::validate.
  GeneralPupil at(double wavelength_nm) const;
};

}  // namespace petzval::app
