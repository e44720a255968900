// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/sensor/raw_image.h>

#include <algorithm>
#include <cmath>

namespace petzval {

void RawImage::validate() const {
  if (columns < 1 || rows < 1 ||
      samples.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw InputError(fmt::format("{} samples for a raw image of {} x {}", samples.size(), columns, rows));
  if (mosaic.rows < 1 || mosaic.columns < 1 ||
      mosaic.cells.size() != static_cast<std::size_t>(mosaic.rows) * static_cast<std::size_t>(mosaic.columns))
    throw InputError("a mosaic whose cells do not fill it");
  for (const int cell : mosaic.cells)
    if (cell < 0 || cell >= static_cast<int>(channels.size()))
      throw InputError(fmt::format("a mosaic with channel {} of {}", cell, channels.size()));
  if (!(black_level >= 0 && black_level < white_level && white_level <= 65535))
    throw InputError(
        fmt::format("black level {:g} and white level {:g}; black below white, both from 0 to 65535, would "
                    "be right",
                    black_level, white_level));
  if (!linearization.empty() && *std::max_element(samples.begin(), samples.end()) >= linearization.size())
    throw InputError("a linearization table that ends below the greatest sample");
  for (const ColourCalibration& calibration : calibrations)
    if (calibration.camera_from_xyz.size() != 3 * channels.size() ||
        (!calibration.pcs_from_balanced.empty() &&
         calibration.pcs_from_balanced.size() != 3 * channels.size()))
      throw InputError(fmt::format("colour matrices that do not fit {} channels", channels.size()));
  for (const PixelPlace& bad : bad_pixels)
    if (bad.row < 0 || bad.column < 0 || bad.row >= rows || bad.column >= columns)
      throw InputError(
          fmt::format("a bad pixel in row {}, column {} of {} x {}", bad.row, bad.column, columns, rows));
  if (!as_shot_neutral.empty() && as_shot_neutral.size() != channels.size())
    throw InputError(
        fmt::format("a neutral of {} numbers for {} channels", as_shot_neutral.size(), channels.size()));
  if (!(shot_noise_share > 0 && shot_noise_share <= 1))
    throw InputError(
        fmt::format("a share of shot noise of {:g}; above 0 up to 1 would be right", shot_noise_share));
  for (const double value : as_shot_neutral)
    if (!(value > 0) || std::isinf(value)) throw InputError("a neutral that is not positive");
}

CameraFacts camera_facts(const RawImage& raw) {
  return {raw.exposure_s, raw.iso, raw.pitch_um, raw.lens, raw.sensor_name, raw.date_time};
}

}  // namespace petzval
