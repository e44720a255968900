// SPDX-License-Identifier: BSD-3-Clause
// Which polygons of a scene have to do with each other.
#pragma once

#include <petzval/target/polygon.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace petzval {

/// Pairs of polygons whose outlines cross or touch, or of which one has a contour inside the other. Of two
/// polygons that do not meet neither covers anything of the other, however their bounding boxes lie: rings
/// within rings, letters within frames. Edges are sorted into rows, and within a row swept by x; a scene of n
/// edges takes little more than sorting them.
class Meetings {
 public:
  /// \param involved  polygons to look at; pairs with others are not found.
  Meetings(const std::vector<Polygon>& polygons, const std::vector<bool>& involved);

  bool have_met(std::size_t a, std::size_t b) const;

 private:
  std::vector<std::uint64_t> pairs_;  ///< rising
};

}  // namespace petzval
