// SPDX-License-Identifier: BSD-3-Clause
// The blades of a stop on the command line.
#pragma once

#include <petzval/lens/lens.h>

#include <optional>

#include "command.h"

namespace petzval::app {

/// --blades and --blade-rotation: the same of every command that takes a lens.
struct BladeChoice {
  std::optional<int> count;
  std::optional<double> rotation_deg;

  void add_to(CLI::App& command);
  /// What the options make of a lens's own blades. \throws InputError as StopBlades::validate(), and for a
  /// rotation of no blades.
  StopBlades blades(const Lens& lens) const;
  /// The same for a lens that is not known yet: absent unless --blades says how many.
  std::optional<StopBlades> of_unknown_lens() const;
};

}  // namespace petzval::app
