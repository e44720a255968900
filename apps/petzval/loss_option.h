// SPDX-License-Identifier: BSD-3-Clause
// Reflection and absorption on the command line: --fresnel, --coating, --absorption.
#pragma once

#include <petzval/trace/losses.h>

#include <string>

#include "command.h"

namespace petzval::app {

struct LossChoice {
  bool fresnel = false, absorption = false;
  std::string coating;  ///< a reflectance, or a CSV file of them

  void add_to(CLI::App& command);
  /// For a lens that is not known yet. \throws InputError for a coating that is neither a number nor a
  /// readable table, with file and line.
  Losses read() const;
  bool any() const { return fresnel || absorption || !coating.empty(); }
  /// Checked against the lens; notes which of its glasses have no data when absorption is asked for.
  /// \throws InputError as read(), and for surfaces that the lens does not have.
  Losses losses(const Lens& lens, const Shared& shared) const;
};

}  // namespace petzval::app
