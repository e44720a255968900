// SPDX-License-Identifier: BSD-3-Clause
// Where the light of a place of the image comes from and how much of it: what kinds of lens data tables
// answer.
#pragma once

#include <petzval/imaging/row_view.h>
#include <petzval/sensor/sensor.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace petzval {

/// A place in the scene, in samples (centres at half-integers, rows down), and how much of its light
/// arrives.
struct ScenePlace {
  double column, row, g_source_sr;  ///< g_source 0: no chief ray lands here
};

/// A place of the image [mm].
struct ImagePlace {
  double x_mm = 0, y_mm = 0;
};

/// What a part of a cell sees: a rectangle of the scene about a place, its sides in samples.
struct ScenePart {
  ScenePlace place;
  double width, height;
};

/// How far a grid of cells sees from the axis [samples of the scene]: to left and right, up and down, to the
/// corner.
struct SeenExtent {
  double columns = 0, rows = 0, radius = 0;

  void include(const SeenExtent& other) {
    columns = std::max(columns, other.columns);
    rows = std::max(rows, other.rows);
    radius = std::max(radius, other.radius);
  }
};

/// One wavelength of a lens in front of one scene. Made by field height (HeightLook) or over the frame in two
/// dimensions (FrameLook); whoever follows the light knows neither. Places are in image space [mm], where the
/// light has its centre.
class SceneLook {
 public:
  virtual ~SceneLook() = default;

  virtual ScenePlace place(double x_mm, double y_mm) const = 0;
  /// The place that sees one of the scene (in samples, as place() gives them); beyond the last height and the
  /// lattice it goes on smoothly. Absent where there is none, or more than one. \param near  where to begin.
  virtual std::optional<ImagePlace> image_of(double column, double row, ImagePlace near) const = 0;
  /// What a cell sees about a place, cut into as many parts a side, at most `most`, as make none of them
  /// wider than a sample.
  virtual void cut(double x_mm, double y_mm, double pitch_mm, int most,
                   std::vector<ScenePart>& parts) const = 0;
  /// What the cells of a row see of a plane scene.
  virtual void look(const CellRow& cells, RowView& view) const = 0;

  /// The most samples of the scene that a millimetre spans, about a place and anywhere.
  virtual double samples_per_mm_at(double x_mm, double y_mm) const = 0;
  virtual double finest_samples_per_mm() const = 0;
  /// From there on, farther from the axis, places may be dark.
  virtual double last_height_mm() const = 0;
  /// How far the bright cells of a grid see.
  virtual SeenExtent extent(const SensorGeometry& grid) const = 0;
};

}  // namespace petzval
