// SPDX-License-Identifier: BSD-3-Clause
// The lens data table of a camera, for a file.
#pragma once

#include <petzval/base/context.h>
#include <petzval/optics/build.h>
#include <petzval/simulate/camera.h>

#include <optional>
#include <vector>

namespace petzval {

struct CameraTableOptions {
  std::vector<double> wavelengths_nm = {};  ///< empty: the lens's own
  /// Real image height to reach [mm]; absent: the corner of the camera's sensor, or the lens's largest field.
  std::optional<double> image_height_mm = {};
  /// Evenly spaced fields; absent: TableOptions::field_count of them, and for a camera with a sensor those
  /// between them that its pictures need to `tolerance`, unless PSFs are too wide for its pixels.
  std::optional<int> field_count = {};
  double tolerance = 1e-3;  ///< ProductOptions::tolerance of the pictures
  int frame_places = TableOptions{}.frame_places;
  TableOptions::Places places = TableOptions::Places::automatic;
};

/// The table of the lens as the camera uses it (lens_in_use()), with its apertures and losses; PSFs at all
/// fields, unlike tables of one image, which have some (build_image_table()).
///
///     write_table(camera_table({.lens = read_lens("m12-4.5mm").lens, .sensor = read_sensor("imx363")}),
///     "m12.h5");
///
/// \throws InputError as build_lens_data_table(), and for a height that is not positive; Cancelled.
LensDataTable camera_table(const Camera& camera, const CameraTableOptions& options = {},
                           const Context& context = {});

}  // namespace petzval
