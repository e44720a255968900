// SPDX-License-Identifier: BSD-3-Clause
// Which part of the scene each place of the image sees.
#pragma once

#include <petzval/imaging/light_centre.h>
#include <petzval/imaging/scene_look.h>
#include <petzval/scene/scene.h>
#include <petzval/sensor/sensor.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace petzval {

/// What is seen beyond the edges of a scene that does not cover the field.
enum class Surround {
  error,  ///< InputError, unless it covers the frame and margin_of() beyond; from there as with `extend`
  zero,   ///< darkness
  extend  ///< the nearest sample of the scene
};

/// The way from image space to the samples of a scene at one wavelength, whatever the kind of the table.
class SceneMap {
 public:
  using Place = ScenePlace;

  /// \param look  not null.
  explicit SceneMap(std::shared_ptr<const SceneLook> look) : look_(std::move(look)) {}
  /// Of a centred lens: HeightLook.
  SceneMap(const LightProfile& lens, std::optional<double> object_to_sensor_mm, const Scene& scene,
           double largest_height_mm);
  /// At a wavelength of a table, as its kind has it. \param largest_height_mm  the farthest from the axis
  /// that place() will be asked for. \throws InputError for a wavelength that the table does not cover, and
  /// for a polynomial fit of a table over the frame.
  SceneMap(const LensDataTable& table, const LightCentres& centres, RadialFit fit, double wavelength_nm,
           const Scene& scene, double largest_height_mm);

  Place place(double x_mm, double y_mm) const { return look_->place(x_mm, y_mm); }
  const SceneLook& look() const { return *look_; }
  double last_height_mm() const { return look_->last_height_mm(); }
  double finest_samples_per_mm() const { return look_->finest_samples_per_mm(); }
  double samples_per_mm_at(double x_mm, double y_mm) const { return look_->samples_per_mm_at(x_mm, y_mm); }

 private:
  std::shared_ptr<const SceneLook> look_;
};

inline SeenExtent seen_extent(const SceneMap& map, const SensorGeometry& grid) {
  return map.look().extent(grid);
}

/// How far from the middle of a scene a field of a table lies [samples]. \param object_to_sensor_mm  where a
/// finite object stands; absent: at infinity, fields are degrees.
double scene_radius(double field, std::optional<double> object_to_sensor_mm, const Scene& scene);

/// From the object plane to the sensor plane [mm]; absent: infinity.
std::optional<double> object_to_sensor_mm(const LensDataTable& table);

}  // namespace petzval
