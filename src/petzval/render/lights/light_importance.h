// SPDX-License-Identifier: BSD-3-Clause
// What lights can do at a point: bounds of several nodes of a tree of lights at once.
#pragma once

#include <petzval/render/vector3.h>

#include <cstddef>
#include <cstdint>

namespace petzval::render {

/// Where light is to arrive.
struct LightReceiver {
  Vector3 position;
  Vector3 normal;           ///< unit, on the side that is seen
  bool both_sides = false;  ///< whether light from behind counts, too
  bool all_around = false;  ///< a point of a medium, which has no normal: all directions count alike
};

/// Nodes of a tree of lights (see LightBounds) side by side.
struct LightNodes {
  enum Column : std::size_t {
    centre_x,
    centre_y,
    centre_z,
    axis_x,
    axis_y,
    axis_z,
    radius,
    radius2,
    cos_spread,
    sin_spread,
    cos_reach,
    strength,
    two_sided,  ///< 1 or 0
    columns
  };
  static constexpr std::size_t together =
      4;  ///< nodes are filled up to a multiple of it by others of strength 0

  const double* numbers = nullptr;  ///< column by column
  std::size_t count = 0;            ///< of each column
  bool all_ways = false;            ///< whether each shines to all sides alike
};

/// Nearly the irradiance that each node gives a point in the open: 0 only where it can give none.
/// \return the nodes within `nearness` radii of which the point stands, the first one in the last bit.
std::uint32_t light_importances(const LightNodes& nodes, const LightReceiver& to, double nearness,
                                double* importances);

}  // namespace petzval::render
