// SPDX-License-Identifier: BSD-3-Clause
// Fitting scene and sensor to each other, where the user leaves one of them open.
#pragma once

#include <petzval/imaging/distortion.h>
#include <petzval/imaging/image_formation.h>

#include <optional>
#include <vector>

namespace petzval {

/// How far beyond the edges of a frame a scene must reach, as a part of half the frame's sides: light from
/// just beyond the edge is blurred into the frame. What comes from farther out is that of the scene's edge.
/// The margin follows the frame alone, so that as much is seen of a scene with every tolerance, stop and
/// number of cells.
constexpr double margin_of(Surround surround) {
  return surround == Surround::error ? 0.02 : 0;  // else it may end there
}

/// What the chief rays of a table see of a scene, band by band, out to half this diagonal.
std::vector<SceneMap> chief_ray_maps(const Scene& scene, const LensDataTable& table, double half_diagonal_mm,
                                     RadialFit fit);

/// The most that any band sees of a scene, of a sensor and margin_of(surround) beyond. \param maps  that
/// reach so far.
SeenExtent seen_extent(const std::vector<SceneMap>& maps, const SensorGeometry& sensor, Surround surround);

/// The same of a table. \throws InputError for wavelengths outside the table.
SeenExtent seen_extent(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                       const ImagingOptions& options);

/// The horizontal angle [degrees] that a scene of this shape needs, so that all of that is there.
/// \throws InputError if no plane scene covers it.
double covering_angle_deg(const Scene& scene, const SeenExtent& seen);

/// The same for a sensor. \throws InputError for wavelengths outside the table too.
double covering_angle_deg(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                          const ImagingOptions& options);

/// Pixels as large as the image of a scene sample on the axis: sample × |magnification|, or focal length ×
/// tangent per sample for an object at infinity. \throws InputError if the lens forms no image of a finite
/// size.
double natural_pitch_um(const Scene& scene, const FirstOrder& lens);

/// A frame of the scene's shape.
SensorGeometry frame_like(const Scene& scene, int columns, double pitch_um);

/// The largest centred one, of no more columns than the scene has samples, that the scene covers with
/// margin_of(surround) beyond. \param maps  out to the scene's columns. \throws InputError if not even one
/// pixel fits.
SensorGeometry largest_covered_frame(const Scene& scene, double pitch_um, const std::vector<SceneMap>& maps,
                                     Surround surround);

/// The largest centred frame of the scene's shape and natural pitch that the scene covers.
/// \throws InputError as largest_covered_frame(), for wavelengths outside the table, and for panoramas.
SensorGeometry natural_sensor(const Scene& scene, const LensDataTable& table, const ImagingOptions& options);

}  // namespace petzval
