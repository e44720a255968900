// SPDX-License-Identifier: BSD-3-Clause
// petzval lens ghosts --draw: the way of one ghost through its lens.
#pragma once

#include <petzval/analysis/field_tables.h>

#include <string>

#include "command.h"

namespace petzval::app {

/// What is drawn, and where.
struct GhostDrawing {
  std::string pair;    ///< "FIRST,SECOND"; empty: nothing is drawn
  std::string output;  ///< .svg, .png or .pdf

  /// \throws InputError for a pair without a file, or the other way round, and what is no drawing.
  void check() const;
  /// Rays of every field. \throws InputError for a pair of which the second surface is not in front of the
  /// first, or that the lens does not have.
  void draw(const Lens& lens, const FieldTableRequest& request, double sensor_reflectance,
            const Shared& shared) const;
};

}  // namespace petzval::app
