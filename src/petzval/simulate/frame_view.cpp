// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_values.h>
#include <petzval/base/error.h>
#include <petzval/simulate/frame_view.h>

#include <cmath>
#include <limits>

namespace petzval {

FrameView frame_view(const Lens& lens, const SensorGeometry& frame) {
  const auto across = [&](double half_mm) {
    try {
      return 2 * std::abs(object_field(lens, Fields::Kind::real_image_height_mm, half_mm));
    } catch (const InputError&) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  };
  return {!lens.object_distance_mm, across(frame.width_mm() / 2), across(frame.height_mm() / 2),
          across(frame.half_diagonal_mm())};
}

}  // namespace petzval
