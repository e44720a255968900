// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/simulate/framing.h>
#include <petzval/trace/exit_pupil_region.h>
#include <petzval/trace/tracer.h>

#include <algorithm>
#include <cmath>

namespace petzval {

Framing framing(const PreparedScene& scene) {
  if (!scene.lens)
    throw InputError("an ideal camera has no focal length and no f-number; `lens` names a lens");
  Lens lens = *scene.lens;
  Framing result;
  result.film_width_mm = scene.film.width_mm(), result.film_height_mm = scene.film.height_mm();
  result.distance_m = scene.focus ? scene.focus->distance_m : distance_in_focus_m(lens);
  lens.object_distance_mm.reset();
  result.view = frame_view(lens, scene.film);
  if (std::isfinite(result.distance_m))
    lens.object_distance_mm = result.distance_m * mm_per_m - lens.total_track_mm();
  const FirstOrder first = first_order(lens);
  result.efl_mm = first.efl_mm, result.f_number = first.f_number;
  result.working_f_number = first.working_f_number;
  result.sharp = geometric_depth_of_field(lens, scene.film.pitch_um * mm_per_um);
  const Tracer tracer = Tracer(*scene.lens, scene.lens->reference_wavelength_nm).with_blades({});
  result.lit_circle_mm = 2 * lit_radius_mm(tracer, scene.film.half_diagonal_mm());
  return result;
}

bool lights_too_little(const Framing& framing) {
  return framing.lit_circle_mm < std::min(framing.film_width_mm, framing.film_height_mm) / 2;
}

}  // namespace petzval
