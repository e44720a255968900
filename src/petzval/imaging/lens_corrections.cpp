// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/imaging/lens_corrections.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// A field of the table on a straight picture, and where its light falls, in units of the frame's corner.
struct FieldPoint {
  double straight = 0, real = 0, light = 0;
};

std::size_t nearest_wavelength(const LensDataTable& table) {
  const double wanted = table.first_order.wavelength_nm;
  if (!std::isfinite(wanted)) return table.wavelengths_nm.size() / 2;
  const auto nearest =
      std::min_element(table.wavelengths_nm.begin(), table.wavelengths_nm.end(),
                       [&](double a, double b) { return std::abs(a - wanted) < std::abs(b - wanted); });
  return static_cast<std::size_t>(nearest - table.wavelengths_nm.begin());
}

/// Fields up to a little beyond the corner; empty where the table has none to tell the middle by.
std::vector<FieldPoint> field_points(const LensDataTable& table, double corner_mm) {
  constexpr double steepest = 10;  // tangent: 84 degrees
  const std::size_t wavelength = nearest_wavelength(table);
  std::vector<FieldPoint> points;
  for (std::size_t i = 0; i < table.fields.size(); ++i) {
    if (!table.finite_object() && table.fields[i] >= 89) break;
    const std::size_t at = table.index(i, wavelength);
    const FieldPoint point{table.field_tangent(table.fields[i]), table.real_image_height_mm[at] / corner_mm,
                           table.g_sensor_sr[at]};
    if (point.straight > steepest) break;
    points.push_back(point);
    constexpr double beyond = 1.1;
    if (point.real > beyond) break;
  }
  constexpr std::size_t least = 7;
  if (points.size() < least || points.front().straight != 0 || !(points.front().light > 0)) return {};
  // The magnification of the middle, to the fourth order of the two innermost fields.
  const double a = points[1].straight, b = points[2].straight;
  const double at_a = points[1].real / a, at_b = points[2].real / b;
  const double middle = (at_a * b * b - at_b * a * a) / (b * b - a * a), light = points.front().light;
  for (FieldPoint& point : points) point.straight *= middle, point.light /= light;
  return points;
}

/// Coefficients of 1, r², r⁴, … through the points (r, value) by least squares, each weighted.
Eigen::VectorXd even_polynomial(const std::vector<Eigen::Vector3d>& points, int first, int last) {
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd powers(count, last - first + 1);
  Eigen::VectorXd values(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3d& point = points[static_cast<std::size_t>(i)];
    for (int k = first; k <= last; ++k) powers(i, k - first) = point(2) * std::pow(point(0), 2 * k);
    values(i) = point(2) * point(1);
  }
  return powers.colPivHouseholderQr().solve(values);
}

double even_value(const std::vector<double>& terms, double r) {
  double sum = 0;
  for (auto term = terms.rbegin(); term != terms.rend(); ++term) sum = sum * r * r + *term;
  return sum;
}

/// Points of the straight picture up to a little beyond its corner, with how they are met. Where more would
/// be needed than there is, the straight picture is shown so large that its corners are the frame's.
std::vector<FieldPoint> shown_points(const std::vector<FieldPoint>& points) {
  double scale = 1;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const FieldPoint &inner = points[i - 1], &outer = points[i];
    if (outer.real < 1 || outer.real <= inner.real) continue;
    const double share = (1 - inner.real) / (outer.real - inner.real);
    scale = std::max(1.0, 1 / (inner.straight + share * (outer.straight - inner.straight)));
    break;
  }
  std::vector<FieldPoint> shown;
  for (FieldPoint point : points) {
    point.straight *= scale;
    if (point.straight > 0 && point.straight <= 1.1) shown.push_back(point);
  }
  constexpr std::size_t least = 5;
  if (shown.size() < least || shown.back().straight < 1) return {};
  return shown;
}

/// Terms of real = Σ wᵢ t²ⁱ⁺¹ with t = variable(straight), or none where they miss a point by the tolerance.
template <typename Variable>
std::vector<double> warp_of(const std::vector<FieldPoint>& points, double tolerance,
                            const Variable& variable) {
  if (points.empty()) return {};
  std::vector<Eigen::Vector3d> samples;
  for (const FieldPoint& point : points) {
    const double t = variable(point.straight);
    samples.emplace_back(t, point.real / t, t);
  }
  constexpr int terms = 4;
  const Eigen::VectorXd fit = even_polynomial(samples, 0, terms - 1);
  const std::vector<double> warp(fit.begin(), fit.end());
  for (const FieldPoint& point : points) {
    const double t = variable(point.straight);
    if (point.straight <= 1 && std::abs(even_value(warp, t) * t - point.real) > tolerance) return {};
  }
  return warp;
}

