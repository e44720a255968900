// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/simulate/depth_of_field.h>

#include <cmath>
#include <limits>
#include <optional>

namespace petzval {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// The object [mm in front of vertex 1] whose paraxial image lies this far behind that of the lens's own.
double object_of_image_shift_mm(const Lens& lens, double shift_mm) {
  const double nm = lens.reference_wavelength_nm;
  const double here_mm = paraxial_image_distance_mm(lens, lens.object_distance_mm, nm);
  const auto beyond = [&](double inverse_mm) {  // grows as the object comes nearer
    const double image_mm =
        paraxial_image_distance_mm(lens, inverse_mm > 0 ? std::optional(1 / inverse_mm) : std::nullopt, nm);
    return image_mm - here_mm - shift_mm;
  };
  double far = 0, near = lens.object_distance_mm ? 2 / *lens.object_distance_mm : 1e-9;
  constexpr int doublings = 60, halvings = 200;
  if (beyond(far) >= 0) {
    // Beyond a limit that there is, a lens without power (telecentric on both sides) sees far objects
    // anywhere.
    if (!lens.object_distance_mm) return infinite;
    far = 1 / *lens.object_distance_mm;
    for (int i = 0; i < doublings && beyond(far) >= 0; ++i) far /= 1.5;
    if (beyond(far) >= 0) return infinite;
  }
  for (int i = 0; i < doublings && beyond(near) < 0; ++i) near *= 1.5;
  for (int i = 0; i < halvings; ++i) {
    const double middle = (far + near) / 2;
    (beyond(middle) < 0 ? far : near) = middle;
  }
  return 1 / near;
}

}  // namespace

DepthOfField depth_of_field(const Lens& lens, double behind_mm, double before_mm) {
  const auto from_sensor_m = [&](double object_mm) { return (object_mm + lens.total_track_mm()) / mm_per_m; };
  return {from_sensor_m(object_of_image_shift_mm(lens, behind_mm)),
          from_sensor_m(object_of_image_shift_mm(lens, -before_mm))};
}

DepthOfField geometric_depth_of_field(const Lens& lens, double pixel_mm) {
  const FirstOrder first = first_order(lens);
  const double wide_mm = std::abs(first.exit_pupil.diameter_mm),
               far_mm = std::abs(first.exit_pupil.position_mm);
  if (!std::isfinite(far_mm) || !std::isfinite(wide_mm)) {
    const double shift_mm = pixel_mm * first.working_f_number;
    return depth_of_field(lens, shift_mm, shift_mm);
  }
  const double behind_mm = wide_mm > pixel_mm ? pixel_mm * far_mm / (wide_mm - pixel_mm) : infinite;
  return depth_of_field(lens, behind_mm, pixel_mm * far_mm / (wide_mm + pixel_mm));
}

double distance_in_focus_m(const Lens& lens, double shift_mm) {
  Lens far = lens;
  far.object_distance_mm.reset();
  const double infinity_mm = paraxial_image_distance_mm(far, {}, lens.reference_wavelength_nm);
  const double film_mm = lens.image_distance_mm() - shift_mm;
  return (object_of_image_shift_mm(far, film_mm - infinity_mm) + lens.total_track_mm()) / mm_per_m;
}

}  // namespace petzval
