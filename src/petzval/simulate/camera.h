// SPDX-License-Identifier: BSD-3-Clause
// The camera: a lens, how it is used, and the sensor behind it.
#pragma once

#include <petzval/base/context.h>
#include <petzval/lens/lens.h>
#include <petzval/sensor/sensor.h>
#include <petzval/simulate/focus.h>
#include <petzval/trace/losses.h>

#include <optional>

namespace petzval {

/// What all three ways to the sensor are given. A value: alter it and image again.
///
///     Camera camera{.lens = read_lens("edmund-54852").lens};
///     camera.f_number = 4;
///     camera.focus = Focus::at_m(1.2);
///     camera.sensor = read_sensor("third-inch-1280x960");
///     const SpectralImage light = image({.name = "studio"}, camera);
struct Camera {
  /// Clear apertures that the prescription leaves out.
  enum class Apertures {
    as_given,     ///< such surfaces clip nothing
    from_fields,  ///< as wide as the lens's fields need (with_apertures_from_fields)
    ignored       ///< nothing but the stop clips, whatever the prescription says
  };

  Lens lens = Lens();  // "= {}" makes g++ 12 warn of what it does not see through
  Focus focus = {};
  std::optional<double> f_number = {};    ///< paraxial, at infinity; absent: as the prescription has it
  std::optional<StopBlades> blades = {};  ///< absent: as the prescription has them
  std::optional<double> image_distance_mm = {};  ///< from the last vertex to the sensor, in place of a focus
  std::optional<double> focus_wavelength_nm = {};  ///< absent: of the light in use (focusing_wavelength_nm)
  double defocus_mm = 0;                           ///< of the sensor from its focus, away from the lens
  double move_lens_mm = 0;  ///< the whole lens towards the object; object and sensor stay
  Apertures apertures = Apertures::as_given;
  Losses losses = {};
  std::optional<Sensor> sensor = {};  ///< absent: what fits the scene
};

/// The lens as a lens program would look at it: stopped down, moved, focused, with these apertures. Best
/// focus is sought over the lens's own fields; automatic focus is that of the design, for there is no scene.
/// Notes tell of missing apertures and of how far the sensor moved. \throws InputError for what the lens
/// cannot do.
Lens lens_in_use(const Camera& camera, const Context& context = {});

}  // namespace petzval
