// SPDX-License-Identifier: BSD-3-Clause
// Which part of the scene each place of the image sees.
#pragma once

#include <petzval/imaging/light_centre.h>
#include <petzval/imaging/plane_sampling.h>
#include <petzval/scene/scene.h>
#include <petzval/sensor/sensor.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace petzval {

/// What is seen beyond the edges of a scene that does not cover the field.
enum class Surround {
  error,  ///< nothing may be: InputError
  zero,   ///< darkness
  extend  ///< the nearest sample of the scene
};

/// The way from image space to the samples of a scene at one wavelength.
///
/// The samples seen lie on the line through the axis on which the cell lies, at a radius ρ(r') that is the
/// tangent of the object angle (object at infinity) or the object height (finite) in units of scene samples.
/// ρ/r' and g_source are smooth functions of r'², and are kept as such, at 4096 steps with straight lines in
/// between: no square root, no trigonometry and no division on the way from cell to sample, and an error
/// below 1e-7 for smooth lenses. For a panorama ρ is the object angle itself, in samples of its equator, so
/// that places are those of the azimuthal equidistant map about the axis, and fields of 90° and beyond are as
/// good as any (PanoramaBand).
class SceneMap {
 public:
  /// \param lens  at the wavelength; beyond its last field there is darkness.
  /// \param object_to_sensor_mm  where a finite object stands; absent: at infinity, fields are degrees.
  /// \param largest_height_mm  the farthest that place() will be asked for.
  SceneMap(const LightProfile& lens, std::optional<double> object_to_sensor_mm, const Scene& scene,
           double largest_height_mm);

  /// A place in the scene, in samples (centres at half-integers, rows down), and how much of its light
  /// arrives.
  struct Place {
    double column, row, g_source_sr;  ///< g_source 0: no chief ray lands here
  };
  Place place(double x_mm, double y_mm) const { return around(x_mm, y_mm).place(x_mm, y_mm); }

  /// The straight lines that hold about a point: places near it without looking anything up again.
  struct Surroundings {
    double middle_column, middle_row, last_square;
    double square;  ///< r'² of the point
    double samples_per_mm, samples_slope, g_source_sr, g_source_slope;

    Place place(double x_mm, double y_mm) const {
      const double at = x_mm * x_mm + y_mm * y_mm, further = at - square;
      const double ratio = samples_per_mm + further * samples_slope;
      const bool dark = at > last_square;
      return {middle_column - ratio * x_mm, middle_row + ratio * y_mm,
              dark ? 0.0 : g_source_sr + further * g_source_slope};
    }
    /// The most samples that a millimetre spans here, radially or tangentially.
    double finest_samples_per_mm() const {
      return std::max(samples_per_mm, samples_per_mm + 2 * square * samples_slope);
    }
    /// The samples that a millimetre along an axis spans at a place on that axis.
    double samples_per_mm_along(double place_mm) const {
      return samples_per_mm + 2 * place_mm * place_mm * samples_slope;
    }
  };
  Surroundings around(double x_mm, double y_mm) const;
  /// For RowView.
  SceneMapSteps steps() const { return {steps_.data(), steps_per_square_, last_height_squared_}; }
  /// Beyond it every place is dark.
  double last_height_mm() const { return last_height_mm_; }
  /// The most samples of the scene that a millimetre of the image spans, radially or tangentially.
  double finest_samples_per_mm() const { return finest_samples_per_mm_; }

 private:
  double middle_column_, middle_row_;
  double last_height_mm_, last_height_squared_, steps_per_square_;
  double finest_samples_per_mm_ = 0;
  std::vector<SceneMapStep> steps_;
};

/// How far a grid of cells sees from the axis [samples of the scene]: to left and right, up and down, to the
/// corner.
struct SeenExtent {
  double columns = 0, rows = 0, radius = 0;
};
SeenExtent seen_extent(const SceneMap& map, const SensorGeometry& grid);

}  // namespace petzval
