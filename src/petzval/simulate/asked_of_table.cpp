// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/field_error.h>
#include <petzval/imaging/field_of_view.h>
#include <petzval/imaging/scene_detail.h>
#include <petzval/simulate/asked_of_table.h>

#include <algorithm>
#include <cmath>

namespace petzval {

double beyond_frame_mm(double half_diagonal_mm, double pitch_um) {
  constexpr double pixels = 8;
  return std::max(pixels * pitch_um * mm_per_um, margin_of(Surround::error) * half_diagonal_mm);
}

std::array<double, 2> half_frame_mm(const SensorGeometry& frame) {
  const double beyond_mm = beyond_frame_mm(frame.half_diagonal_mm(), frame.pitch_um);
  return {frame.width_mm() / 2 + beyond_mm, frame.height_mm() / 2 + beyond_mm};
}

SpreadWanted spread_wanted(const ImageOptions& options, double pitch_um) {
  constexpr int cells_a_pixel = 2;  // as many or more
  return {pitch_um / cells_a_pixel, options.imaging.product.tolerance,
          options.imaging.tail_pixels * pitch_um};
}

SpreadWanted spread_wanted(const ImageOptions& options, double pitch_um, const Scene& scene,
                           const FirstOrder& lens) {
  SpreadWanted wanted = spread_wanted(options, pitch_um);
  try {
    const double sample_um = natural_pitch_um(scene, lens);
    const double contrast =
        contrast_of_noise(contrast_of_samples(scene, scene.bands() / 2) * sample_um / wanted.cell_um);
    wanted.contrast = std::exp2(std::ceil(std::log2(contrast)));  // one table for scenes that are much alike
  } catch (const InputError&) {
    // How large samples are is not known.
  }
  return wanted;
}

bool mixes_psfs(const ImageOptions& options) {
  return options.imaging.method == BlurMethod::product &&
         options.imaging.interpolation == PsfInterpolation::psf;
}

double stored_table_error(const TableCamera& camera, const Scene& scene, const ImageOptions& options) {
  const LensDataTable& table = camera.table;
  if (table.frame || !mixes_psfs(options)) return 0;
  const double side_mm = table.real_image_height_mm.back() / std::sqrt(2.0);
  try {
    const double pitch_um =
        camera.sensor ? camera.sensor->geometry.pitch_um : natural_pitch_um(scene, table.first_order);
    if (!(pitch_um > 0)) return 0;  // tables of other programs may not say how wide a scene is on the sensor
    return error_between_fields(
        table, camera.sensor ? half_frame_mm(camera.sensor->geometry) : std::array{side_mm, side_mm},
        spread_wanted(options, pitch_um, scene, table.first_order));
  } catch (const InputError&) {
    return 0;  // there is no pitch, or kernels would have too many cells; forming the image says so if it
               // cannot do with fewer
  }
}

}  // namespace petzval
