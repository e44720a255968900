// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/best_focus.h>
#include <petzval/analysis/ray_fan.h>
#include <petzval/analysis/surface_order.h>
#include <petzval/analysis/tv_distortion.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
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
  require_surfaces_in_order(camera.lens);
  if (camera.image_distance_mm && camera.focus.kind != Focus::Kind::design &&
      camera.focus.kind != Focus::Kind::automatic)
    throw InputError("`image_distance_mm` and `focus` both place the sensor; one of them would be right");
  MountedLens lens(with_apertures(camera, context));
  if (camera.f_number) lens.set_f_number(*camera.f_number);
  if (camera.image_distance_mm) lens.set_image_distance_mm(*camera.image_distance_mm);
  if (camera.move_lens_mm != 0) lens.move_lens_mm(camera.move_lens_mm);
  if (camera.blades) lens.set_blades(*camera.blades);
  lens.set_focus_wavelength_nm(camera.focus_wavelength_nm);
  return lens;
}

std::optional<double> focusing_wavelength_nm(const MountedLens& lens, std::span<const double> light_nm) {
  if (lens.focus_wavelength_nm() || light_nm.empty()) return lens.focus_wavelength_nm();
  const auto [least, most] = std::ranges::minmax(light_nm);
  const double reference_nm = lens.lens().reference_wavelength_nm;
  constexpr double same_nm = 1;  // "587" for 587.56
  if (reference_nm >= least - same_nm && reference_nm <= most + same_nm) return {};
  return (least + most) / 2;
}

void note_colour_shift(const MountedLens& lens, const Context& context) {
  constexpr double shown_mm = 5e-5;
  if (std::abs(lens.colour_shift_mm()) < shown_mm) return;
  send_note(context, fmt::format("focused for {:g} nm: the sensor stands {:+.1f} um from the focus of {:g} "
                                 "nm, + behind it (`focus_wavelength_nm` sets another)",
                                 *lens.focus_wavelength_nm(), 1e3 * lens.colour_shift_mm(),
                                 lens.lens().reference_wavelength_nm));
}

void note_short_field(const Lens& lens, const SensorGeometry& frame, const Context& context) {
  const std::optional<FrameSize> fields = frame_of_fields(lens);
  constexpr double margin = 1.1;  // what lenses leave to vignetting
  if (!fields || frame.half_diagonal_mm() <= margin * fields->half_diagonal_mm()) return;
  send_note(context,
            fmt::format("the fields of lens {} end {:.4g} mm from the axis; the corners of the sensor "
                        "lie at {:.4g} mm",
                        lens.name, fields->half_diagonal_mm(), frame.half_diagonal_mm()));
}

void note_unfocused_object(const Lens& before, const Lens& after, const Context& context) {
  const auto defocus_mm = [](const Lens& lens) {
    return lens.image_distance_mm() - first_order(lens).paraxial_image_mm;
  };
  const double moved_mm = defocus_mm(after) - defocus_mm(before);
  const double n = first_order(after).working_f_number;
  const double depth_mm = 2 * after.reference_wavelength_nm * 1e-6 * n * n;
  if (!std::isfinite(moved_mm) || !(std::abs(moved_mm) > 2 * depth_mm)) return;
  const std::string there = after.object_distance_mm
                                ? fmt::format("{:.6g}mm", *after.object_distance_mm + after.total_track_mm())
                                : "infinity";
  send_note(context, fmt::format("the object has moved, the sensor has not: it stands {:+.4g} mm from its "
                                 "focus; `focus` {} would move it there",
                                 moved_mm, there));
}

Lens focus(MountedLens lens, const Focus& focus, const std::optional<FieldTableRequest>& fields,
           const Context& context, double defocus_mm) {
  const FieldTableRequest at = fields.value_or(FieldTableRequest::of(lens.lens()));
  if (const std::optional<double> distance_m = asked_distance_m(focus)) {
    lens.set_focus_wavelength_nm(focusing_wavelength_nm(lens, at.wavelengths_nm));
    lens.focus_at_m(std::isinf(*distance_m) ? std::nullopt : distance_m);
    if (!focus.sought()) note_colour_shift(lens, context);
  }
  if (focus.kind == Focus::Kind::paraxial)
    lens.set_image_distance_mm(
        first_order(lens.lens(), focusing_wavelength_nm(lens, at.wavelengths_nm)).paraxial_image_mm);
  else if (focus.sought())
    seek_focus(lens, focus, at, context);
  if (defocus_mm != 0) lens.move_sensor_mm(defocus_mm);
  return lens.lens();
}

Lens lens_in_use(const Camera& camera, const Context& context) {
  return result_within(context, [&](const ProgressCallback&) {
    return focus(mounted_lens(camera, context), camera.focus, {}, context, camera.defocus_mm);
  });
}

}  // namespace petzval
