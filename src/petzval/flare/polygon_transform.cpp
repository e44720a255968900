// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/flare/polygon_transform.h>

#include <cmath>

namespace petzval {

double polygon_area(std::span<const std::array<double, 2>> corners) {
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto& [x0, y0] = corners[i];
    const auto& [x1, y1] = corners[(i + 1) % corners.size()];
    twice += x0 * y1 - x1 * y0;
  }
  return twice / 2;
}

std::complex<double> polygon_transform(std::span<const std::array<double, 2>> corners,
                                       std::array<double, 2> q) {
  const double square = q[0] * q[0] + q[1] * q[1];
  const double area = polygon_area(corners);
  constexpr double nothing = 1e-10;  // phases below 1e-5: the area to 1e-10
  if (square * std::abs(area) < nothing) return area;
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto& [x0, y0] = corners[i];
    const auto& [x1, y1] = corners[(i + 1) % corners.size()];
    const double across = q[0] * (y1 - y0) - q[1] * (x1 - x0);
    const double half = 0.5 * (q[0] * (x1 - x0) + q[1] * (y1 - y0));
    const double sinc = std::abs(half) < 1e-6 ? 1 : std::sin(half) / half;
    const double phase = 0.5 * (q[0] * (x0 + x1) + q[1] * (y0 + y1));
    sum += across * sinc * std::polar(1.0, phase);
  }
  return sum / (std::complex<double>(0, 1) * square);
}

}  // namespace petzval
