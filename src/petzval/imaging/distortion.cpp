// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/distortion.h>
#include <petzval/imaging/panorama_band.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// From a field of the table to a radius in the scene, in samples.
double scene_radius(double field, std::optional<double> object_to_sensor_mm, const Scene& scene) {
  if (scene.is_panorama()) return radians(field) / scene.tangent_per_sample();
  if (object_to_sensor_mm) return field / (*object_to_sensor_mm * scene.tangent_per_sample());
  constexpr double widest_deg = 89.999;  // a plane cannot fill half of space: from here on, beyond any scene
  return std::tan(radians(std::min(field, widest_deg))) / scene.tangent_per_sample();
}

/// Bilinear between sample centres; `column`, `row` in samples.
double radiance_at(std::span<const float> band, const Scene& scene, double column, double row,
                   Surround surround) {
  const double columns = scene.columns(), rows = scene.rows();
  if (surround != Surround::extend && !(column >= 0 && column <= columns && row >= 0 && row <= rows))
    return 0;
  const double u = std::clamp(column - 0.5, 0.0, columns - 1), v = std::clamp(row - 0.5, 0.0, rows - 1);
  const auto j = static_cast<std::size_t>(u), i = static_cast<std::size_t>(v);
  const double right = u - double(j), below = v - double(i);
  const auto width = static_cast<std::size_t>(scene.columns());
  const std::size_t j_next = std::min(j + 1, width - 1);
  const float* here = band.data() + i * width;
  const float* next = band.data() + std::min(i + 1, static_cast<std::size_t>(scene.rows()) - 1) * width;
  const double upper = here[j] + right * (double(here[j_next]) - here[j]);
  const double lower = next[j] + right * (double(next[j_next]) - next[j]);
  return upper + below * (lower - upper);
}

/// The same well within the scene, where nothing needs to be asked.
double radiance_inside(const float* band, std::ptrdiff_t width, double column, double row) {
  const double u = column - 0.5, v = row - 0.5;
  const auto j = static_cast<std::ptrdiff_t>(u), i = static_cast<std::ptrdiff_t>(v);
  const double right = u - double(j), below = v - double(i);
  const float *here = band + i * width + j, *next = here + width;
  const double upper = double(here[0]) + right * (double(here[1]) - double(here[0]));
  const double lower = double(next[0]) + right * (double(next[1]) - double(next[0]));
  return upper + below * (lower - upper);
}

}  // namespace

SceneMap::SceneMap(const LightProfile& lens, std::optional<double> object_to_sensor_mm, const Scene& scene,
                   double largest_height_mm)
    : middle_column_(scene.columns() / 2.0),
      middle_row_(scene.rows() / 2.0),
      last_height_mm_(std::min(lens.max_height_mm(), largest_height_mm)),
      last_height_squared_(last_height_mm_ * last_height_mm_) {
  constexpr std::size_t step_count = 4096;
  steps_per_square_ = last_height_squared_ > 0 ? double(step_count) / last_height_squared_ : 0;
  // Towards the axis ρ/r' tends to a constant: taken where it is still numerically sound.
  const double near_axis_mm = 1e-4 * last_height_mm_;
  for (std::size_t k = 0; k <= step_count + 1; ++k) {
    const double height_mm = last_height_mm_ * std::sqrt(std::min(1.0, double(k) / double(step_count)));
    const double off_axis_mm = std::max(height_mm, near_axis_mm);
    const double ratio =
        off_axis_mm > 0
            ? scene_radius(lens.object_field(off_axis_mm), object_to_sensor_mm, scene) / off_axis_mm
            : 0.0;
    steps_.push_back({ratio, lens.g_source_sr(height_mm)});
    if (k == 0 || k > step_count) continue;
    const double below_mm = last_height_mm_ * std::sqrt(double(k - 1) / double(step_count));
    const double radial =
        (ratio * height_mm - steps_[k - 1].samples_per_mm * below_mm) / (height_mm - below_mm);
    finest_samples_per_mm_ = std::max({finest_samples_per_mm_, radial, ratio});
  }
  for (std::size_t k = 0; k + 1 < steps_.size(); ++k) {
    steps_[k].samples_slope = (steps_[k + 1].samples_per_mm - steps_[k].samples_per_mm) * steps_per_square_;
    steps_[k].g_source_slope = (steps_[k + 1].g_source_sr - steps_[k].g_source_sr) * steps_per_square_;
  }
}

SceneMap::Surroundings SceneMap::around(double x_mm, double y_mm) const {
  const double square = std::min(x_mm * x_mm + y_mm * y_mm, last_height_squared_);
  const auto k = static_cast<std::size_t>(square * steps_per_square_);
  const SceneMapStep& step = steps_[k];
  const double further = steps_per_square_ > 0 ? square - double(k) / steps_per_square_ : 0;
  return {middle_column_,
          middle_row_,
          last_height_squared_ * (1 + 1e-12),  // rounding must not darken the rim
          square,
          step.samples_per_mm + further * step.samples_slope,
          step.samples_slope,
          step.g_source_sr + further * step.g_source_slope,
          step.g_source_slope};
}

