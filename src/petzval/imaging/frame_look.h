// SPDX-License-Identifier: BSD-3-Clause
// What a lens sees whose table lies over the frame in two dimensions.
#pragma once

#include <petzval/imaging/light_centre.h>
#include <petzval/imaging/scene_look.h>
#include <petzval/numeric/lattice_spline.h>
#include <petzval/optics/lens_data_table.h>
#include <petzval/scene/scene.h>

#include <vector>

namespace petzval {

/// Places in the scene and g_source as bicubic splines over the places of the table. Along a row of cells
/// they are cubics, interval by interval. The rectangle that a cell sees has its sides along the scene's: the
/// flux of a sample is exact to the square of the angle by which the lens turns the picture there.
class FrameLook : public SceneLook {
 public:
  /// \throws InputError for a wavelength that the table does not cover.
  FrameLook(const LensDataTable& table, const LightCentres& centres, double wavelength_nm,
            const Scene& scene);

  ScenePlace place(double x_mm, double y_mm) const override;
  std::optional<ImagePlace> image_of(double column, double row, ImagePlace near) const override;
  void cut(double x_mm, double y_mm, double pitch_mm, int most, std::vector<ScenePart>& parts) const override;
  void look(const CellRow& cells, RowView& view) const override;
  double samples_per_mm_at(double x_mm, double y_mm) const override;
  double finest_samples_per_mm() const override { return finest_samples_per_mm_; }
  double last_height_mm() const override { return last_height_mm_; }
  SeenExtent extent(const SensorGeometry& grid) const override;

 private:
  double middle_column_, middle_row_;
  double last_height_mm_, finest_samples_per_mm_ = 0;
  LatticeSpline right_, down_;  ///< from the middle of the scene [samples]
  LatticeSpline g_source_sr_;
};

}  // namespace petzval
