// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/imaging/distortion.h>
#include <petzval/imaging/frame_light.h>
#include <petzval/imaging/frame_look.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// scene_radius(); of a plane at infinity, which a spline cannot follow to 90°, from here on straight.
double radius_for_spline(double field, std::optional<double> distance_mm, const Scene& scene) {
  constexpr double straight_deg = 85;
  if (scene.is_panorama() || distance_mm || field <= straight_deg)
    return scene_radius(field, distance_mm, scene);
  const double tangent = std::tan(radians(straight_deg));
  return (tangent + (1 + tangent * tangent) * radians(field - straight_deg)) / scene.tangent_per_sample();
}

}  // namespace

FrameLook::FrameLook(const LensDataTable& table, const LightCentres& centres, double wavelength_nm,
                     const Scene& scene)
    : middle_column_(scene.columns() / 2.0), middle_row_(scene.rows() / 2.0) {
  const FramePlaces& frame = *table.frame;
  const FrameLight light(table, centres, wavelength_nm);
  const std::optional<double> distance_mm = object_to_sensor_mm(table);
  std::vector<double> right, down;
  // About the axis a vector of fields tends to one of places.
  constexpr double small = 1e-6;
  for (std::size_t place = 0; place < frame.count(); ++place) {
    const double x = light.object_x[place], y = light.object_y[place];
    const double field = std::max(small, std::hypot(x, y));
    const double per_field = radius_for_spline(field, distance_mm, scene) / field;
    right.push_back(-per_field * x);  // columns run along −x'
    down.push_back(per_field * y);
  }
  right_ = LatticeSpline(frame.x_mm, frame.y_mm, std::move(right));
  down_ = LatticeSpline(frame.x_mm, frame.y_mm, std::move(down));
  g_source_sr_ = LatticeSpline(frame.x_mm, frame.y_mm, light.g_source_sr);
  flatten_about_darkness(light.dark, g_source_sr_);

  last_height_mm_ = INFINITY;
  for (std::size_t place = 0; place < frame.count(); ++place) {
    const double x = frame.x_mm[place % frame.x_mm.size()], y = frame.y_mm[place / frame.x_mm.size()];
    if (light.dark[place] != 0) last_height_mm_ = std::min(last_height_mm_, std::hypot(x, y));
  }
  constexpr int steps = 64;
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i) {
      const double x = std::lerp(frame.x_mm.front(), frame.x_mm.back(), double(i) / steps),
                   y = std::lerp(frame.y_mm.front(), frame.y_mm.back(), double(j) / steps);
      if (g_source_sr_(x, y) > 0)
        finest_samples_per_mm_ = std::max(finest_samples_per_mm_, samples_per_mm_at(x, y));
    }
}

ScenePlace FrameLook::place(double x_mm, double y_mm) const {
  return {middle_column_ + right_(x_mm, y_mm), middle_row_ + down_(x_mm, y_mm),
          std::max(0.0, g_source_sr_(x_mm, y_mm))};
}

std::optional<ImagePlace> FrameLook::image_of(double column, double row, ImagePlace near) const {
  constexpr int rounds = 30;
  constexpr double near_enough_samples = 1e-9;
  ImagePlace place = near;
  for (int round = 0; round < rounds; ++round) {
    const LatticeSpline::Tangent right = right_.at(place.x_mm, place.y_mm),
                                 down = down_.at(place.x_mm, place.y_mm);
    const double too_right = right.value - (column - middle_column_),
                 too_low = down.value - (row - middle_row_);
    if (std::hypot(too_right, too_low) <= near_enough_samples * (1 + std::hypot(column, row))) return place;
    const double determinant = right.along_x * down.along_y - right.along_y * down.along_x;
    place.x_mm -= (too_right * down.along_y - too_low * right.along_y) / determinant;
    place.y_mm -= (too_low * right.along_x - too_right * down.along_x) / determinant;
    if (!std::isfinite(place.x_mm) || !std::isfinite(place.y_mm)) return std::nullopt;
  }
  return std::nullopt;
}

