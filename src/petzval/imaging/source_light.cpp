// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/row_phases.h>
#include <petzval/imaging/scene_rows.h>
#include <petzval/imaging/source_light.h>
#include <petzval/wave/photosite.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

namespace petzval {

namespace {

constexpr int most_points = 64;  ///< of the scene along a part

/// The rows of parts that a row of cells takes its light from, made once for the rows that share them.
class PartRows {
 public:
  /// One of the lights.
  struct Source {
    std::vector<std::unique_ptr<SceneRows>> rows;
    std::vector<float> weights;
  };

  PartRows(const std::vector<Source>& sources, const SourceFilter& filter, std::size_t cells)
      : sources_(sources),
        filter_(filter),
        weights_(filter.weights.begin(), filter.weights.end()),
        cells_(cells),
        looks_(filter.weights.size()),
        kept_(sources.size() * filter.weights.size()) {}

  /// Whether cells are parts, which no filter alters.
  bool is_plain() const { return filter_.weights.size() == 1 && filter_.weights.front() == 1; }

  /// Filtered along the row. \param index  of the row of parts; they are asked for in order.
  const std::vector<float>& at(std::size_t source, std::size_t index) {
    Kept& row = kept_[source * looks_.size() + index % looks_.size()];
    if (row.index != index + 1) {
      part_row_.resize(static_cast<std::size_t>(sources_[source].rows.front()->grid().columns));
      write(sources_[source], index, part_row_);
      filter_along(row.values);
      row.index = index + 1;
    }
    return row.values;
  }

  /// Light that is not filtered.
  void write(std::size_t source, std::size_t index, std::span<float> values) {
    write(sources_[source], index, values);
  }

 private:
  // Indices are one more, lest the first be taken for made.
  struct Look {
    std::size_t index = 0;
    RowView view = {};
  };
  struct Kept {
    std::size_t index = 0;
    std::vector<float> values = {};
  };

  void write(const Source& source, std::size_t index, std::span<float> values) {
    const SceneRows& first = *source.rows.front();
    Look& look = looks_[index % looks_.size()];
    if (look.index != index + 1) {
      first.look(index, look.view);
      look.index = index + 1;
    }
    first.write(index, look.view, values.data());
    if (source.rows.size() == 1 && source.weights.front() == 1) return;
    for (float& value : values) value *= source.weights.front();
    of_share_.resize(values.size());
    for (std::size_t share = 1; share < source.rows.size(); ++share) {
      source.rows[share]->write(index, look.view, of_share_.data());
      for (std::size_t i = 0; i < values.size(); ++i) values[i] += source.weights[share] * of_share_[i];
    }
  }

  void filter_along(std::vector<float>& values) {
    const auto parts = static_cast<std::size_t>(filter_.parts);
    sort_out_phases(part_row_, parts, phases_);
    const std::size_t length = phases_.size() / parts;
    values.assign(cells_, 0.0F);
    for (std::size_t k = 0; k < weights_.size(); ++k) {
      const float weight = weights_[k], *of_phase = phases_.data() + k % parts * length + k / parts;
      for (std::size_t cell = 0; cell < cells_; ++cell) values[cell] += weight * of_phase[cell];
    }
  }

  const std::vector<Source>& sources_;
  const SourceFilter& filter_;
  std::vector<float> weights_;
  std::size_t cells_;
  std::vector<Look> looks_;
  std::vector<Kept> kept_;  ///< [source][row, by turns]
  std::vector<float> part_row_, of_share_, phases_;
};

}  // namespace

SourceFilter::SourceFilter(int cell_parts, double threefold) : parts(cell_parts) {
  const auto count = static_cast<std::size_t>(parts);
  const std::vector<double> plain(count, 1.0 / parts);
  weights = plain;
  if (threefold == 0) return;
  for (int mean = 1; mean < 3; ++mean) {
    std::vector<double> wider(weights.size() + count - 1);
    for (std::size_t i = 0; i < weights.size(); ++i)
      for (std::size_t part = 0; part < count; ++part) wider[i + part] += weights[i] / parts;
    weights = std::move(wider);
  }
  for (double& weight : weights) weight *= threefold;
  for (std::size_t part = 0; part < count; ++part) weights[count - 1 + part] += (1 - threefold) * plain[part];
}

double SourceFilter::transform(double frequency) const {
  double sum = 0;
  for (std::size_t k = 0; k < weights.size(); ++k)
    sum += weights[k] * std::cos(2 * pi * frequency * (double(k) - (double(weights.size()) - 1) / 2) / parts);
  return sum * sinc(frequency / parts);
}

std::vector<CellPlane> source_lights(const Scene& scene, int band, const SceneMap& map,
                                     const SensorGeometry& grid, const SourceFilter& filter,
                                     Surround surround, std::span<const AimedLight> lights) {
  const SensorGeometry parts = grown(subdivided(grid, filter.parts), filter.reach());
  const SceneRows straight(scene, band, map, parts, most_points, surround);
  std::vector<PartRows::Source> sources;
  std::vector<CellPlane> planes;
  for (const AimedLight& light : lights) {
    PartRows::Source& source = sources.emplace_back();
    for (const auto& [aim, weight] : light.shares) {
      source.rows.push_back(std::make_unique<SceneRows>(straight, aim));
      source.weights.push_back(static_cast<float>(weight));
    }
    planes.push_back(CellPlane::unset(grid));
  }
  const auto cells = static_cast<std::size_t>(grid.columns), rows = static_cast<std::size_t>(grid.rows);
  constexpr std::size_t rows_at_once = 16;
  parallel_for((rows + rows_at_once - 1) / rows_at_once, [&](std::size_t block) {
    PartRows part_rows(sources, filter, cells);
    const std::size_t end = std::min(rows, (block + 1) * rows_at_once);
    for (std::size_t row = block * rows_at_once; row < end; ++row)
      for (std::size_t i = 0; i < lights.size(); ++i) {
        float* out = planes[i].row(row);
        if (!lights[i].rows.holds(static_cast<int>(row))) {
          std::fill_n(out, cells, 0.0F);
          continue;
        }
        if (part_rows.is_plain()) {
          part_rows.write(i, row, {out, cells});
          continue;
        }
        for (std::size_t k = 0; k < filter.weights.size(); ++k) {
          const auto weight = static_cast<float>(filter.weights[k]);
          const std::vector<float>& values =
              part_rows.at(i, row * static_cast<std::size_t>(filter.parts) + k);
          if (k == 0)
            for (std::size_t cell = 0; cell < cells; ++cell) out[cell] = weight * values[cell];
          else
            for (std::size_t cell = 0; cell < cells; ++cell) out[cell] += weight * values[cell];
        }
      }
  });
  return planes;
}

CellPlane source_light(const Scene& scene, int band, const SceneMap& map, const SensorGeometry& grid,
                       const SourceFilter& filter, Surround surround) {
  const AimedLight straight;
  return std::move(source_lights(scene, band, map, grid, filter, surround, std::span(&straight, 1)).front());
}

}  // namespace petzval
