// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/drawn_cells.h>
#include <petzval/imaging/panorama_band.h>
#include <petzval/imaging/scene_rows.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace petzval {

namespace {

/// A stretch of one axis of a scene: the three samples that share in it, and how much of it lies in the
/// scene.
struct Stretch {
  std::array<std::size_t, 3> samples{};
  std::array<double, 3> weights{};

  Stretch(double middle, double length, int count, Surround surround) {
    const double nearest = std::floor(middle), inside = share_inside(middle, length, count, surround);
    const LinearMean mean(middle - nearest - 0.5, length);
    weights = {inside * mean.before, inside * mean.here, inside * mean.after};
    for (int i = 0; i < 3; ++i)
      samples[static_cast<std::size_t>(i)] =
          static_cast<std::size_t>(std::clamp(nearest + i - 1, 0.0, double(count - 1)));
  }

 private:
  static double share_inside(double middle, double length, int count, Surround surround) {
    if (surround != Surround::zero) return 1;
    const double from = std::max(0.0, middle - length / 2), to = std::min(double(count), middle + length / 2);
    return std::max(0.0, to - from) / length;
  }
};

/// What values of a smooth map lie between, over a short stretch of a row: between three places a parabola
/// tells how far the others go.
template <typename Value>
std::pair<double, double> range_of(const std::vector<Value>& of, std::size_t from, std::size_t to) {
  const std::size_t last = to - 1, half = (from + last) / 2;
  const double ends[] = {double(of[from]), double(of[half]), double(of[last])};
  const double bend = std::abs(ends[1] - (ends[0] + ends[2]) / 2);
  const auto [low, high] = std::minmax({ends[0], ends[1], ends[2]});
  return {low - bend, high + bend};
}

/// Whether a short stretch of cells looks at the scene alone. False if that takes a closer look.
bool is_surely_inside(const PlaneView& view, const RowView& cells, std::size_t from, std::size_t to) {
  if (from < cells.dark || to > cells.g_source_sr.size() - cells.dark) return false;
  constexpr double room = 1;  // beyond the rectangles [samples]
  const auto inside = [&](const std::vector<double>& middles, const std::vector<float>& sides, double size) {
    const auto [low, high] = range_of(middles, from, to);
    return std::max(-low, high) + range_of(sides, from, to).second / 2 + room < size / 2;
  };
  return inside(cells.right, cells.width, view.columns) && inside(cells.down, cells.height, view.rows);
}

PanoramaView turned(const Scene& scene, const SceneAim& aim) {
  return {scene.view().yaw_deg + aim.pan_deg, scene.view().pitch_deg + aim.pitch_deg};
}

}  // namespace

SceneRows::SceneRows(const Scene& scene, int band, const SceneMap& map, const SensorGeometry& grid, int parts,
                     Surround surround, const SceneAim& aim)
    : scene_(scene),
      band_(static_cast<std::size_t>(band)),
      map_(map),
      grid_(grid),
      parts_(parts),
      surround_(surround),
      aimed_(aim, scene),
      radiance_(scene.band(band)) {
  if (const SceneDrawing* drawing = scene.drawing(); drawing != nullptr && aimed_.is_straight())
    drawn_ = DrawnCells::make(*drawing, band, map.look(), grid);
  if (scene.is_panorama()) {
    panorama_ = std::make_unique<PanoramaBand>(scene, band, turned(scene, aim));
    return;
  }
  const auto flat = std::make_shared<FlatBlocks>(radiance_, static_cast<std::size_t>(scene.columns()),
                                                 static_cast<std::size_t>(scene.rows()));
  if (flat->any()) flat_ = flat;
}

SceneRows::SceneRows(const SceneRows& other, const SceneAim& aim)
    : scene_(other.scene_),
      band_(other.band_),
      map_(other.map_),
      grid_(other.grid_),
      parts_(other.parts_),
      surround_(other.surround_),
      aimed_(aim, other.scene_),
      radiance_(other.radiance_),
      flat_(other.flat_) {
  if (aimed_.is_straight()) drawn_ = other.drawn_;
  if (other.panorama_) panorama_ = std::make_unique<PanoramaBand>(*other.panorama_, turned(scene_, aim));
}

