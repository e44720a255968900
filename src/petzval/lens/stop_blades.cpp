// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/stop_blades.h>

#include <algorithm>
#include <cmath>

namespace petzval {

void StopBlades::validate() const {
  if (count != 0 && (count < 3 || count > most))
    throw InputError(
        fmt::format("a stop of {} blades; 3 to {}, or 0 for a round one, would be right", count, most));
  if (!std::isfinite(rotation_deg))
    throw InputError(fmt::format("blades turned by {} degrees; a number would be right", rotation_deg));
}

std::vector<std::array<double, 2>> StopBlades::normals() const {
  std::vector<std::array<double, 2>> result;
  for (int i = 0; i < count; ++i) {
    // Half way between corner i and the next one. From the film, x points right and y up.
    const double turn = radians(90 + rotation_deg) + 2 * pi * (i + 0.5) / count;
    result.push_back({std::cos(turn), std::sin(turn)});
  }
  return result;
}

double StopBlades::apothem() const {
  return count > 0 ? std::cos(pi / count) : 1;
}

double StopBlades::reach(double x, double y) const {
  double nearest = 1;
  for (const auto& [nx, ny] : normals())
    if (const double towards = nx * x + ny * y; towards > 0) nearest = std::min(nearest, apothem() / towards);
  return nearest;
}

double StopBlades::area_share() const {
  return count > 0 ? count / (2 * pi) * std::sin(2 * pi / count) : 1;
}

}  // namespace petzval
