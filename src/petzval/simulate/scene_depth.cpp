// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/simulate/prepared_world.h>
#include <petzval/simulate/scene_depth.h>

#include <algorithm>
#include <cmath>

namespace petzval {

std::vector<double> depths_seen_m(const PreparedScene& scene, const render::PixelWindow& window) {
  constexpr double middle_of_stop = 0.02;
  render::SceneCamera camera = scene_camera(scene);
  if (camera.lens)
    camera.lens->aperture = {Aperture::Kind::stop_semi_diameter_mm,
                             middle_of_stop * stop_radius_mm(*camera.lens)};
  camera.perspective.lens_radius = 0;
  const render::World& world = world_for_focus(scene);
  render::RenderOptions options = render_options(scene);
  options.samples_per_pixel = 1;
  options.path.max_depth = 0;
  options.window = window;
  options.first_surfaces = true;
  const Rendering picture =
      render_picture(world, *camera.make(world.groups), camera.world_from_camera, camera.film, options);
  const std::vector<float>& depth = picture.first_surfaces->depth;
  std::vector<double> result(depth.begin(), depth.end());
  for (double& each : result) each *= scene.request.scene_unit_mm / mm_per_m;
  return result;
}

double depth_of_pixel_m(const PreparedScene& scene, const std::array<double, 2>& pixel) {
  const auto [column, row] = pixel;
  if (!(column >= 0 && column < scene.film.columns && row >= 0 && row < scene.film.rows))
    throw InputError(fmt::format("`focus_pixel` {:g},{:g} lies outside of the picture of {} x {} pixels",
                                 column, row, scene.film.columns, scene.film.rows));
  const int left = static_cast<int>(column), top = static_cast<int>(row);
  return depths_seen_m(scene, {left, top, left + 1, top + 1}).front();
}

std::optional<TwoDepths> parted_depths(std::vector<double> depths_m, double deep_m) {
  std::erase_if(depths_m, [](double depth) { return !std::isfinite(depth); });
  std::ranges::sort(depths_m);
  const std::size_t count = depths_m.size(), fewest = std::max<std::size_t>(1, count / 10);
  std::size_t gap = 0;  // before this one
  for (std::size_t i = fewest; i + fewest <= count; ++i)
    if (gap == 0 || depths_m[i] - depths_m[i - 1] > depths_m[gap] - depths_m[gap - 1]) gap = i;
  if (gap == 0 || !(depths_m[gap] - depths_m[gap - 1] > deep_m)) return {};
  return TwoDepths{depths_m[gap / 2], depths_m[gap + (count - gap) / 2]};
}

}  // namespace petzval
