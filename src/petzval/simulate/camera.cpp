// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/best_focus.h>
#include <petzval/analysis/ray_fan.h>
#include <petzval/base/error.h>
#include <petzval/simulate/mounting.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

Lens with_apertures(const Camera& camera, const Context& context) {
  if (camera.apertures == Camera::Apertures::from_fields) return with_apertures_from_fields(camera.lens);
  const auto missing = std::ranges::count_if(camera.lens.surfaces, [](const Surface& surface) {
    return !surface.stop && !surface.semi_diameter_mm;
  });
  if (missing > 0 && camera.apertures == Camera::Apertures::as_given)
    send_note(context, fmt::format("{} of {} surfaces have no clear aperture and clip nothing; `apertures` "
                                   "from-fields solves them",
                                   missing, camera.lens.surfaces.size()));
  return camera.lens;
}

/// Moves the sensor to the best focus, and says how far.
void seek_focus(MountedLens& lens, const Focus& focus, const FieldTableRequest& fields,
                const Context& context) {
  const bool spot = focus.kind == Focus::Kind::best_spot;
  const BestFocus best =
      spot ? best_spot_focus(lens.lens(), fields) : best_mtf_focus(lens.lens(), fields, focus.frequency_cpmm);
  send_note(context,
            fmt::format(fmt::runtime(spot ? "`focus` {} moves the sensor by {:+.5f} mm; RMS spot {:.3f} to "
                                            "{:.3f} um"
                                          : "`focus` {} moves the sensor by {:+.5f} mm; mean MTF {:.4f} to "
                                            "{:.4f}"),
                        focus.text(), best.shift_mm, best.before, best.after));
  lens.move_sensor_mm(best.shift_mm);
}

}  // namespace

MountedLens mounted_lens(const Camera& camera, const Context& context) {
  camera.lens.validate();
  if (camera.image_distance_mm && camera.focus.kind != Focus::Kind::design &&
      camera.focus.kind != Focus::Kind::automatic)
    throw InputError("`image_distance_mm` and `focus` both place the sensor; one of them would be right");
  MountedLens lens(with_apertures(camera, context));
  if (camera.f_number) lens.set_f_number(*camera.f_number);
  if (camera.image_distance_mm) lens.set_image_distance_mm(*camera.image_distance_mm);
  if (camera.move_lens_mm != 0) lens.move_lens_mm(camera.move_lens_mm);
  if (camera.blades) lens.set_blades(*camera.blades);
  return lens;
}

Lens focus(MountedLens lens, const Focus& focus, const std::optional<FieldTableRequest>& fields,
           const Context& context) {
  if (const std::optional<double> distance_m = asked_distance_m(focus)) {
    lens.focus_at_m(std::isinf(*distance_m) ? std::nullopt : distance_m);
  } else if (focus.kind == Focus::Kind::best_spot || focus.kind == Focus::Kind::best_mtf) {
    seek_focus(lens, focus, fields.value_or(FieldTableRequest::of(lens.lens())), context);
  }
  return lens.lens();
}

Lens lens_in_use(const Camera& camera, const Context& context) {
  return result_within(context, [&](const ProgressCallback&) {
    return focus(mounted_lens(camera, context), camera.focus, {}, context);
  });
}

}  // namespace petzval
