// SPDX-License-Identifier: BSD-3-Clause
// Fitting scene and sensor to each other, where the user leaves one of them open.
#pragma once

#include <petzval/imaging/image_formation.h>

namespace petzval {

/// The horizontal angle [degrees] that a scene of this shape needs to just cover the field of a sensor, the
/// margin for the PSF included. \throws InputError as form_image(), or if no plane scene covers the field.
double covering_angle_deg(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                          const ImagingOptions& options);

/// Pixels as large as the image of a scene sample on the axis: sample × |magnification|, or focal length ×
/// tangent per sample for an object at infinity. \throws InputError if the lens forms no image of a finite
/// size.
double natural_pitch_um(const Scene& scene, const FirstOrder& lens);

/// The largest centred frame of the scene's shape and natural pitch whose field, the margin for the PSF
/// included, the scene covers. \throws InputError as form_image(), or if not even one pixel fits.
SensorGeometry natural_sensor(const Scene& scene, const LensDataTable& table, const ImagingOptions& options);

}  // namespace petzval
