// SPDX-License-Identifier: BSD-3-Clause
// The figures of a chart, laid on a grid of cells by the lens.
#pragma once

#include <petzval/imaging/scene_look.h>
#include <petzval/scene/scene_drawing.h>
#include <petzval/sensor/sensor.h>

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace petzval {

/// The outlines of figures as an image of a grid of cells, at one wavelength: every corner where the lens
/// puts it, and as many more along an edge as its bend there needs. What a figure covers of a cell is then an
/// exact area (ShapesInPicture), however fine the cells.
class DrawnCells {
 public:
  /// Null where the lens does not say where a corner falls. \param drawing  must outlive it.
  static std::unique_ptr<DrawnCells> make(const SceneDrawing& drawing, int band, const SceneLook& look,
                                          const SensorGeometry& grid);

  /// What the figures cover of the cells of a row, and with what light. From any thread.
  struct Row {
    std::vector<float> covered, radiance;
  };
  void cover(std::size_t row, Row& cells) const;

 private:
  explicit DrawnCells(ShapesInPicture figures, std::size_t columns)
      : figures_(std::move(figures)), columns_(columns) {}

  ShapesInPicture figures_;
  std::size_t columns_;
};

}  // namespace petzval
