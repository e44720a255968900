// SPDX-License-Identifier: BSD-3-Clause
// The figures of a chart, laid on a grid of cells by the lens.
#pragma once

#include <petzval/imaging/scene_look.h>
#include <petzval/scene/scene_drawing.h>
#include <petzval/sensor/sensor.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace petzval {

/// The outlines of figures as an image of a grid of cells, at one wavelength: every corner where the lens
/// puts it, and as many more along an edge as its bend there needs. What a figure covers of a cell is then an
/// exact area (ShapeInPicture), however fine the cells.
class DrawnCells {
 public:
  /// Null where the lens does not say where a corner falls. \param drawing  must outlive it.
  static std::unique_ptr<DrawnCells> make(const SceneDrawing& drawing, int band, const SceneLook& look,
                                          const SensorGeometry& grid);

  /// Covers the ground of a row, irradiance, with the figures: radiance × g_source. From any thread.
  void draw(std::size_t row, std::span<const float> g_source_sr, std::span<float> irradiance) const;

 private:
  struct Figure {
    ShapeInPicture shape;
    float radiance;
  };
  std::vector<Figure> figures_;
};

}  // namespace petzval
