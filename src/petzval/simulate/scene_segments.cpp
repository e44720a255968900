// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/stop.h>
#include <petzval/simulate/chief_rays.h>
#include <petzval/simulate/scene_segments.h>

namespace petzval {

SceneSegments segments_seen(const PreparedScene& scene, const Context& context) {
  const ChiefRays camera(scene);
  const render::PixelWindow& window = camera.window();
  const std::vector<render::Geometry>& geometries = world_for_focus(scene).geometries;
  SceneSegments seen{window.columns(), window.rows(), {}, {}, {}};
  for (std::vector<int>* each : {&seen.shape, &seen.instance, &seen.material})
    each->assign(window.size(), -1);
  const auto row_of = [&](std::size_t row) {
    check_stop();
    const auto rays = camera.trace_row(static_cast<int>(row));
    const render::Transform from = camera.world_from_camera(window.top + static_cast<double>(row) + 0.5);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto point = camera.seen(rays[i], from);
      if (!point) continue;
      const std::size_t at = row * rays.size() + i;
      seen.shape[at] = point->hit.geometry, seen.instance[at] = point->hit.instance;
      seen.material[at] = geometries[static_cast<std::size_t>(point->hit.geometry)].material;
    }
  };
  run_within(context,
             [&](const ProgressCallback&) { parallel_for(static_cast<std::size_t>(window.rows()), row_of); });
  return seen;
}

}  // namespace petzval
