// SPDX-License-Identifier: BSD-3-Clause
#include "camera_option.h"

#include <fmt/format.h>
#include <petzval/analysis/best_focus.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/units.h>
#include <petzval/camera/mounted_lens.h>

#include <cmath>

namespace petzval::app {

namespace {

/// A whole text as a positive number.
std::optional<double> positive_value(std::string_view text) {
  const std::optional<double> value = parse_number(text);
  return value && *value > 0 ? value : std::nullopt;
}

constexpr std::string_view by_mtf = "best-mtf@";

void focus_camera(MountedLens& camera, const std::string& focus,
                  const std::optional<FieldTableRequest>& request, const Shared& shared) {
  if (focus == "design") return;
  if (focus == "infinity" || focus == "inf") return camera.focus_at_m({});
  if (const std::optional<double> distance_mm = positive_value(focus))
    return camera.focus_at_m(*distance_mm / mm_per_m);
  const FieldTableRequest fields = request.value_or(FieldTableRequest::of(camera.lens()));
  BestFocus best;
  if (focus == "best-spot") {
    best = best_spot_focus(camera.lens(), fields);
    note(shared, fmt::format("--focus best-spot moves the sensor by {:+.5f} mm; RMS spot {:.3f} to {:.3f} um",
                             best.shift_mm, best.before, best.after));
  } else if (focus.starts_with(by_mtf)) {
    const std::optional<double> frequency = positive_value(std::string_view(focus).substr(by_mtf.size()));
    if (!frequency)
      throw InputError(
          fmt::format("--focus {}: give a frequency in cycles/mm, for example best-mtf@40", focus));
    best = best_mtf_focus(camera.lens(), fields, *frequency);
    note(shared, fmt::format("--focus {} moves the sensor by {:+.5f} mm; mean MTF {:.4f} to {:.4f}", focus,
                             best.shift_mm, best.before, best.after));
  } else {
    throw InputError(fmt::format(
        "--focus {}: design, infinity, a distance from the sensor in mm, best-spot or best-mtf@CYCLES_PER_MM "
        "would be right",
        focus));
  }
  camera.move_sensor_mm(best.shift_mm);
}

}  // namespace

void CameraChoice::add_to(CLI::App& command) {
  command.add_option("--f-number", f_number, "Stop down to this paraxial f-number")->check(positive_number());
  command.add_option("--focus", focus,
                     "Where the sensor stands: design, infinity, an object distance from the sensor [mm], "
                     "best-spot or best-mtf@CYCLES_PER_MM");
  command
      .add_option("--image-distance", image_distance_mm,
                  "Put the sensor this far behind the last surface [mm]")
      ->check(positive_number());
  command.add_option("--move-lens", move_lens_mm,
                     "Move the whole lens towards the object [mm]; object and sensor stay");
  blades.add_to(command);
  command
      .add_option(
          "--field-azimuth", field_azimuth_deg,
          "Of the fields about the axis, from the top of the film anticlockwise as seen from there [deg]: "
          "what a stop of blades looks like from there")
      ->check(finite_number());
}

Lens CameraChoice::used(const Lens& lens, const std::optional<FieldTableRequest>& request,
                        const Shared& shared) const {
  if (image_distance_mm && focus != "design")
    throw InputError("--image-distance and --focus both place the sensor; give one of them");
  MountedLens camera(lens);
  if (f_number) camera.set_f_number(*f_number);
  if (image_distance_mm) camera.set_image_distance_mm(*image_distance_mm);
  if (move_lens_mm) camera.move_lens_mm(*move_lens_mm);
  StopBlades seen = blades.blades(lens);
  // Fields lie in the y-z plane: turning them is turning the blades the other way.
  if (seen.count > 0) seen.rotation_deg -= field_azimuth_deg;
  camera.set_blades(seen);
  focus_camera(camera, focus, request, shared);
  return camera.lens();
}

}  // namespace petzval::app