SeenExtent seen_extent(const SceneMap& map, const SensorGeometry& grid) {
  // ρ grows with r', so the outline of the grid sees farthest; where it lies in the dark, the last bright
  // place on the way there. One quadrant is enough: the others are its mirror images.
  SeenExtent seen;
  const SceneMap::Place axis = map.place(0, 0);
  const auto look = [&](double x_mm, double y_mm) {
    const double shrink = std::min(1.0, map.last_height_mm() / std::hypot(x_mm, y_mm));
    const SceneMap::Place place = map.place(shrink * x_mm, shrink * y_mm);
    const double columns = std::abs(place.column - axis.column), rows = std::abs(place.row - axis.row);
    seen.columns = std::max(seen.columns, columns);
    seen.rows = std::max(seen.rows, rows);
    seen.radius = std::max(seen.radius, std::hypot(columns, rows));
  };
  for (double column = grid.columns; column > grid.columns / 2.0; --column)
    look(grid.x_mm(column), grid.y_mm(0));
  for (double row = grid.rows; row > grid.rows / 2.0; --row) look(grid.x_mm(0), grid.y_mm(row));
  look(grid.x_mm(grid.columns / 2.0), grid.y_mm(0));
  look(grid.x_mm(0), grid.y_mm(grid.rows / 2.0));
  return seen;
}

namespace {

/// Takes the scene at several points of each cell. \param seen  radiance at the place of a point, given the
/// place of its cell's centre. \param quick_at  a row of the upper half ↦ (row, from, irradiance) ↦ the first
/// cell that it leaves to do, for that row and its mirror image below.
template <typename Seen, typename QuickAt>
CellPlane averaged(const SceneMap& map, const SensorGeometry& grid, int parts, const Seen& seen,
                   const QuickAt& quick_at) {
  CellPlane plane = CellPlane::unset(grid);
  const double pitch_mm = grid.pitch_um * mm_per_um;
  constexpr double rounding = 1e-6;
  std::vector<std::vector<double>> offsets_mm(static_cast<std::size_t>(parts) + 1);
  for (int count = 1; count <= parts; ++count)
    for (int part = 0; part < count; ++part)
      offsets_mm[static_cast<std::size_t>(count)].push_back(((part + 0.5) / count - 0.5) * pitch_mm);
  const auto form_row = [&](std::size_t row, const auto& quick) {
    const double y_mm = grid.y_mm(double(row) + 0.5);
    const std::size_t slow_at_once = sampled_at_once();
    for (std::size_t column = 0, slow = 0; column < plane.columns(); ++column) {
      if (slow == 0) column = quick(row, column, plane.row(row));
      if (column == plane.columns()) break;
      slow = (slow + 1) % slow_at_once;
      const double x_mm = grid.x_mm(double(column) + 0.5);
      const SceneMap::Surroundings near = map.around(x_mm, y_mm);
      const auto radiance = seen(near.place(x_mm, y_mm));
      // A distorted image shrinks the scene here more than there.
      const double samples = near.finest_samples_per_mm() * pitch_mm;
      const auto count =
          static_cast<std::size_t>(std::clamp(std::ceil(samples - rounding), 1.0, double(parts)));
      double sum = 0;
      for (const double down_mm : offsets_mm[count])
        for (const double across_mm : offsets_mm[count]) {
          const SceneMap::Place place = near.place(x_mm + across_mm, y_mm + down_mm);
          if (place.g_source_sr != 0) sum += place.g_source_sr * radiance(place);
        }
      plane.row(row)[column] = static_cast<float>(sum / double(count * count));
    }
  };
  parallel_for((plane.rows() + 1) / 2, [&](std::size_t row) {
    const auto quick = quick_at(row);
    const std::size_t mirrored = plane.rows() - 1 - row;
    form_row(row, quick);
    if (mirrored != row) form_row(mirrored, quick);
  });
  return plane;
}

CellPlane ideal_of_plane(const Scene& scene, int band, const SceneMap& map, const SensorGeometry& grid,
                         int parts, Surround surround) {
  const std::span<const float> radiance = scene.band(band);
  // From a cell's centre to its farthest point, in samples, and one more for the bilinear neighbours.
  const double room = map.finest_samples_per_mm() * grid.pitch_um * mm_per_um + 1.5;
  const PlaneView view{radiance.data(), double(scene.columns()), double(scene.rows()), room};
  const auto quick_at = [&](std::size_t upper) {
    RowView cells;
    if (parts == 1)
      cells.look(map.steps(), {grid.pitch_um * mm_per_um, grid.y_mm(double(upper) + 0.5),
                               static_cast<std::size_t>(grid.columns)});
    return [&view, parts, upper, cells = std::move(cells)](std::size_t row, std::size_t from,
                                                           float* irradiance) {
      return parts > 1 ? from : sample_row(view, cells, row == upper ? 1 : -1, from, irradiance);
    };
  };
  const auto seen = [&](const SceneMap::Place& centre) {
    const bool inside = centre.column > room && centre.column < scene.columns() - room && centre.row > room &&
                        centre.row < scene.rows() - room;
    return [&, inside](const SceneMap::Place& place) {
      return inside ? radiance_inside(radiance.data(), scene.columns(), place.column, place.row)
                    : radiance_at(radiance, scene, place.column, place.row, surround);
    };
  };
  return averaged(map, grid, parts, seen, quick_at);
}

CellPlane ideal_of_panorama(const Scene& scene, int band, const SceneMap& map, const SensorGeometry& grid,
                            int parts) {
  const PanoramaBand panorama(scene, band);
  const double middle_column = scene.columns() / 2.0, middle_row = scene.rows() / 2.0;
  const auto seen = [&](const SceneMap::Place&) {
    return [&](const SceneMap::Place& place) {
      return panorama.radiance(place.column - middle_column, place.row - middle_row);
    };
  };
  const auto nothing_quick = [](std::size_t) {
    return [](std::size_t, std::size_t from, float*) { return from; };
  };
  return averaged(map, grid, parts, seen, nothing_quick);
}

}  // namespace

CellPlane ideal_irradiance(const Scene& scene, int band, const SceneMap& map, const SensorGeometry& grid,
                           int parts, Surround surround) {
  return scene.is_panorama() ? ideal_of_panorama(scene, band, map, grid, parts)
                             : ideal_of_plane(scene, band, map, grid, parts, surround);
}

}  // namespace petzval
