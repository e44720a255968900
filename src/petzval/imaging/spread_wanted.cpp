// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/spread_wanted.h>

#include <algorithm>
#include <cmath>

namespace petzval {

bool SpreadWanted::of_a_preview() const {
  return tolerance >= ImagingOptions::of_a_preview;
}

double contrast_of_noise(double contrast) {
  constexpr double covered = 2.5;
  return contrast > covered ? contrast : 1;
}

double kernel_difference(const Kernel& few, const Kernel& more, double contrast) {
  const int radius = std::max(few.radius, more.radius);
  const auto weight = [](const Kernel& kernel, int row, int column) {
    const bool inside = std::abs(row) <= kernel.radius && std::abs(column) <= kernel.radius;
    return inside ? kernel.at(row, column) : 0.0;
  };
  double squares = 0, light = 0;
  for (int row = -radius; row <= radius; ++row)
    for (int column = -radius; column <= radius; ++column) {
      const double here = weight(more, row, column);
      squares += std::pow(weight(few, row, column) - here, 2);
      light += here * here;
    }
  return std::sqrt(squares / (1 / (contrast * contrast) + light));
}

}  // namespace petzval
