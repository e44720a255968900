// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/units.h>
#include <petzval/lens/aperture_figure.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace petzval {

double ApertureFigure::reach_sq(double x_mm, double y_mm) const {
  const double turn = radians(rotation_deg), c = std::cos(turn), s = std::sin(turn);
  const double dx = x_mm - decentre_x_mm, dy = y_mm - decentre_y_mm;
  const double x = (c * dx + s * dy) / half_width_x_mm, y = (c * dy - s * dx) / half_width_y_mm;
  return kind == Kind::rectangle ? std::max(x * x, y * y) : x * x + y * y;
}

double ApertureFigure::share_sq(double x_mm, double y_mm) const {
  const double reach = reach_sq(x_mm, y_mm);
  if (!obscures) return reach;
  return reach > 0 ? 1 / reach : std::numeric_limits<double>::max();
}

bool ApertureFigure::is_round() const {
  return kind == Kind::ellipse && half_width_x_mm == half_width_y_mm && decentre_x_mm == 0 &&
         decentre_y_mm == 0;
}

ApertureFigure ApertureFigure::turned(double angle) const {
  const double c = std::cos(angle), s = std::sin(angle);
  ApertureFigure result = *this;
  result.decentre_x_mm = c * decentre_x_mm - s * decentre_y_mm;
  result.decentre_y_mm = s * decentre_x_mm + c * decentre_y_mm;
  result.rotation_deg += degrees(angle);
  return result;
}

ApertureFigure ApertureFigure::mirrored() const {
  ApertureFigure result = *this;
  result.decentre_x_mm = -decentre_x_mm;
  result.rotation_deg = -rotation_deg;
  return result;
}

double ApertureFigure::farthest_mm() const {
  const double own = kind == Kind::rectangle ? std::hypot(half_width_x_mm, half_width_y_mm)
                                             : std::max(half_width_x_mm, half_width_y_mm);
  return own + std::hypot(decentre_x_mm, decentre_y_mm);
}

std::string aperture_figure_fault(const ApertureFigure& shape) {
  for (const auto& [name, value] : {std::pair{"half_width_x_mm", shape.half_width_x_mm},
                                    std::pair{"half_width_y_mm", shape.half_width_y_mm}})
    if (!(std::isfinite(value) && value > 0)) return fmt::format("{} must be positive, in mm", name);
  for (const auto& [name, value] :
       {std::pair{"decentre_x_mm", shape.decentre_x_mm}, std::pair{"decentre_y_mm", shape.decentre_y_mm},
        std::pair{"rotation_deg", shape.rotation_deg}})
    if (!std::isfinite(value)) return fmt::format("{} must be a finite number", name);
  return "";
}

}  // namespace petzval
