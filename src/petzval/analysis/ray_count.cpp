// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/ray_count.h>

#include <algorithm>
#include <cmath>

namespace petzval {

double counted_g_sensor_sr(const Tracer& tracer, double image_height_mm, int rays_a_side, Tracer::Clip clip) {
  long passed = 0;
  for (int i = 0; i < rays_a_side; ++i) {
    RayBatch row;
    for (int j = 0; j < rays_a_side; ++j) {
      const double a = 2 * (j + 0.5) / rays_a_side - 1, b = 2 * (i + 0.5) / rays_a_side - 1;
      const double cosine_sq = 1 - a * a - b * b;
      if (cosine_sq > 0)
        row.push_back(0, image_height_mm, tracer.image_z_mm(), -a, -b, -std::sqrt(cosine_sq));
    }
    tracer.trace_backward(row, clip);
    passed += std::count(row.status.begin(), row.status.end(), RayStatus::ok);
  }
  const double cell = 2.0 / rays_a_side, n = tracer.image_index() / tracer.object_index();
  return n * n * static_cast<double>(passed) * cell * cell;
}

}  // namespace petzval
