// SPDX-License-Identifier: BSD-3-Clause
// What a lens does to straight lines and even light, as photographers' programs undo it.
#pragma once

#include <petzval/image/spectral_image.h>
#include <petzval/optics/lens_data_table.h>
#include <petzval/sensor/sensor.h>

namespace petzval {

/// Fills in what undoes a lens over a frame, from its chief rays and its g_sensor at the wavelength of the
/// table nearest to the reference; straight is what is straight in the plane of the scene, as large as it is
/// in the middle or, where the frame would not be filled, as large as fills it. `warp`; where that misses the
/// chief rays by more than a fifth of a pixel, `fisheye_warp`, or none where that misses too. `vignetting`;
/// where that misses the light by 1 %, and for lenses without symmetry, `gain_map`, whose gains end at 16.
void add_corrections(LensFacts& facts, const LensDataTable& table, const SensorGeometry& frame);

}  // namespace petzval
