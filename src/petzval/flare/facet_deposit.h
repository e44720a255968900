// SPDX-License-Identifier: BSD-3-Clause
// Light of triangles onto pixels, by exact areas.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace petzval {

/// A lit triangle in a picture: columns and rows, pixels being unit squares.
struct LightFacet {
  std::array<double, 3> column{}, row{};
  double flux = 0;
  std::array<double, 3> shade{1, 1, 1};  ///< light at the corners over its mean; linear in between
};

/// Rows [from, to) of a picture, that facets add their light to: what falls on each pixel, row by row.
struct RowBand {
  int columns = 0, from = 0, to = 0;
  std::span<double> flux;  ///< (to − from) × columns
};

/// Adds the light of each facet that falls on these rows, in order; what falls beside the picture is lost.
/// The share of a pixel is the facet's area within it, over its area (signed areas of the edges, summed along
/// rows, as outlines of letters are filled). Facets of less than a millionth of a pixel are taken as the
/// segment that they nearly are. Light is kept to rounding; where it is shaded, each pixel has the shade of
/// its middle.
void deposit_facets(std::span<const LightFacet> facets, const RowBand& band);

}  // namespace petzval
