// SPDX-License-Identifier: BSD-3-Clause
// The edges of a picture, as Python has them.
#pragma once

#include <petzval/measure/sfr/frame_sharpness.h>

#include <optional>
#include <string>
#include <vector>

#include "bind.h"
#include "call.h"

namespace petzval::python {

struct Edges {
  std::vector<MeasuredEdge> all;
  int columns = 0, rows = 0;  ///< of the picture

  /// As places in the frame, of one direction or of all.
  std::vector<EdgeInFrame> in_frame(const std::string& direction) const {
    const auto wanted = choice<std::optional<EdgeDirection>>("direction", direction,
                                                             {{"all", std::nullopt},
                                                              {"meridional", EdgeDirection::meridional},
                                                              {"sagittal", EdgeDirection::sagittal}});
    std::vector<EdgeInFrame> edges = edges_in_frame(all, columns, rows);
    if (wanted) std::erase_if(edges, [&](const EdgeInFrame& e) { return e.direction != *wanted; });
    return edges;
  }
};

}  // namespace petzval::python
