// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/dataset/object_masks.h>

#include <algorithm>
#include <map>

namespace petzval {

ObjectMasks object_masks(const SceneSegments& segments) {
  ObjectMasks masks{segments.columns, segments.rows, {}, {}};
  masks.values.reserve(2 * segments.shape.size());
  struct Box {
    int left, top, right, bottom;
    std::size_t pixels;
  };
  std::map<int, Box> boxes;
  for (std::size_t at = 0; at < segments.shape.size(); ++at) {
    const int shape = segments.shape[at], instance = segments.instance[at];
    const int number = instance >= 0 ? 2 * instance + 1 : shape >= 0 ? 2 * shape : -1;
    masks.values.push_back(number);
    masks.values.push_back(segments.material[at]);
    if (number < 0) continue;
    const auto column = static_cast<int>(at % static_cast<std::size_t>(segments.columns)),
               row = static_cast<int>(at / static_cast<std::size_t>(segments.columns));
    Box& box = boxes.try_emplace(number, Box{column, row, column, row, 0}).first->second;
    box.left = std::min(box.left, column), box.right = std::max(box.right, column);
    box.bottom = row, ++box.pixels;
  }
  for (const auto& [number, box] : boxes)
    masks.objects.push_back({number, number % 2 == 1, box.pixels, box.left, box.top, box.right - box.left + 1,
                             box.bottom - box.top + 1});
  return masks;
}

}  // namespace petzval
