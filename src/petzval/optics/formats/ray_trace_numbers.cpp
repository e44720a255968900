// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/optics/formats/ray_trace_numbers.h>
#include <petzval/optics/irradiance_formula.h>
#include <petzval/optics/table_layout.h>

#include <cmath>

namespace petzval {

FirstOrder first_order_of(const RayTraceData& data, bool finite_object) {
  FirstOrder first;
  table_layout::for_each_first_order(first,
                                     [](const char*, double& number) { number = RayTraceData::unknown; });
  first.wavelength_nm = data.reference_wavelength_nm;
  first.efl_mm = data.effective_focal_length_mm;
  first.f_number = data.f_number;
  first.working_f_number = data.effective_f_number;
  first.image_space_na = 0.5 / data.effective_f_number;
  first.field_of_view_deg = data.field_of_view_deg;
  first.magnification = finite_object ? data.magnification : 0;
  first.entrance_pupil.diameter_mm = std::abs(data.effective_focal_length_mm) / data.f_number;
  return first;
}

double g_axis_sr(const RayTraceData& data, const RayTraceReading& reading, bool finite_object,
                 std::vector<std::string>& notes) {
  if (reading.g_axis_sr) return *reading.g_axis_sr;
  const double n = data.f_number, m = finite_object ? std::abs(data.magnification) : 0;
  if (std::isnan(n))
    throw InputError(
        "does not say the f-number: without it the level of the light must be given (`g_axis_sr`)");
  if (!(std::isfinite(n) && n > 0))
    throw InputError(fmt::format(
        "the f-number is {:g}: a positive one, or the level of the light (`g_axis_sr`), would be right", n));
  const double g = iset_irradiance_sr(n, m);
  notes.push_back(
      fmt::format("the file says nothing of the level of the light: g_sensor on the axis is taken as "
                  "π/(1 + 4 N²(1 + |m|)²) = {:.5f} sr at f/{:.4g} (`g_axis_sr` sets another)",
                  g, n));
  return g;
}

}  // namespace petzval
