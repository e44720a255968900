// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/imaging/distortion.h>
#include <petzval/imaging/height_look.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace petzval {

HeightLook::HeightLook(const LightProfile& lens, std::optional<double> object_to_sensor_mm,
                       const Scene& scene, double largest_height_mm)
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
  for (std::size_t k = 0; k <= step_count; ++k)
    radii_.push_back(steps_[k].samples_per_mm * last_height_mm_ * std::sqrt(double(k) / double(step_count)));
  if (std::ranges::adjacent_find(radii_, std::greater_equal<>()) != radii_.end()) radii_.clear();
}

std::size_t HeightLook::step_before(double radius, double near_square) const {
  // The ratio of the place before gives a guess, which is mostly right to a few steps.
  const double ratio = steps_[static_cast<std::size_t>(near_square * steps_per_square_)].samples_per_mm;
  const double height_mm = radius / ratio;
  const double guess = std::min(height_mm * height_mm, last_height_squared_) * steps_per_square_;
  auto k = std::min(static_cast<std::size_t>(guess), radii_.size() - 2);
  while (radii_[k] > radius) --k;
  while (radii_[k + 1] <= radius) ++k;
  return k;
}

std::optional<ImagePlace> HeightLook::image_of(double column, double row, ImagePlace near) const {
  if (radii_.empty()) return std::nullopt;
  const double right = column - middle_column_, down = row - middle_row_;
  const double radius = std::sqrt(right * right + down * down);
  if (radius == 0) return ImagePlace{};
  double height_mm = radius / steps_.back().samples_per_mm;  // beyond the last height, as at it
  if (radius < radii_.back()) {
    const double near_square = near.x_mm * near.x_mm + near.y_mm * near.y_mm;
    const std::size_t k = step_before(radius, std::min(near_square, last_height_squared_));
    const double from = double(k) / steps_per_square_, to = double(k + 1) / steps_per_square_;
    // ρ = ratio(r'²) r', by Newton's method from the straight line between the steps.
    height_mm = std::lerp(std::sqrt(from), std::sqrt(to), (radius - radii_[k]) / (radii_[k + 1] - radii_[k]));
    constexpr int rounds = 2;  // a step is 1/4096 of the field's area: the line is good to 1e-7
    for (int round = 0; round < rounds; ++round) {
      const double further = height_mm * height_mm - from;
      const double ratio = steps_[k].samples_per_mm + further * steps_[k].samples_slope;
      const double slope = ratio + 2 * height_mm * height_mm * steps_[k].samples_slope;
      height_mm -= (ratio * height_mm - radius) / slope;
    }
  }
  return ImagePlace{-right / radius * height_mm, down / radius * height_mm};
}

HeightLook::Surroundings HeightLook::around(double x_mm, double y_mm) const {
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

void HeightLook::cut(double x_mm, double y_mm, double pitch_mm, int most,
                     std::vector<ScenePart>& parts) const {
  const Surroundings near = around(x_mm, y_mm);
  constexpr double rounding = 1e-6;
  const double samples = near.finest_samples_per_mm() * pitch_mm;
  const int count = static_cast<int>(std::clamp(std::ceil(samples - rounding), 1.0, double(most)));
  const double part_mm = pitch_mm / count;
  parts.clear();
  const bool wholly_dark = std::hypot(x_mm, y_mm) > last_height_mm_ + pitch_mm;
  if (wholly_dark) return parts.push_back({near.place(x_mm, y_mm), 0, 0});
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const double x = x_mm + (j - (count - 1) / 2.0) * part_mm, y = y_mm + (i - (count - 1) / 2.0) * part_mm;
      const auto side = [&](double at_mm) { return std::abs(near.samples_per_mm_along(at_mm)) * part_mm; };
      parts.push_back({near.place(x, y), side(x), side(y)});
    }
}

SeenExtent HeightLook::extent(const SensorGeometry& grid) const {
  // ρ grows with r', so the outline of the grid sees farthest; where it lies in the dark, the last bright
  // place on the way there. One quadrant is enough: the others are its mirror images.
  SeenExtent seen;
  const ScenePlace axis = this->place(0, 0);
  const auto look = [&](double x_mm, double y_mm) {
    const double shrink = std::min(1.0, last_height_mm_ / std::hypot(x_mm, y_mm));
    const ScenePlace place = this->place(shrink * x_mm, shrink * y_mm);
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

}  // namespace petzval
