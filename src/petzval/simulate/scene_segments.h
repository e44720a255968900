// SPDX-License-Identifier: BSD-3-Clause
// Which things of a scene a camera sees, for training and for masks.
#pragma once

#include <petzval/simulate/render.h>

#include <vector>

namespace petzval {

/// Of each pixel, what its middle sees through the middle of the stop; −1 where it sees nothing. Surfaces
/// that are no boundary are seen through.
struct SceneSegments {
  int columns = 0, rows = 0;  ///< as the picture has
  std::vector<int>
      shape;  ///< counted from 0 as the scene's file has them: those that stand, then those of objects
  std::vector<int> instance;  ///< placed object, counted likewise; −1: the shape stands by itself
  /// Counted from 1 as the scene's file has them; 0: the grey of a scene that names none.
  std::vector<int> material;
};

/// \throws Cancelled.
SceneSegments segments_seen(const PreparedScene& scene, const Context& context = {});

}  // namespace petzval
