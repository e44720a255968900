// SPDX-License-Identifier: BSD-3-Clause
// Where the outline of a polygon crosses itself.
#pragma once

#include <petzval/target/polygon.h>

#include <cstddef>
#include <optional>

namespace petzval {

/// Two edges of a polygon that meet though they are not neighbours. Edges are counted by the corner at which
/// they begin, over all contours.
struct Crossing {
  std::size_t first = 0, second = 0;
  Vertex at;
};

/// The first crossing, touching or overlap of edges found, neighbours that fold back onto each other
/// included. Edges are swept by x; those of a polygon that is not a comb take little more than their sorting.
std::optional<Crossing> find_crossing(const Polygon& polygon);

}  // namespace petzval
