// SPDX-License-Identifier: BSD-3-Clause
// How a lens is used, on the command line: stopped down, focused, moved.
#pragma once

#include <petzval/analysis/field_tables.h>

#include <optional>
#include <string>
#include <vector>

#include "blade_option.h"
#include "command.h"

namespace petzval::app {

struct CameraChoice {
  std::string focus = "design";
  std::optional<double> f_number, image_distance_mm, move_lens_mm;
  BladeChoice blades;
  double field_azimuth_deg = 0;

  /// Adds --f-number, --focus, --image-distance, --move-lens, --blades, --blade-rotation and --field-azimuth.
  void add_to(CLI::App& command);
  /// The lens as these options have it used. Best focus is sought for these fields and wavelengths (absent:
  /// the lens's own).
  Lens used(const Lens& lens, const std::optional<FieldTableRequest>& request, const Shared& shared) const;
};

}  // namespace petzval::app
