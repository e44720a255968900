// SPDX-License-Identifier: BSD-3-Clause
// Fitting a scene with depth and a sensor to each other, where the user leaves one of them open.
#pragma once

#include <petzval/imaging/depth_image.h>

namespace petzval {

/// Pixels as large as the image of a sample whose depth is in focus, on the axis.
double natural_depth_pitch_um(const Scene& scene, const Lens& lens);

/// As covering_angle_deg(), for the layers at both ends of the scene.
double covering_depth_angle_deg(const Scene& scene, const DepthCamera& camera, const SensorGeometry& sensor,
                                const ImagingOptions& options, const DepthOptions& depth);

/// As natural_sensor(), for the same layers.
SensorGeometry natural_depth_sensor(const Scene& scene, const DepthCamera& camera,
                                    const ImagingOptions& options, const DepthOptions& depth);

}  // namespace petzval
