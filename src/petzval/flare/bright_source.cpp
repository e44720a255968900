// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/bright_source.h>

#include <cmath>

namespace petzval {

void BrightSource::validate(std::size_t wavelengths) const {
  if (irradiance.size() != wavelengths)
    throw InputError(fmt::format("the source {} has light at {} wavelengths; {} would be right", name,
                                 irradiance.size(), wavelengths));
  if (!std::isfinite(right) || !std::isfinite(up))
    throw InputError(
        fmt::format("the source {} is at no finite angle; less than 90 degrees from the axis "
                    "would be right",
                    name));
  if (distance_mm && !(*distance_mm > 0 && std::isfinite(*distance_mm)))
    throw InputError(
        fmt::format("the source {} is {:g} mm away; more than 0 would be right", name, *distance_mm));
  if (!(radius_rad >= 0 && radius_rad < pi / 4))
    throw InputError(fmt::format("the source {} has a radius of {:g} degrees; 0 to 45 would be right", name,
                                 degrees(radius_rad)));
  for (const double light : irradiance)
    if (!(light >= 0 && std::isfinite(light)))
      throw InputError(
          fmt::format("the source {} has an irradiance of {:g}; 0 or more would be right", name, light));
}

}  // namespace petzval
