// SPDX-License-Identifier: BSD-3-Clause
// The points of spot diagrams.
#pragma once

#include <petzval/analysis/field_tables.h>

#include <vector>

namespace petzval {

/// Where rays of even rings over the entrance beam meet the image surface [µm], from the chief ray's point of
/// the same wavelength.
struct SpotDiagram {
  double field = 0, wavelength_nm = 0;
  double height_um = 0;  ///< of the chief ray's point above the axis
  std::vector<double> x_um, y_um;
};

/// Rows in the order fields × wavelengths, 3·rings·(rings + 1) points each where nothing is vignetted.
/// \throws InputError naming a field at which no ray passes.
std::vector<SpotDiagram> spot_diagrams(const Lens& lens, const FieldTableRequest& request, int rings);

}  // namespace petzval
