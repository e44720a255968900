// SPDX-License-Identifier: BSD-3-Clause
// The light of a scene on a grid of cells before blur, row by row.
#pragma once

#include <petzval/imaging/cell_plane.h>
#include <petzval/imaging/distortion.h>
#include <petzval/imaging/drawn_cells.h>
#include <petzval/imaging/flat_blocks.h>
#include <petzval/imaging/plane_sampling.h>
#include <petzval/imaging/scene_aim.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace petzval {

class PanoramaBand;

/// Irradiance before blur, radiance × g_source, on the rows of a grid: the mean of each cell over what it
/// sees of the scene.
///
/// The radiance of a planar scene is bilinear between the centres of its samples, and that of the edge within
/// half a sample of it. A cell sees a rectangle with the sides that the map gives it; rectangles of
/// neighbouring cells meet, and the mean is exact. So the flux of each sample is the same wherever it falls
/// on the cells, to the square of the angle by which the map turns them. A cell that sees more than a sample
/// along a side is cut into parts that do not. In a panorama parts count at their middles.
///
/// Of a chart whose drawing is known the samples serve only along the edge of the scene; elsewhere its
/// figures cover cells by exact areas (DrawnCells).
class SceneRows {
 public:
  /// \param parts  a cell is cut into at most parts × parts. \param surround  what lies beyond the scene;
  /// `error` here means zero (form_image() looks before). Everything given must outlive the rows.
  SceneRows(const Scene& scene, int band, const SceneMap& map, const SensorGeometry& grid, int parts,
            Surround surround, const SceneAim& aim = {});
  /// The same under another aim.
  SceneRows(const SceneRows& other, const SceneAim& aim);
  ~SceneRows();
  SceneRows(const SceneRows&) = delete;
  SceneRows& operator=(const SceneRows&) = delete;

  /// Writes a row of the grid. From any thread.
  void write(std::size_t row, float* irradiance) const {
    RowView straight;
    look(row, straight);
    write(row, straight, irradiance);
  }
  /// The same in two steps: what the cells of a row would see of the scene if the camera looked at its
  /// middle, which rows that differ in their aim alone share.
  void look(std::size_t row, RowView& straight) const;
  void write(std::size_t row, const RowView& straight, float* irradiance) const;
  const SensorGeometry& grid() const { return grid_; }

 private:
  /// A rectangle of the scene: its middle and its sides, in samples.
  struct Rectangle {
    double column, row, width, height;
  };
  PlaneView view_of(std::span<const float> samples) const;
  double mean(std::span<const float> samples, const Rectangle& seen) const;
  /// Mean of samples × g_source over a cell.
  double cell(std::span<const float> samples, double x_mm, double y_mm) const;
  /// The same of one whose place in a row is known.
  float cell_in_row(std::size_t row, std::size_t column, const RowView& cells,
                    std::span<const float> samples) const;
  /// The cells [from, to) of a row.
  void write_samples(std::size_t row, const RowView& cells, std::span<const float> samples, std::size_t from,
                     std::size_t to, float* irradiance) const;
  void write_drawing(std::size_t row, const RowView& cells, const DrawnCells::Row& drawn, std::size_t from,
                     std::size_t to, float* irradiance) const;
  /// The radiance that the cells [from, to) of a row see, if all of them see the same.
  std::optional<float> flat_value(const RowView& cells, std::span<const float> samples, std::size_t from,
                                  std::size_t to) const;

  const Scene& scene_;
  std::size_t band_;
  const SceneMap& map_;
  SensorGeometry grid_;
  int parts_;
  Surround surround_;
  AimedPlane aimed_;
  std::span<const float> radiance_;
  std::unique_ptr<PanoramaBand> panorama_;
  std::shared_ptr<const DrawnCells> drawn_;  ///< if the camera looks straight
  std::shared_ptr<const FlatBlocks> flat_;   ///< of radiance_; null where none is
};

/// All rows of SceneRows.
CellPlane ideal_irradiance(const Scene& scene, int band, const SceneMap& map, const SensorGeometry& grid,
                           int parts, Surround surround);

}  // namespace petzval
