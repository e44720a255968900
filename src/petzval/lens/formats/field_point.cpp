// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/lens/formats/field_point.h>

#include <cmath>

namespace petzval {

double radial_field(double x, double y, bool is_angle) {
  if (x == 0) return y;
  if (!is_angle) return std::hypot(x, y);
  return degrees(std::atan(std::hypot(std::tan(radians(x)), std::tan(radians(y)))));
}

}  // namespace petzval
