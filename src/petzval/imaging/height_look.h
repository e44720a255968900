// SPDX-License-Identifier: BSD-3-Clause
// What a centred lens sees: by the height of a place, turned to its azimuth.
#pragma once

#include <petzval/imaging/light_centre.h>
#include <petzval/imaging/scene_look.h>
#include <petzval/scene/scene.h>

#include <optional>
#include <vector>

namespace petzval {

/// The samples seen lie on the line through the axis on which the cell lies, at a radius ρ(r') that is the
/// tangent of the object angle (object at infinity) or the object height (finite) in units of scene samples.
/// ρ/r' and g_source are smooth functions of r'², and are kept as such, at 4096 steps with straight lines in
/// between: no square root, no trigonometry and no division on the way from cell to sample, and an error
/// below 1e-7 for smooth lenses. For a panorama ρ is the object angle itself, in samples of its equator, so
/// that places are those of the azimuthal equidistant map about the axis, and fields of 90° and beyond are as
/// good as any (PanoramaBand).
class HeightLook : public SceneLook {
 public:
  /// \param lens  at the wavelength; beyond its last field there is darkness.
  /// \param object_to_sensor_mm  where a finite object stands; absent: at infinity, fields are degrees.
  /// \param largest_height_mm  the farthest that place() will be asked for.
  HeightLook(const LightProfile& lens, std::optional<double> object_to_sensor_mm, const Scene& scene,
             double largest_height_mm);

  ScenePlace place(double x_mm, double y_mm) const override { return around(x_mm, y_mm).place(x_mm, y_mm); }
  std::optional<ImagePlace> image_of(double column, double row, ImagePlace near) const override;
  void cut(double x_mm, double y_mm, double pitch_mm, int most, std::vector<ScenePart>& parts) const override;
  void look(const CellRow& cells, RowView& view) const override {
    view.look({steps_.data(), steps_per_square_, last_height_squared_}, cells);
  }
  double samples_per_mm_at(double x_mm, double y_mm) const override {
    return around(x_mm, y_mm).finest_samples_per_mm();
  }
  double finest_samples_per_mm() const override { return finest_samples_per_mm_; }
  double last_height_mm() const override { return last_height_mm_; }
  SeenExtent extent(const SensorGeometry& grid) const override;

 private:
  /// The straight lines that hold about a point: places near it without looking anything up again.
  struct Surroundings {
    double middle_column, middle_row, last_square;
    double square;  ///< r'² of the point
    double samples_per_mm, samples_slope, g_source_sr, g_source_slope;

    ScenePlace place(double x_mm, double y_mm) const {
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
  /// The step at or before a radius ρ that is less than the last. \param near_square  r'² not far from it.
  std::size_t step_before(double radius, double near_square) const;

  double middle_column_, middle_row_;
  double last_height_mm_, last_height_squared_, steps_per_square_;
  double finest_samples_per_mm_ = 0;
  std::vector<SceneMapStep> steps_;
  std::vector<double> radii_;  ///< ρ at the steps; empty if it does not grow throughout
};

}  // namespace petzval
