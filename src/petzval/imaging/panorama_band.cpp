// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/panorama_band.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace petzval {

namespace {

/// Means over `width` samples about each sample of a closed row, parts of samples by their share.
void widen(std::span<const float> row, double width, std::span<float> out) {
  const std::size_t count = row.size();
  std::vector<double> sums(count + 1, 0.0);  // of the samples before
  for (std::size_t i = 0; i < count; ++i) sums[i + 1] = sums[i] + static_cast<double>(row[i]);
  const auto integral = [&](double to) {
    const double turns = std::floor(to / static_cast<double>(count));
    const double within = to - turns * static_cast<double>(count);
    const std::size_t whole = std::min(static_cast<std::size_t>(within), count - 1);
    return turns * sums[count] + sums[whole] +
           (within - static_cast<double>(whole)) * static_cast<double>(row[whole]);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const double middle = static_cast<double>(i) + 0.5;
    out[i] = static_cast<float>((integral(middle + width / 2) - integral(middle - width / 2)) / width);
  }
}

}  // namespace

PanoramaBand::PanoramaBand(const Scene& panorama, int band, PanoramaView view)
    : columns_(panorama.columns()),
      rows_(panorama.rows()),
      angle_per_sample_(2 * std::numbers::pi / panorama.columns()),
      cos_yaw_(std::cos(radians(view.yaw_deg))),
      sin_yaw_(std::sin(radians(view.yaw_deg))),
      cos_pitch_(std::cos(radians(view.pitch_deg))),
      sin_pitch_(std::sin(radians(view.pitch_deg))) {
  const auto values = std::make_shared<std::vector<float>>(panorama.band_size());
  const auto width = static_cast<std::size_t>(columns_);
  const std::span<const float> stored = panorama.band(band);
  parallel_for(static_cast<std::size_t>(rows_), [&](std::size_t row) {
    // The sine of the angle from the pole is the cosine of the latitude.
    const double circle = std::sin((static_cast<double>(row) + 0.5) * angle_per_sample_);
    widen(stored.subspan(row * width, width), std::min(1 / circle, static_cast<double>(width)),
          std::span(*values).subspan(row * width, width));
  });
  values_ = values;
}

PanoramaBand::PanoramaBand(const PanoramaBand& other, PanoramaView view) : PanoramaBand(other) {
  cos_yaw_ = std::cos(radians(view.yaw_deg));
  sin_yaw_ = std::sin(radians(view.yaw_deg));
  cos_pitch_ = std::cos(radians(view.pitch_deg));
  sin_pitch_ = std::sin(radians(view.pitch_deg));
}

double PanoramaBand::sample(std::ptrdiff_t row, double column) const {
  // Beyond a pole lies the same row, half a turn on.
  if (row < 0 || row >= rows_) {
    row = row < 0 ? -1 - row : 2 * rows_ - 1 - row;
    column += static_cast<double>(columns_) / 2;
  }
  const double left = std::floor(column);
  const auto j = ((static_cast<std::ptrdiff_t>(left) % columns_) + columns_) % columns_;
  const float* const values = values_->data() + row * columns_;
  const double here = values[j], next = values[j + 1 < columns_ ? j + 1 : 0];
  return here + (column - left) * (next - here);
}

double PanoramaBand::radiance(double right, double down) const {
  // The direction as the camera has it: x to the right, y up, z ahead.
  const double radius = std::hypot(right, down), angle = radius * angle_per_sample_;
  const double sine = radius > 0 ? std::sin(angle) / radius : 0;
  const double x = sine * right, y = -sine * down, z = std::cos(angle);
  // The same in the panorama: the camera was first tilted up, then turned to the right.
  const double up = y * cos_pitch_ + z * sin_pitch_, ahead = z * cos_pitch_ - y * sin_pitch_;
  const double aside = x * cos_yaw_ + ahead * sin_yaw_, front = ahead * cos_yaw_ - x * sin_yaw_;
  const double longitude = std::atan2(aside, front), from_zenith = std::atan2(std::hypot(aside, front), up);
  const double column = static_cast<double>(columns_) / 2 + longitude / angle_per_sample_ - 0.5;
  const double row = from_zenith / angle_per_sample_ - 0.5;
  const double above = std::floor(row);
  const auto i = static_cast<std::ptrdiff_t>(above);
  const double upper = sample(i, column), lower = sample(i + 1, column);
  return upper + (row - above) * (lower - upper);
}

}  // namespace petzval
