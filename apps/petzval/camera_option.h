// SPDX-License-Identifier: BSD-3-Clause
// A camera on the command line: its lens, how that is used, its sensor.
#pragma once

#include <petzval/simulate/mounting.h>

#include <optional>
#include <string>
#include <vector>

#include "blade_option.h"
#include "command.h"
#include "loss_option.h"

namespace petzval::app {

struct CameraChoice {
  LensChoice lens;
  std::string focus;  ///< as typed; empty: `usual_focus`
  Focus usual_focus = Focus::design();
  std::optional<double> f_number, image_distance_mm, move_lens_mm, focus_wavelength_nm;
  double defocus_mm = 0;
  BladeChoice blades;
  double field_azimuth_deg = 0;
  Camera::Apertures apertures = Camera::Apertures::as_given;
  LossChoice losses;
  std::string sensor;
  std::vector<std::string> sensor_settings;

  // The groups of options, for commands to choose from.
  void add_lens(CLI::App& command, bool positional,
                bool required);  ///< LENS or --lens, --set, --substitute …
  void add_stop_and_focus(CLI::App& command, const Focus& usual);  ///< --f-number, --focus
  void add_focus_corrections(CLI::App& command);                   ///< --focus-wavelength, --defocus
  void add_positions(CLI::App& command);                           ///< --image-distance, --move-lens
  void add_blades(CLI::App& command);                              ///< --blades, --blade-rotation
  void add_field_azimuth(CLI::App& command);                       ///< --field-azimuth
  void add_apertures(CLI::App& command);                           ///< --apertures, --ignore-apertures
  void add_sensor(CLI::App& command, const std::string& meaning);  ///< --sensor, --sensor-set

  /// Those of the analyses of a lens: --f-number, --focus, --image-distance, --move-lens, blades,
  /// --field-azimuth.
  void add_to(CLI::App& command);

  /// The names of those options of a lens that were given, for commands that can do without one.
  std::vector<std::string> given_lens_options() const;

  /// Reads the lens and the sensor, if they are named; the readers' notes go to stderr unless quiet.
  /// \throws InputError.
  Camera camera(const Shared& shared) const;
  /// The lens as these options have it used. Best focus is sought for these fields and wavelengths (absent:
  /// the lens's own).
  Lens used(const Lens& lens, const std::optional<FieldTableRequest>& request, const Shared& shared) const;

 private:
  Camera settings(const Lens& lens) const;
};

}  // namespace petzval::app
