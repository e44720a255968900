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

std::vector<double> warp_of(std::vector<FieldPoint> points, double tolerance) {
  // Where more would be needed than there is, the straight picture is shown so large that its corners are the
  // frame's.
  double scale = 1;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const FieldPoint &inner = points[i - 1], &outer = points[i];
    if (outer.real < 1 || outer.real <= inner.real) continue;
    const double share = (1 - inner.real) / (outer.real - inner.real);
    scale = std::max(1.0, 1 / (inner.straight + share * (outer.straight - inner.straight)));
    break;
  }
  std::vector<Eigen::Vector3d> samples;
  for (const FieldPoint& point : points) {
    const double r = scale * point.straight;
    if (r > 0 && r <= 1.1) samples.emplace_back(r, point.real / r, r);
  }
  constexpr std::size_t terms = 4;
  if (samples.size() < terms + 1 || samples.back()(0) < 1) return {};
  const Eigen::VectorXd fit = even_polynomial(samples, 0, terms - 1);
  std::vector<double> warp(fit.begin(), fit.end());
  for (const Eigen::Vector3d& sample : samples)
    if (sample(0) <= 1 && std::abs(even_value(warp, sample(0)) - sample(1)) * sample(0) > tolerance)
      return {};
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

}  // namespace

void add_corrections(LensFacts& facts, const LensDataTable& table, const SensorGeometry& frame) {
  const double corner_mm = frame.half_diagonal_mm();
  const std::vector<FieldPoint> points = field_points(table, corner_mm);
  if (points.empty()) return;
  constexpr double pixels = 0.2;
  facts.warp = warp_of(points, pixels * frame.pitch_um * mm_per_um / corner_mm);
  facts.vignetting = vignetting_of(points);
}

}  // namespace petzval
