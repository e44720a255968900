// SPDX-License-Identifier: BSD-3-Clause
// What is known for certain of a picture of a flat scene: where its pixels look, and how far away that is.
#pragma once

#include <petzval/optics/lens_data_table.h>
#include <petzval/scene/scene.h>
#include <petzval/sensor/sensor.h>

#include <optional>
#include <vector>

namespace petzval {

/// The band of a table that is nearest to its reference wavelength.
std::size_t reference_band(const LensDataTable& table);

/// Tangents of the direction that the chief ray of every pixel's centre comes from, at the table's wavelength
/// nearest to the reference: to the right and down, as a person at the camera sees it; about the axis, from
/// vertex 1 for an object at infinity or from its plane at the object's distance. NaN where no light arrives.
/// [row][column][right, down].
std::vector<float> pixel_rays(const LensDataTable& table, const SensorGeometry& frame);

/// A camera matrix and distortion as OpenCV has them, fitted to pixel_rays() by least squares in pixels.
struct Intrinsics {
  bool fisheye = false;  ///< r = f(θ + k₁θ³ + …) (cv::fisheye); else f·t(1 + k₁t² + k₂t⁴ + k₃t⁶)
  double focal_px = 0;                ///< fx = fy
  double centre_x = 0, centre_y = 0;  ///< of OpenCV, which counts the first pixel's centre as 0
  std::vector<double> radial = {};    ///< k₁, k₂, k₃ (of a fisheye k₄, too)
  double rms_px = 0, worst_px = 0;    ///< what is left
};
/// Nothing where fewer than ten pixels see light. The model is the one that leaves less.
std::optional<Intrinsics> fit_intrinsics(const std::vector<float>& rays, const SensorGeometry& frame);

/// Depth of a scene at the places that its pixels look at, from the sensor along the axis [m]; infinite where
/// nothing is. [row][column].
std::vector<float> pixel_depths(const Scene& scene, const std::vector<float>& rays,
                                double pupil_to_sensor_mm);

}  // namespace petzval
