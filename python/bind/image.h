// SPDX-License-Identifier: BSD-3-Clause
// The light of flat scenes.
#pragma once

#include "camera.h"
#include "keywords.h"

namespace petzval::python {

/// What light comes through. \throws InputError for a camera without a lens.
Optics optics_of(const CameraInPython& camera);
Optics optics_of(const TableCamera& camera);

void bind_image(nb::class_<CameraInPython>& camera, nb::class_<TableCamera>& table_camera,
                nb::module_& module);

}  // namespace petzval::python
