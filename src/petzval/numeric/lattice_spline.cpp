// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/numeric/interpolation.h>
#include <petzval/numeric/lattice_spline.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

void require_lattice_axis(const std::vector<double>& axis, const char* name) {
  if (axis.size() < 2)
    throw InputError(
        fmt::format("a lattice with {} places along {}: two or more are right", axis.size(), name));
  for (std::size_t i = 1; i < axis.size(); ++i)
    if (!(axis[i] > axis[i - 1]))
      throw InputError(
          fmt::format("places along {} must increase, but {} follows {}", name, axis[i], axis[i - 1]));
}

/// Hermite's cubic on an interval of this length, in powers from its start.
std::array<double, 4> hermite(double length, double from, double to, double slope_from, double slope_to) {
  const double secant = (to - from) / length;
  return {from, slope_from, (3 * secant - 2 * slope_from - slope_to) / length,
          (slope_from + slope_to - 2 * secant) / (length * length)};
}

}  // namespace

std::vector<double> spline_slopes(std::span<const double> x, std::span<const double> values) {
  const std::size_t n = x.size();
  const auto h = [&](std::size_t i) { return x[i + 1] - x[i]; };
  const auto secant = [&](std::size_t i) { return (values[i + 1] - values[i]) / h(i); };
  if (n == 1) return {0};
  if (n == 2) return {secant(0), secant(0)};
  if (n == 3) {
    const double bend = (secant(1) - secant(0)) / (x[2] - x[0]);
    return {secant(0) - bend * h(0), secant(0) + bend * h(0), secant(1) + bend * h(1)};
  }
  // Continuity of the second derivative within; at either end that of the third at the next knot.
  std::vector<double> below(n), diagonal(n), above(n), slopes(n);
  const double first = h(0) + h(1), last = h(n - 2) + h(n - 3);
  diagonal[0] = h(1);
  above[0] = first;
  slopes[0] = ((h(0) + 2 * first) * h(1) * secant(0) + h(0) * h(0) * secant(1)) / first;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    below[i] = h(i);
    diagonal[i] = 2 * (h(i - 1) + h(i));
    above[i] = h(i - 1);
    slopes[i] = 3 * (h(i) * secant(i - 1) + h(i - 1) * secant(i));
  }
  below[n - 1] = last;
  diagonal[n - 1] = h(n - 3);
  slopes[n - 1] =
      ((h(n - 2) + 2 * last) * h(n - 3) * secant(n - 2) + h(n - 2) * h(n - 2) * secant(n - 3)) / last;
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = below[i] / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    slopes[i] -= factor * slopes[i - 1];
  }
  slopes[n - 1] /= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) slopes[i] = (slopes[i] - above[i] * slopes[i + 1]) / diagonal[i];
  return slopes;
}

