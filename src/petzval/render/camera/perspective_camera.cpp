// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/render/camera/perspective_camera.h>
#include <petzval/render/disk_point.h>

namespace petzval::render {

PerspectiveCamera::PerspectiveCamera(const PerspectiveOptions& options, WavelengthGroups groups)
    : options_(options), groups_(std::move(groups)) {
  if (!(options.field_of_view_deg > 0 && options.field_of_view_deg < 180))
    throw InputError("the field of view of a perspective camera lies between 0 and 180 degrees");
  if (options.columns < 1 || options.rows < 1) throw InputError("a picture has at least one pixel");
  if (!(options.lens_radius >= 0) || !(options.focal_distance > 0))
    throw InputError("a lens radius cannot be negative, and a focal distance must be positive");
  slope_ = std::tan(radians(options.field_of_view_deg) / 2);
  const double aspect = static_cast<double>(options.columns) / options.rows;
  right_ = aspect > 1 ? aspect : 1;
  top_ = aspect > 1 ? 1 : 1 / aspect;
  left_ = -right_, bottom_ = -top_;
  const auto& window = options.screen_window;
  if (window[0] < window[1] && window[2] < window[3])
    left_ = window[0], right_ = window[1], bottom_ = window[2], top_ = window[3];
}

void PerspectiveCamera::trace(int group, const FilmSampling&, std::span<const FilmSample> samples,
                              std::span<CameraRay> rays) const {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const FilmSample& sample = samples[i];
    const double x = left_ + (right_ - left_) * sample.column / options_.columns;
    const double y = top_ - (top_ - bottom_) * sample.row / options_.rows;
    CameraRay& ray = rays[i];
    ray = {};
    ray.passes = true;
    ray.weight = Lanes::all(1);
    ray.weight_alone = static_cast<float>(groups_.lanes(group));  // any of which may lead
    const Vector3 focus{x * slope_ * options_.focal_distance, y * slope_ * options_.focal_distance,
                        options_.focal_distance};
    if (options_.lens_radius > 0) {
      const DiskPoint on = disk_point(sample.u, sample.v);
      ray.origin = {options_.lens_radius * on.x, options_.lens_radius * on.y, 0};
    }
    ray.direction = normalised(focus - ray.origin);
  }
}

}  // namespace petzval::render
