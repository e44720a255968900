// SPDX-License-Identifier: BSD-3-Clause
// Whether any light at all reaches the film.
#pragma once

#include <petzval/render/camera/film_camera.h>
#include <petzval/sensor/sensor.h>

namespace petzval::render {

/// Sends some thousand rays from all over the film and from about its middle, one group of wavelengths after
/// the other, and stops at the first that passes.
bool any_light_passes(const FilmCamera& camera, const SensorGeometry& film, int groups);

}  // namespace petzval::render