LatticeSpline::LatticeSpline(std::vector<double> x, std::vector<double> y, std::vector<double> values)
    : x_(std::move(x)), y_(std::move(y)), values_(std::move(values)) {
  require_lattice_axis(x_, "x");
  require_lattice_axis(y_, "y");
  const std::size_t across = x_.size(), down = y_.size();
  if (values_.size() != across * down)
    throw InputError(fmt::format("{} values for a lattice of {} × {}", values_.size(), across, down));
  const auto along_x = [&](const std::vector<double>& of) {
    std::vector<double> slopes;
    for (std::size_t j = 0; j < down; ++j)
      for (const double slope : spline_slopes(x_, std::span(of).subspan(j * across, across)))
        slopes.push_back(slope);
    return slopes;
  };
  const auto along_y = [&](const std::vector<double>& of) {
    std::vector<double> slopes(of.size()), column(down);
    for (std::size_t i = 0; i < across; ++i) {
      for (std::size_t j = 0; j < down; ++j) column[j] = of[j * across + i];
      const std::vector<double> of_column = spline_slopes(y_, column);
      for (std::size_t j = 0; j < down; ++j) slopes[j * across + i] = of_column[j];
    }
    return slopes;
  };
  const std::vector<double> fx = along_x(values_), fy = along_y(values_), fxy = along_y(fx);
  patches_.resize((across - 1) * (down - 1));
  for (std::size_t j = 0; j + 1 < down; ++j)
    for (std::size_t i = 0; i + 1 < across; ++i) {
      const std::size_t a = j * across + i, b = a + across;  // corners at the start of x
      const double width = x_[i + 1] - x_[i], height = y_[j + 1] - y_[j];
      // Rows of cubics in x for values and slopes along y at both ends of y, then cubics in y of each power.
      const auto line = [&](const std::vector<double>& f, const std::vector<double>& slope, std::size_t at) {
        return hermite(width, f[at], f[at + 1], slope[at], slope[at + 1]);
      };
      const std::array<double, 4> from = line(values_, fx, a), to = line(values_, fx, b),
                                  slope_from = line(fy, fxy, a), slope_to = line(fy, fxy, b);
      Patch& patch = patches_[patch_index(i, j)];
      for (std::size_t power = 0; power < 4; ++power) {
        const auto of_y = hermite(height, from[power], to[power], slope_from[power], slope_to[power]);
        for (std::size_t k = 0; k < 4; ++k) patch[k][power] = of_y[k];
      }
    }
}

void LatticeSpline::flatten(std::size_t i, std::size_t j) {
  const std::size_t a = j * x_.size() + i, b = a + x_.size();
  const double width = x_[i + 1] - x_[i], height = y_[j + 1] - y_[j];
  Patch patch{};
  patch[0][0] = values_[a];
  patch[0][1] = (values_[a + 1] - values_[a]) / width;
  patch[1][0] = (values_[b] - values_[a]) / height;
  patch[1][1] = ((values_[b + 1] - values_[b]) / width - patch[0][1]) / height;
  patches_[patch_index(i, j)] = patch;
}

LatticeSpline::Tangent LatticeSpline::at(double x, double y) const {
  const double inside_x = std::clamp(x, x_.front(), x_.back()),
               inside_y = std::clamp(y, y_.front(), y_.back());
  const std::size_t i = bracket(x_, inside_x), j = bracket(y_, inside_y);
  const Patch& patch = patches_[patch_index(i, j)];
  const double u = inside_x - x_[i], v = inside_y - y_[j];
  Tangent tangent{};
  double power = 1, slope_power = 0;  // v^k and its derivative
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& c = patch[k];
    const double value = c[0] + u * (c[1] + u * (c[2] + u * c[3]));
    tangent.value += power * value;
    tangent.along_x += power * (c[1] + u * (2 * c[2] + u * 3 * c[3]));
    tangent.along_y += slope_power * value;
    slope_power = power * double(k + 1);
    power *= v;
  }
  tangent.value += (x - inside_x) * tangent.along_x + (y - inside_y) * tangent.along_y;
  return tangent;
}

void LatticeSpline::row(double y, std::vector<CubicStretch>& values,
                        std::vector<CubicStretch>& along_y) const {
  const double inside_y = std::clamp(y, y_.front(), y_.back()), beyond = y - inside_y;
  const std::size_t j = bracket(y_, inside_y);
  const double v = inside_y - y_[j];
  values.resize(x_.size() - 1);
  along_y.resize(x_.size() - 1);
  for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
    const Patch& patch = patches_[patch_index(i, j)];
    CubicStretch value{x_[i], {}}, slope{x_[i], {}};
    for (std::size_t power = 0; power < 4; ++power) {
      slope.coefficients[power] = patch[1][power] + v * (2 * patch[2][power] + v * 3 * patch[3][power]);
      value.coefficients[power] = patch[0][power] +
                                  v * (patch[1][power] + v * (patch[2][power] + v * patch[3][power])) +
                                  beyond * slope.coefficients[power];
    }
    values[i] = value;
    along_y[i] = slope;
  }
}

}  // namespace petzval
