// SPDX-License-Identifier: BSD-3-Clause
// Fitting scene and sensor to each other, where the user leaves one of them open.
#pragma once

#include <petzval/imaging/band_plan.h>
#include <petzval/imaging/image_formation.h>

#include <optional>
#include <vector>

namespace petzval {

/// The horizontal angle [degrees] that a scene of this shape needs to just cover the field of a sensor, the
/// margin for the PSF included. \throws InputError as form_image(), or if no plane scene covers the field.
double covering_angle_deg(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                          const ImagingOptions& options);

/// The same for what cells see of it.
double covering_angle_deg(const Scene& scene, const SeenExtent& seen);

/// Pixels as large as the image of a scene sample on the axis: sample × |magnification|, or focal length ×
/// tangent per sample for an object at infinity. \throws InputError if the lens forms no image of a finite
/// size.
double natural_pitch_um(const Scene& scene, const FirstOrder& lens);

/// A frame of the scene's shape.
SensorGeometry frame_like(const Scene& scene, int columns, double pitch_um);

/// The largest centred one, of no more columns than the scene has samples, whose field the scene covers;
/// nothing if not even one pixel fits. \param plans  made for frames up to the scene's columns.
std::optional<SensorGeometry> largest_covered_frame(const Scene& scene, double pitch_um,
                                                    const std::vector<BandPlan>& plans,
                                                    const ImagingOptions& options);

/// The largest centred frame of the scene's shape and natural pitch whose field, the margin for the PSF
/// included, the scene covers. \throws InputError as form_image(), or if not even one pixel fits.
SensorGeometry natural_sensor(const Scene& scene, const LensDataTable& table, const ImagingOptions& options);

}  // namespace petzval
