// SPDX-License-Identifier: BSD-3-Clause
// What a rendering would take.
#pragma once

#include <petzval/simulate/render.h>

namespace petzval {

struct RenderEstimate {
  int samples_per_pixel = 0;  ///< as asked, or, for a noise, as the probe says that it takes
  double seconds = 0;         ///< for the light, on the threads of the context
  double memory_bytes = 0;    ///< to gather the light in
  double probe_seconds = 0;   ///< what the estimate itself took
};

/// From a picture of the same frame with few pixels and few samples: bright details that it misses take more.
/// \throws as render_scene().
RenderEstimate estimate_render(const PreparedScene& scene, const Context& context = {});

}  // namespace petzval
