// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/imaging/image_table.h>
#include <petzval/simulate/asked_of_table.h>
#include <petzval/simulate/camera_table.h>

namespace petzval {

namespace {

TableOptions table_options(const Camera& camera, const CameraTableOptions& asked) {
  TableOptions options;
  options.wavelengths_nm = asked.wavelengths_nm;
  if (asked.field_count) options.field_count = *asked.field_count;
  options.frame_places = asked.frame_places;
  options.places = asked.places;
  if (camera.apertures == Camera::Apertures::ignored) options.clip = Tracer::Clip::stop_only;
  options.losses = camera.losses;
  if (asked.image_height_mm && !(*asked.image_height_mm > 0))
    throw InputError(
        fmt::format("an image height of {} mm; a positive length would be right", *asked.image_height_mm));
  if (asked.image_height_mm) {
    options.max_image_height_mm = *asked.image_height_mm;
  } else if (camera.sensor) {
    const SensorGeometry& frame = camera.sensor->geometry;
    options.max_image_height_mm = frame.half_diagonal_mm();
    options.half_frame_mm = {frame.width_mm() / 2, frame.height_mm() / 2};
  }
  options.validate();
  return options;
}

}  // namespace

LensDataTable camera_table(const Camera& camera, const CameraTableOptions& asked, const Context& context) {
  const TableOptions options = table_options(camera, asked);
  if (!(asked.tolerance > 0))
    throw InputError(fmt::format("a tolerance of {:g}; a positive number would be right", asked.tolerance));
  const Lens lens = lens_in_use(camera, context);
  return result_within(context, [&](const ProgressCallback& progress) {
    if (asked.field_count || !camera.sensor) return build_lens_data_table(lens, options, progress);
    ImageOptions pictures;
    pictures.imaging.product.tolerance = asked.tolerance;
    try {
      return build_table_of_pictures(lens, options, spread_wanted(pictures, camera.sensor->geometry.pitch_um),
                                     progress);
    } catch (const InputError&) {
      // Kernels may have too many cells of this sensor to be compared. What else is wrong is said again.
      return build_lens_data_table(lens, options, progress);
    }
  });
}

}  // namespace petzval
