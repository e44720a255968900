// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/focus/focus_measure.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

void check(const GreyPicture& picture) {
  if (picture.columns < 0 || picture.rows < 0 ||
      picture.values.size() !=
          static_cast<std::size_t>(picture.columns) * static_cast<std::size_t>(picture.rows))
    throw InputError(fmt::format("a picture of {} x {} pixels with {} values", picture.columns, picture.rows,
                                 picture.values.size()));
}

/// The mean of `term` over all pixels at least `border` away from the rim.
template <class Term>
double mean_inside(const GreyPicture& picture, int border, Term&& term) {
  double sum = 0;
  const int columns = picture.columns - 2 * border, rows = picture.rows - 2 * border;
  if (columns < 1 || rows < 1) return 0;
  for (int row = border; row < picture.rows - border; ++row)
    for (int column = border; column < picture.columns - border; ++column) sum += term(column, row);
  return sum / (static_cast<double>(columns) * rows);
}

double modified_laplacian(const GreyPicture& p, int column, int row, int step) {
  const double centre = 2 * p.at(column, row);
  return std::abs(centre - p.at(column - step, row) - p.at(column + step, row)) +
         std::abs(centre - p.at(column, row - step) - p.at(column, row + step));
}

double sobel_x(const GreyPicture& p, int c, int r, int s) {
  return (p.at(c + s, r - s) - p.at(c - s, r - s) + 2 * (p.at(c + s, r) - p.at(c - s, r)) +
          p.at(c + s, r + s) - p.at(c - s, r + s)) /
         8;
}

double sobel_y(const GreyPicture& p, int c, int r, int s) {
  return (p.at(c - s, r + s) - p.at(c - s, r - s) + 2 * (p.at(c, r + s) - p.at(c, r - s)) +
          p.at(c + s, r + s) - p.at(c + s, r - s)) /
         8;
}

/// The Laplacian of what a 1 2 1 filter in both directions leaves of the noise.
double smooth_laplacian(const GreyPicture& p, int c, int r, int s) {
  static constexpr double weight[3] = {0.25, 0.5, 0.25};
  const auto smoothed = [&](int column, int row) {
    double sum = 0;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) sum += weight[i + 1] * weight[j + 1] * p.at(column + i * s, row + j * s);
    return sum;
  };
  return smoothed(c - s, r) + smoothed(c + s, r) + smoothed(c, r - s) + smoothed(c, r + s) -
         4 * smoothed(c, r);
}

GreyPicture mean_of(const ZonePicture& picture) {
  GreyPicture mean = picture.first;
  if (picture.second)
    for (std::size_t i = 0; i < mean.values.size(); ++i)
      mean.values[i] = (mean.values[i] + picture.second->values[i]) / 2;
  return mean;
}

/// Columns and rows from and to, the latter excluded.
GreyPicture part_of(const GreyPicture& picture, int left, int right, int top, int bottom) {
  GreyPicture part{right - left, bottom - top, {}};
  for (int row = top; row < bottom; ++row)
    for (int column = left; column < right; ++column) part.values.push_back(picture.at(column, row));
  return part;
}

}  // namespace

GreyPicture binned(const GreyPicture& picture, int k) {
  check(picture);
  k = std::clamp(k, 1, std::max(1, std::min(picture.columns, picture.rows) / 8));
  if (k == 1) return picture;
  GreyPicture result{picture.columns / k, picture.rows / k, {}};
  for (int row = 0; row < result.rows; ++row)
    for (int column = 0; column < result.columns; ++column) {
      double sum = 0;
      for (int i = 0; i < k; ++i)
        for (int j = 0; j < k; ++j) sum += picture.at(k * column + j, k * row + i);
      result.values.push_back(sum / (k * k));
    }
  return result;
}

ZonePicture binned(const ZonePicture& picture, int k) {
  ZonePicture result{binned(picture.first, k), {}};
  if (picture.second) result.second = binned(*picture.second, k);
  return result;
}

FocusMeasure focus_measure_of(const std::string& name) {
  for (const FocusMeasure each :
       {FocusMeasure::sum_modified_laplacian, FocusMeasure::gradient_energy, FocusMeasure::laplacian_energy})
    if (name == to_string(each)) return each;
  throw InputError(
      fmt::format("there is no focus measure \"{}\"; sml, gradient or laplacian would be right", name));
}

const char* to_string(FocusMeasure measure) {
  if (measure == FocusMeasure::sum_modified_laplacian) return "sml";
  return measure == FocusMeasure::gradient_energy ? "gradient" : "laplacian";
}

double focus_measure(const ZonePicture& picture, const FocusMeasureOptions& options) {
  check(picture.first);
  if (picture.second) {
    check(*picture.second);
    if (picture.second->columns != picture.first.columns || picture.second->rows != picture.first.rows)
      throw InputError("the two pictures of a zone are of different sizes");
  }
  if (options.step < 1) throw InputError("the step of a focus measure is at least one pixel");
  const int step = options.step;
  if (options.measure == FocusMeasure::sum_modified_laplacian) {
    const GreyPicture mean = mean_of(picture);
    return mean_inside(mean, step, [&](int column, int row) {
      const double value = modified_laplacian(mean, column, row, step);
      return value >= options.threshold ? value : 0;
    });
  }
  const GreyPicture& a = picture.first;
  const GreyPicture& b = picture.second ? *picture.second : picture.first;
  const bool gradient = options.measure == FocusMeasure::gradient_energy;
  const double mean = mean_inside(a, gradient ? step : 2 * step, [&](int c, int r) {
    if (gradient)
      return sobel_x(a, c, r, step) * sobel_x(b, c, r, step) +
             sobel_y(a, c, r, step) * sobel_y(b, c, r, step);
    return smooth_laplacian(a, c, r, step) * smooth_laplacian(b, c, r, step);
  });
  return std::max(mean, 0.0);
}

double focus_measure_noise(const ZonePicture& picture, const FocusMeasureOptions& options) {
  constexpr int most_parts = 4, pixels_a_part = 8;  // a side
  const GreyPicture& a = picture.first;
  if (!picture.second) return 0;
  const int parts =
      std::clamp(std::min(a.columns, a.rows) / (pixels_a_part * std::max(1, options.step)), 1, most_parts);
  double sum = 0;
  for (int i = 0; i < parts; ++i)
    for (int j = 0; j < parts; ++j) {
      const auto alone = [&](const GreyPicture& whole) {
        return focus_measure({part_of(whole, i * a.columns / parts, (i + 1) * a.columns / parts,
                                      j * a.rows / parts, (j + 1) * a.rows / parts),
                              {}},
                             options);
      };
      const double difference = (alone(a) - alone(*picture.second)) / 2;
      sum += difference * difference;
    }
  return std::sqrt(sum) / (parts * parts);
}

}  // namespace petzval
