// SPDX-License-Identifier: BSD-3-Clause
// The steps from a camera's settings to the lens that is traced.
#pragma once

#include <petzval/analysis/field_tables.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/sensor/sensor.h>
#include <petzval/simulate/camera.h>

#include <optional>
#include <span>

namespace petzval {

/// The wavelength that distances are focused for: the one asked for, else the middle of the light where the
/// reference wavelength of the lens lies outside it. Absent: the reference wavelength.
std::optional<double> focusing_wavelength_nm(const MountedLens& lens, std::span<const double> light_nm);
/// A note of how far the sensor moved for another wavelength than the reference; none if it did not.
void note_colour_shift(const MountedLens& lens, const Context& context);

/// A note where the fields that the lens is made for end more than a tenth before the corners of a sensor.
void note_short_field(const Lens& lens, const SensorGeometry& frame, const Context& context);
/// A note where another object distance has left the sensor where the object is not sharp: beyond twice the
/// depth of focus, 2 λ N². \param before  the lens with its sensor for its own object.
void note_unfocused_object(const Lens& before, const Lens& after, const Context& context);

/// The lens with apertures, stop and blades as the camera uses them, not yet focused. A note says when clear
/// apertures are missing. \throws InputError for an f-number that the lens does not open to, and for what
/// cannot go together.
MountedLens mounted_lens(const Camera& camera, const Context& context);

/// The lens with the sensor where the focus asks for it, and `defocus_mm` behind. Automatic focus and that of
/// the design leave it; best focus is sought over these fields and wavelengths (absent: the lens's own).
Lens focus(MountedLens lens, const Focus& focus, const std::optional<FieldTableRequest>& fields,
           const Context& context, double defocus_mm = 0);

}  // namespace petzval
