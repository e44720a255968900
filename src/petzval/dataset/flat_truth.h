// SPDX-License-Identifier: BSD-3-Clause
// What is known for certain of a picture of a flat scene: where its pixels look, and how they are blurred.
#pragma once

#include <petzval/base/context.h>
#include <petzval/optics/lens_data_table.h>
#include <petzval/scene/scene.h>
#include <petzval/sensor/sensor.h>

#include <optional>
#include <vector>

namespace petzval {

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

/// Depth of a scene at the places that its pixels look at, from the sensor along the axis [m]; infinite where
/// nothing is. [row][column].
std::vector<float> pixel_depths(const Scene& scene, const std::vector<float>& rays,
                                double pupil_to_sensor_mm);

}  // namespace petzval
