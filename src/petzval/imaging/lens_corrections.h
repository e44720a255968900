// SPDX-License-Identifier: BSD-3-Clause
// What a lens does to straight lines and even light, as photographers' programs undo it.
#pragma once

#include <petzval/image/spectral_image.h>
#include <petzval/optics/lens_data_table.h>
#include <petzval/sensor/sensor.h>

namespace petzval {

/// Fills in `warp` and `vignetting` of a lens over a frame, from its chief rays and its g_sensor at the
/// wavelength of the table nearest to the reference; straight is what is straight in the plane of the scene,
/// as large as it is in the middle or, where the frame would not be filled, as large as fills it. A fit that
/// misses the chief rays by more than a fifth of a pixel, or the light by 1 %, is left out: a fisheye's is.
void add_corrections(LensFacts& facts, const LensDataTable& table, const SensorGeometry& frame);

}  // namespace petzval
