// SPDX-License-Identifier: BSD-3-Clause
// Which object each pixel of a three-dimensional scene shows, and a box about each object.
#pragma once

#include <petzval/simulate/scene_segments.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace petzval {

struct SeenObject {
  int number = 0;       ///< as in ObjectMasks::values
  bool placed = false;  ///< an object that the scene places, of any number of shapes; else a shape by itself
  std::size_t pixels = 0;
  int left = 0, top = 0, columns = 0, rows = 0;  ///< the smallest box about all of them
};

struct ObjectMasks {
  int columns = 0, rows = 0;
  /// [row][column][object, material]. Objects: a shape that stands by itself is 2 · its number, an object
  /// that the scene places 2 · its number + 1, both counted from 0 as in its file, so that a thing keeps its
  /// number from picture to picture. −1: nothing is seen.
  std::vector<std::int32_t> values;
  std::vector<SeenObject> objects;  ///< those that are seen, by number
};

ObjectMasks object_masks(const SceneSegments& segments);

}  // namespace petzval