double FrameLook::samples_per_mm_at(double x_mm, double y_mm) const {
  const LatticeSpline::Tangent right = right_.at(x_mm, y_mm), down = down_.at(x_mm, y_mm);
  return std::max(std::hypot(right.along_x, right.along_y), std::hypot(down.along_x, down.along_y));
}

void FrameLook::cut(double x_mm, double y_mm, double pitch_mm, int most,
                    std::vector<ScenePart>& parts) const {
  constexpr double rounding = 1e-6;
  const double samples = samples_per_mm_at(x_mm, y_mm) * pitch_mm;
  const int count = static_cast<int>(std::clamp(std::ceil(samples - rounding), 1.0, double(most)));
  const double part_mm = pitch_mm / count;
  parts.clear();
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const double x = x_mm + (j - (count - 1) / 2.0) * part_mm, y = y_mm + (i - (count - 1) / 2.0) * part_mm;
      const LatticeSpline::Tangent right = right_.at(x, y), down = down_.at(x, y);
      parts.push_back(
          {{middle_column_ + right.value, middle_row_ + down.value, std::max(0.0, g_source_sr_(x, y))},
           std::abs(right.along_x) * part_mm,
           std::abs(down.along_y) * part_mm});
    }
}

void FrameLook::look(const CellRow& cells, RowView& view) const {
  view.right.resize(cells.count);
  view.down.resize(cells.count);
  view.width.resize(cells.count);
  view.height.resize(cells.count);
  view.g_source_sr.resize(cells.count);
  view.dark = 0;
  thread_local std::vector<CubicStretch> right, down, light, down_along, unused;
  right_.row(cells.y_mm, right, unused);
  down_.row(cells.y_mm, down, down_along);
  g_source_sr_.row(cells.y_mm, light, unused);
  const std::vector<double>& x = right_.x();
  const double first_mm = (double(cells.count) / 2 - 0.5) * cells.pitch_mm;  // x' falls along the row
  std::size_t cell = 0;
  for (std::size_t i = x.size() - 1; i-- > 0;) {
    // Cells beyond the lattice belong to its last intervals; they are none but for rounding.
    const double from_mm = i == 0 ? -INFINITY : x[i];
    for (; cell < cells.count; ++cell) {
      const double at = first_mm - double(cell) * cells.pitch_mm;
      if (at < from_mm) break;
      view.right[cell] = right[i](at);
      view.down[cell] = down[i](at);
      view.g_source_sr[cell] = static_cast<float>(std::max(0.0, light[i](at)));
      view.width[cell] = static_cast<float>(std::abs(right[i].derivative(at)) * cells.pitch_mm);
      view.height[cell] = static_cast<float>(std::abs(down_along[i](at)) * cells.pitch_mm);
    }
  }
}

SeenExtent FrameLook::extent(const SensorGeometry& grid) const {
  SeenExtent seen;
  const auto look = [&](double column, double row) {
    const ScenePlace at = place(grid.x_mm(column), grid.y_mm(row));
    if (at.g_source_sr == 0) return;
    const double right = std::abs(at.column - middle_column_), down = std::abs(at.row - middle_row_);
    seen.columns = std::max(seen.columns, right);
    seen.rows = std::max(seen.rows, down);
    seen.radius = std::max(seen.radius, std::hypot(right, down));
  };
  for (int column = 0; column <= grid.columns; ++column) look(column, 0), look(column, grid.rows);
  for (int row = 0; row <= grid.rows; ++row) look(0, row), look(grid.columns, row);
  // Where the outline is dark, what is bright inside it.
  constexpr int steps = 64;
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i) look(double(grid.columns) * i / steps, double(grid.rows) * j / steps);
  return seen;
}

}  // namespace petzval
