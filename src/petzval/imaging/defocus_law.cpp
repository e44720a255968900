// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/defocus_law.h>
#include <petzval/lens/first_order.h>

#include <cmath>

namespace petzval {

DefocusLaw::DefocusLaw(const Lens& lens) {
  const PupilData pupil = first_order(lens).entrance_pupil;
  if (!std::isfinite(pupil.position_mm) || !std::isfinite(pupil.diameter_mm))
    throw InputError(fmt::format(
        "lens {} is telecentric in object space: it has no viewpoint from which a scene with depth "
        "could be seen (`scene.depth` none images it as a plane)",
        lens.name));
  pupil_to_sensor_mm_ = lens.total_track_mm() - pupil.position_mm;
  const double radius = pupil.diameter_mm / 2, wavelength_nm = lens.reference_wavelength_nm;
  // The ray through the edge of the pupil with the slope radius × vergence, at vertex 1.
  const auto height_at_sensor = [&](double vergence) {
    const double slope = radius * vergence;
    return trace_paraxial(lens, radius - pupil.position_mm * slope, slope, wavelength_nm).height_mm.back();
  };
  const double parallel = height_at_sensor(0), change = height_at_sensor(1) - parallel;
  if (!(radius > 0) || change == 0 || !std::isfinite(change) || !std::isfinite(parallel))
    throw InputError(fmt::format("lens {} forms no image that could be in focus or out of it", lens.name));
  um_per_vergence_ = 2 * std::abs(change) * um_per_mm;
  focus_ = -parallel / change;
}

double DefocusLaw::vergence(std::optional<double> distance_m) const {
  return distance_m ? 1 / (*distance_m * mm_per_m - pupil_to_sensor_mm_) : 0;
}

std::optional<double> DefocusLaw::distance_m(double vergence) const {
  constexpr double least = 1e-10;  // beyond 10^10 mm nothing differs from infinity
  if (!(vergence > least)) return std::nullopt;
  return (1 / vergence + pupil_to_sensor_mm_) / mm_per_m;
}

}  // namespace petzval