std::vector<double> vignetting_of(const std::vector<FieldPoint>& points) {
  std::vector<Eigen::Vector3d> samples;
  for (const FieldPoint& point : points)
    if (point.real > 0 && point.real <= 1.1 && point.light > 0)
      samples.emplace_back(point.real, 1 / point.light - 1, point.light);
  constexpr int terms = 5;
  if (samples.size() < terms + 1 || samples.back()(0) < 1) return {};
  const Eigen::VectorXd fit = even_polynomial(samples, 1, terms);
  std::vector<double> one_and_terms{1};
  one_and_terms.insert(one_and_terms.end(), fit.begin(), fit.end());
  constexpr double tolerance = 0.01;
  for (const Eigen::Vector3d& sample : samples)
    if (sample(0) <= 1 && std::abs(even_value(one_and_terms, sample(0)) * sample(2) - 1) > tolerance)
      return {};
  return {fit.begin(), fit.end()};
}

constexpr double greatest_gain = 16;

/// Gains over a frame from light(x, y) [mm from the axis, in image space] over that of the middle.
template <typename Light>
GainMap gain_map_of(const SensorGeometry& frame, const Light& light) {
  constexpr int points = 65;  // along the longer side: bilinear in between to 1 % of the edge of a fisheye
  const int longest = std::max(frame.columns, frame.rows);
  const auto along = [&](int pixels) { return 2 + (points - 2) * pixels / longest; };
  GainMap map{along(frame.columns), along(frame.rows), {}};
  const double middle = light(0, 0), pitch_mm = frame.pitch_um * mm_per_um;
  if (!(middle > 0)) return {};
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const double x = (0.5 - static_cast<double>(column) / (map.columns - 1)) * frame.columns * pitch_mm;
      const double y = (static_cast<double>(row) / (map.rows - 1) - 0.5) * frame.rows * pitch_mm;
      map.gains.push_back(static_cast<float>(
          std::min(greatest_gain, middle / std::max(light(x, y), middle / greatest_gain))));
    }
  return map;
}

/// Where x lies among increasing numbers: the place before it, and the share of the way to the next.
std::pair<std::size_t, double> between(const std::vector<double>& numbers, double x) {
  const auto after = std::upper_bound(numbers.begin() + 1, numbers.end() - 1, x);
  const auto i = static_cast<std::size_t>(after - numbers.begin() - 1);
  return {i, std::clamp((x - numbers[i]) / (numbers[i + 1] - numbers[i]), 0.0, 1.0)};
}

GainMap gain_map_by_height(const LensDataTable& table, const SensorGeometry& frame) {
  const std::size_t wavelength = nearest_wavelength(table);
  std::vector<double> heights, light;
  for (std::size_t i = 0; i < table.fields.size(); ++i) {
    heights.push_back(table.real_image_height_mm[table.index(i, wavelength)]);
    light.push_back(table.g_sensor_sr[table.index(i, wavelength)]);
  }
  if (heights.size() < 2 || heights.back() < frame.half_diagonal_mm()) return {};
  return gain_map_of(frame, [&](double x, double y) {
    const auto [i, share] = between(heights, std::hypot(x, y));
    return std::lerp(light[i], light[i + 1], share);
  });
}

GainMap gain_map_by_place(const LensDataTable& table, const SensorGeometry& frame) {
  const std::size_t wavelength = nearest_wavelength(table);
  const FramePlaces& places = *table.frame;
  const auto at = [&](std::size_t column, std::size_t row) {
    return table.g_sensor_sr[table.index(places.place(column, row), wavelength)];
  };
  return gain_map_of(frame, [&](double x, double y) {
    const auto [i, right] = between(places.x_mm, x);
    const auto [j, down] = between(places.y_mm, y);
    return std::lerp(std::lerp(at(i, j), at(i + 1, j), right),
                     std::lerp(at(i, j + 1), at(i + 1, j + 1), right), down);
  });
}

}  // namespace

void add_corrections(LensFacts& facts, const LensDataTable& table, const SensorGeometry& frame) {
  if (table.frame) {
    facts.gain_map = gain_map_by_place(table, frame);
    return;
  }
  const double corner_mm = frame.half_diagonal_mm();
  const std::vector<FieldPoint> points = field_points(table, corner_mm);
  if (points.empty()) return;
  constexpr double pixels = 0.2;
  const double tolerance = pixels * frame.pitch_um * mm_per_um / corner_mm;
  const std::vector<FieldPoint> shown = shown_points(points);
  facts.warp = warp_of(shown, tolerance, [](double r) { return r; });
  if (facts.warp.empty())
    facts.fisheye_warp = warp_of(shown, tolerance, [](double r) { return std::atan(r); });
  facts.vignetting = vignetting_of(points);
  if (facts.vignetting.empty()) facts.gain_map = gain_map_by_height(table, frame);
}

}  // namespace petzval
