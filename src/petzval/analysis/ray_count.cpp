// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/ray_count.h>
#include <petzval/base/parallel.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace petzval {

double counted_g_sensor_sr(const Tracer& tracer, double image_height_mm, int rays_a_side, Tracer::Clip clip) {
  std::vector<long> passed(static_cast<std::size_t>(rays_a_side));
  parallel_for(passed.size(), [&](std::size_t i) {
    RayBatch row;
    for (int j = 0; j < rays_a_side; ++j) {
      const double a = 2 * (j + 0.5) / rays_a_side - 1,
                   b = 2 * (static_cast<double>(i) + 0.5) / rays_a_side - 1;
      const double cosine_sq = 1 - a * a - b * b;
      if (cosine_sq > 0)
        row.push_back(0, image_height_mm, tracer.image_z_mm(), -a, -b, -std::sqrt(cosine_sq));
    }
    tracer.trace_backward(row, clip);
    passed[i] = std::count(row.status.begin(), row.status.end(), RayStatus::ok);
  });
  const double cell = 2.0 / rays_a_side, n = tracer.image_index() / tracer.object_index();
  return n * n * static_cast<double>(std::accumulate(passed.begin(), passed.end(), 0L)) * cell * cell;
}

}  // namespace petzval
