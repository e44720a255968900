// SPDX-License-Identifier: BSD-3-Clause
// The steps from a camera's settings to the lens that is traced.
#pragma once

#include <petzval/analysis/field_tables.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/simulate/camera.h>

#include <optional>

namespace petzval {

/// The lens with apertures, stop and blades as the camera uses them, not yet focused. A note says when clear
/// apertures are missing. \throws InputError for an f-number that the lens does not open to, and for what
/// cannot go together.
MountedLens mounted_lens(const Camera& camera, const Context& context);

/// The lens with the sensor where the focus asks for it. Automatic focus and that of the design leave it;
/// best focus is sought over these fields and wavelengths (absent: the lens's own).
Lens focus(MountedLens lens, const Focus& focus, const std::optional<FieldTableRequest>& fields,
           const Context& context);

}  // namespace petzval
