// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/scene_rows.h>
#include <petzval/imaging/source_light.h>
#include <petzval/wave/photosite.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace petzval {

namespace {

constexpr int most_points = 64;  ///< of the scene along a part

/// The rows of parts that a row of cells takes its light from, made once for the rows that share them.
class PartRows {
 public:
  PartRows(const SceneRows& rows, const SourceFilter& filter, std::size_t cells)
      : rows_(rows),
        filter_(filter),
        cells_(cells),
        part_row_(static_cast<std::size_t>(rows.grid().columns)),
        kept_(filter.weights.size()) {}

  /// Filtered along the row. \param index  of the row of parts; they are asked for in order.
  const std::vector<float>& at(std::size_t index) {
    Row& row = kept_[index % kept_.size()];
    if (row.index != index + 1) {
      rows_.write(index, part_row_.data());
      filter_along(row.values);
      row.index = index + 1;
    }
    return row.values;
  }

 private:
  struct Row {
    std::size_t index = 0;  ///< and one, lest the first be taken for made
    std::vector<float> values;
  };

  void filter_along(std::vector<float>& values) const {
    values.assign(cells_, 0);
    const auto step = static_cast<std::size_t>(filter_.parts);
    for (std::size_t k = 0; k < filter_.weights.size(); ++k) {
      const auto weight = static_cast<float>(filter_.weights[k]);
      const float* parts = part_row_.data() + k;
      for (std::size_t cell = 0; cell < cells_; ++cell) values[cell] += weight * parts[cell * step];
    }
  }

  const SceneRows& rows_;
  const SourceFilter& filter_;
  std::size_t cells_;
  std::vector<float> part_row_;
  std::vector<Row> kept_;
};

}  // namespace

SourceFilter::SourceFilter(int cell_parts) : parts(cell_parts) {
  if (parts == 1) return;
  constexpr int means = 3;
  for (int mean = 0; mean < means; ++mean) {
    std::vector<double> wider(weights.size() + static_cast<std::size_t>(parts) - 1);
    for (std::size_t i = 0; i < weights.size(); ++i)
      for (std::size_t part = 0; part < static_cast<std::size_t>(parts); ++part)
        wider[i + part] += weights[i] / parts;
    weights = std::move(wider);
  }
}

double SourceFilter::transform(double frequency) const {
  double sum = 0;
  for (std::size_t k = 0; k < weights.size(); ++k)
    sum += weights[k] * std::cos(2 * pi * frequency * (double(k) - (double(weights.size()) - 1) / 2) / parts);
  return sum * sinc(frequency / parts);
}

CellPlane source_light(const Scene& scene, int band, const SceneMap& map, const SensorGeometry& grid,
                       const SourceFilter& filter, Surround surround, const SceneAim& aim) {
  const SensorGeometry parts = grown(subdivided(grid, filter.parts), filter.reach());
  const SceneRows rows(scene, band, map, parts, most_points, surround, aim);
  CellPlane plane = CellPlane::unset(grid);
  constexpr std::size_t rows_at_once = 16;
  parallel_for((plane.rows() + rows_at_once - 1) / rows_at_once, [&](std::size_t block) {
    PartRows part_rows(rows, filter, plane.columns());
    const std::size_t end = std::min(plane.rows(), (block + 1) * rows_at_once);
    for (std::size_t row = block * rows_at_once; row < end; ++row) {
      float* cells = plane.row(row);
      std::fill_n(cells, plane.columns(), 0.0F);
      for (std::size_t k = 0; k < filter.weights.size(); ++k) {
        const auto weight = static_cast<float>(filter.weights[k]);
        const std::vector<float>& values = part_rows.at(row * static_cast<std::size_t>(filter.parts) + k);
        for (std::size_t cell = 0; cell < plane.columns(); ++cell) cells[cell] += weight * values[cell];
      }
    }
  });
  return plane;
}

}  // namespace petzval
