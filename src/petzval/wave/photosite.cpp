// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/bessel.h>
#include <petzval/wave/photosite.h>

#include <cmath>

namespace petzval {

namespace {

using Complex = std::complex<double>;

double area_of(const std::vector<std::pair<double, double>>& v) {
  double sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto& [ax, ay] = v[i];
    const auto& [bx, by] = v[(i + 1) % v.size()];
    sum += 0.5 * (ax * by - bx * ay);
  }
  return sum;
}

/// ∬ exp(−2πi f·x) over the polygon: Gauss' theorem, edge by edge, each in closed form.
Complex polygon_transform(const std::vector<std::pair<double, double>>& v, double fx, double fy) {
  const double f2 = fx * fx + fy * fy;
  Complex sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto& [ax, ay] = v[i];
    const auto& [bx, by] = v[(i + 1) % v.size()];
    const double dx = bx - ax, dy = by - ay;
    const double flux = fx * dy - fy * dx;  // f · n ds, n outward where the area is positive
    sum += flux * sinc(fx * dx + fy * dy) * std::polar(1.0, -pi * (fx * (ax + bx) + fy * (ay + by)));
  }
  return Complex(0, 1) / (2 * pi * f2) * sum;
}

}  // namespace

double sinc(double x) {
  const double phase = pi * x;
  return std::abs(phase) < 1e-8 ? 1 : std::sin(phase) / phase;
}

Photosite Photosite::square(double fill_factor) {
  if (!(fill_factor > 0 && fill_factor <= 1))
    throw InputError(fmt::format("a fill factor of {}: above 0 and up to 1 is right", fill_factor));
  Photosite site;
  site.width = site.height = std::sqrt(fill_factor);
  return site;
}

bool Photosite::is_plain() const {
  return shape == Shape::rectangle && width == 1 && height == 1 && separation_x == 0 && separation_y == 0;
}

std::string Photosite::text() const {
  if (is_plain()) return "box";
  std::string text;
  if (shape == Shape::none) {
    text = "point";
  } else if (shape == Shape::polygon) {
    text = "polygon";
    for (const auto& [x, y] : vertices) text += fmt::format(" {:g},{:g}", x, y);
    text += " pitches";
  } else {
    text = fmt::format("{} {:g} x {:g} pitches", shape == Shape::ellipse ? "ellipse" : "rectangle", width,
                       height);
  }
  if (separation_x != 0 || separation_y != 0)
    text += fmt::format(", low-pass {:g} x {:g} pitches", separation_x, separation_y);
  return text;
}

void Photosite::validate() const {
  constexpr double largest = 100;
  if (shape == Shape::rectangle || shape == Shape::ellipse) {
    if (!(width > 0 && height > 0 && width <= largest && height <= largest))
      throw InputError(fmt::format("a photosite of {} x {} pixels: above 0 and up to {} is right", width,
                                   height, largest));
  }
  if (shape == Shape::polygon) {
    if (vertices.size() < 3) throw InputError("a photosite polygon needs at least three vertices");
    for (const auto& [x, y] : vertices)
      if (!(std::abs(x) <= largest && std::abs(y) <= largest))
        throw InputError(
            fmt::format("a photosite vertex at ({}, {}): within {} pixels is right", x, y, largest));
    if (!(std::abs(area_of(vertices)) > 1e-9)) throw InputError("a photosite polygon without area");
  }
  for (const double separation : {separation_x, separation_y})
    if (!(std::abs(separation) <= largest))
      throw InputError(
          fmt::format("a low-pass separation of {} pixels: up to {} is right", separation, largest));
}

Complex Photosite::transform(double fx_cpp, double fy_cpp) const {
  const double dots = std::cos(pi * separation_x * fx_cpp) * std::cos(pi * separation_y * fy_cpp);
  switch (shape) {
    case Shape::none:
      return dots;
    case Shape::rectangle:
      return dots * sinc(width * fx_cpp) * sinc(height * fy_cpp);
    case Shape::ellipse:
      return dots * jinc(pi * std::hypot(width * fx_cpp, height * fy_cpp));
    case Shape::polygon:
      // Closer to zero the quotient loses digits, and the transform is 1 to rounding but for a shift.
      if (std::hypot(fx_cpp, fy_cpp) < 1e-7) return dots;
      return dots * polygon_transform(vertices, fx_cpp, fy_cpp) / area_of(vertices);
  }
  return dots;
}

}  // namespace petzval
