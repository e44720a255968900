// SPDX-License-Identifier: BSD-3-Clause
// Where the light of a field passes each surface.
#pragma once

#include <petzval/analysis/field_tables.h>

#include <vector>

namespace petzval {

/// The outline of a field's light on a surface, closed: its last point is its first.
struct Footprint {
  int surface = 0;
  double field = 0;
  std::vector<double> x_mm, y_mm;  ///< from the vertex, in the surface's own axes

  double area_mm2() const;
};

/// By surfaces, then by fields; of the request's first wavelength. What the outer edges of all apertures
/// together let through is outlined by real rays along the rim of its pupil. \throws InputError naming a
/// field at which no ray passes.
std::vector<Footprint> footprints(const Lens& lens, const FieldTableRequest& request, int azimuths = 128);

}  // namespace petzval