SceneRows::~SceneRows() = default;

double SceneRows::mean(std::span<const float> samples, const Rectangle& seen) const {
  const Stretch across(seen.column, seen.width, scene_.columns(), surround_),
      down(seen.row, seen.height, scene_.rows(), surround_);
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const float* row = samples.data() + down.samples[i] * static_cast<std::size_t>(scene_.columns());
    double of_row = 0;
    for (std::size_t j = 0; j < 3; ++j) of_row += across.weights[j] * double(row[across.samples[j]]);
    sum += down.weights[i] * of_row;
  }
  return sum;
}

double SceneRows::cell(std::span<const float> samples, double x_mm, double y_mm) const {
  thread_local std::vector<ScenePart> parts;
  map_.look().cut(x_mm, y_mm, grid_.pitch_um * mm_per_um, parts_, parts);
  double sum = 0;
  for (const ScenePart& part : parts) {
    const ScenePlace& place = part.place;
    if (place.g_source_sr == 0) continue;
    if (panorama_) {
      sum += place.g_source_sr *
             panorama_->radiance(place.column - scene_.columns() / 2.0, place.row - scene_.rows() / 2.0);
      continue;
    }
    constexpr double least = 1e-9;  // a length to divide by
    const auto side = [&](double samples) { return std::clamp(samples, least, 1.0); };
    const AimedPlane::Place seen =
        aimed_.at(place.column - scene_.columns() / 2.0, place.row - scene_.rows() / 2.0);
    if (std::isnan(seen.right)) continue;
    const double column = aimed_.is_straight() ? place.column : scene_.columns() / 2.0 + seen.right;
    const double row = aimed_.is_straight() ? place.row : scene_.rows() / 2.0 + seen.down;
    sum += place.g_source_sr * mean(samples, {column, row, side(part.width * seen.widening),
                                              side(part.height * seen.heightening)});
  }
  return sum / double(parts.size());
}

float SceneRows::cell_in_row(std::size_t row, std::size_t column, const RowView& cells,
                             std::span<const float> samples) const {
  const auto anywhere = [&] {
    return cell(samples, grid_.x_mm(double(column) + 0.5), grid_.y_mm(double(row) + 0.5));
  };
  if (panorama_ || column < cells.dark || column >= cells.width.size() - cells.dark)
    return static_cast<float>(anywhere());
  const auto width = double(cells.width[column]), height = double(cells.height[column]);
  if (!(std::min(width, height) > 0) || !(std::max(width, height) <= 1))
    return static_cast<float>(anywhere());
  const Rectangle seen{scene_.columns() / 2.0 + cells.right[column], scene_.rows() / 2.0 + cells.down[column],
                       width, height};
  return static_cast<float>(double(cells.g_source_sr[column]) * mean(samples, seen));
}

PlaneView SceneRows::view_of(std::span<const float> samples) const {
  return {samples.data(), double(scene_.columns()), double(scene_.rows()), surround_ == Surround::zero};
}

void SceneRows::write_samples(std::size_t row, const RowView& cells, std::span<const float> samples,
                              std::size_t from, std::size_t to, float* irradiance) const {
  if (const std::optional<float> value = flat_value(cells, samples, from, to)) {
    for (std::size_t column = from; column < to; ++column)
      irradiance[column] = *value * cells.g_source_sr[column];
    return;
  }
  const PlaneView view = view_of(samples);
  const std::size_t at_once = sampled_at_once();
  for (std::size_t column = from; column < to;) {
    if (!panorama_) column = sample_row(view, cells, column, to, irradiance);
    const std::size_t end = panorama_ ? to : std::min(to, column + at_once);
    for (; column < end; ++column) irradiance[column] = cell_in_row(row, column, cells, samples);
  }
}

