// SPDX-License-Identifier: BSD-3-Clause
// What the numbers of a file say of a lens as a whole.
#pragma once

#include <petzval/base/units.h>
#include <petzval/optics/formats/ray_trace_data.h>

#include <cmath>
#include <string>
#include <vector>

namespace petzval {

/// What is known of it; the rest is NaN.
FirstOrder first_order_of(const RayTraceData& data, bool finite_object);

/// The object field [degrees or mm] of a paraxial image height. \param scale  height_scale().
inline double field_of_height(bool finite_object, double scale, double height_mm) {
  return finite_object ? height_mm / scale : degrees(std::atan(height_mm / scale));
}

/// Light of a uniform wall on the axis [sr]: what is given, else by the f-number. \param notes  get a line
/// then. \throws InputError without either.
double g_axis_sr(const RayTraceData& data, const RayTraceReading& reading, bool finite_object,
                 std::vector<std::string>& notes);

}  // namespace petzval
