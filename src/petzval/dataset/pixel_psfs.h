// SPDX-License-Identifier: BSD-3-Clause
// How the pixels of a picture are blurred: PSFs at a grid of places.
#pragma once

#include <petzval/base/context.h>
#include <petzval/optics/lens_data_table.h>
#include <petzval/sensor/sensor.h>
#include <petzval/simulate/render.h>

#include <vector>

namespace petzval {

/// PSFs in pixels of the frame at a grid of places: those of the middles of equal tiles. Each is the share of
/// a point's light that falls into the pixels about the one in whose middle it has its centre, as in the
/// picture: rows down, columns to the right. A place without light has zeros.
struct PixelPsfs {
  std::vector<double> columns, rows;  ///< of the places [pixels], whose centres are at half-integers
  std::vector<float> values;          ///< [grid row][grid column][wavelength][row][column]
};
/// \param table  of the lens as it is used: the light that was imaged. \throws InputError; Cancelled.
PixelPsfs pixel_psfs(const LensDataTable& table, const SensorGeometry& frame,
                     const std::vector<double>& wavelengths_nm, int grid_rows, int grid_columns, int size,
                     const Context& context = {});
/// The same of a scene in three dimensions: each at the depth of what the middle of its place sees when
/// exposure begins, at infinity where that is nothing. \throws InputError; Cancelled.
PixelPsfs pixel_psfs(const PreparedScene& scene, int grid_rows, int grid_columns, int size,
                     const Context& context = {});

}  // namespace petzval