void SceneRows::write_drawing(std::size_t row, const RowView& cells, const DrawnCells::Row& drawn,
                              std::size_t from, std::size_t to, float* irradiance) const {
  const SceneDrawing& drawing = *scene_.drawing();
  const float ground = drawing.ground[band_];
  const float *covered = drawn.covered.data(), *radiance = drawn.radiance.data(),
              *g_source_sr = cells.g_source_sr.data();
  const auto is_bare = [](float share) { return share < 1; };
  if (drawing.texture && std::any_of(covered + from, covered + to, is_bare)) {
    write_samples(row, cells, *drawing.texture, from, to, irradiance);
    for (std::size_t column = from; column < to; ++column)
      irradiance[column] =
          (1 - covered[column]) * ground * irradiance[column] + radiance[column] * g_source_sr[column];
  } else {
    for (std::size_t column = from; column < to; ++column)
      irradiance[column] = ((1 - covered[column]) * ground + radiance[column]) * g_source_sr[column];
  }
  const PlaneView view = view_of(radiance_);
  if (is_surely_inside(view, cells, from, to)) return;
  for (std::size_t column = first_outside(view, cells, from, to); column < to;) {
    std::size_t end = column + 1;
    while (end < to && first_outside(view, cells, end, end + 1) == end) ++end;
    write_samples(row, cells, radiance_, column, end, irradiance);
    column = first_outside(view, cells, end, to);
  }
}

std::optional<float> SceneRows::flat_value(const RowView& cells, std::span<const float> samples,
                                           std::size_t from, std::size_t to) const {
  if (!flat_ || samples.data() != radiance_.data() || from < cells.dark ||
      to > cells.g_source_sr.size() - cells.dark)
    return {};
  const auto [left, right] = range_of(cells.right, from, to);
  const auto [top, bottom] = range_of(cells.down, from, to);
  if (!(std::max(range_of(cells.width, from, to).second, range_of(cells.height, from, to).second) <= 1))
    return {};
  if (!std::isfinite(left + right + top + bottom)) return {};
  constexpr double around = 1.5;  // half a cell, and the neighbour to whose centre radiance runs
  const double middle = scene_.columns() / 2.0, centre = scene_.rows() / 2.0;
  return flat_->value_in(middle + left - around, middle + right + around, centre + top - around,
                         centre + bottom + around, surround_ != Surround::zero);
}

void SceneRows::look(std::size_t row, RowView& straight) const {
  if (!panorama_)
    map_.look().look(
        {grid_.pitch_um * mm_per_um, grid_.y_mm(double(row) + 0.5), static_cast<std::size_t>(grid_.columns)},
        straight);
}

void SceneRows::write(std::size_t row, const RowView& straight, float* irradiance) const {
  const auto columns = static_cast<std::size_t>(grid_.columns);
  thread_local RowView turned_view;
  const bool turns = !panorama_ && !aimed_.is_straight();
  if (turns) aimed_.turn(straight, turned_view);
  const RowView& cells = turns ? turned_view : straight;
  thread_local DrawnCells::Row drawn;
  if (drawn_) drawn_->cover(row, drawn);
  constexpr std::size_t stretch = 64;
  for (std::size_t from = 0; from < columns; from += stretch) {
    const std::size_t to = std::min(columns, from + stretch);
    if (drawn_)
      write_drawing(row, cells, drawn, from, to, irradiance);
    else
      write_samples(row, cells, radiance_, from, to, irradiance);
  }
}

CellPlane ideal_irradiance(const Scene& scene, int band, const SceneMap& map, const SensorGeometry& grid,
                           int parts, Surround surround) {
  CellPlane plane = CellPlane::unset(grid);
  const SceneRows rows(scene, band, map, grid, parts, surround);
  parallel_for(plane.rows(), [&](std::size_t row) { rows.write(row, plane.row(row)); });
  return plane;
}

}  // namespace petzval
