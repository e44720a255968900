// SPDX-License-Identifier: BSD-3-Clause
#include "blade_option.h"

#include <petzval/base/error.h>

namespace petzval::app {

void BladeChoice::add_to(CLI::App& command) {
  command.add_option(
      "--blades", count,
      "Blades of the iris: the stop is a polygon with its corners on the circle; 0: round; default: as "
      "the lens has it");
  command.add_option("--blade-rotation", rotation_deg,
                     "Of the first corner from the top, anticlockwise as seen from the film [deg]");
}

StopBlades BladeChoice::blades(const Lens& lens) const {
  StopBlades blades = lens.stop_blades();
  if (count) blades = {*count, 0};
  if (rotation_deg && blades.count == 0)
    throw InputError("--blade-rotation belongs to --blades, or to a lens whose stop has some");
  if (rotation_deg) blades.rotation_deg = *rotation_deg;
  blades.validate();
  return blades;
}

std::optional<StopBlades> BladeChoice::of_unknown_lens() const {
  if (!count && rotation_deg)
    throw InputError("--blade-rotation belongs to --blades, or to a --lens that has some");
  if (!count) return {};
  const StopBlades blades{*count, rotation_deg.value_or(0)};
  blades.validate();
  return blades;
}

}  // namespace petzval::app
