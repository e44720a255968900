// SPDX-License-Identifier: BSD-3-Clause
// What every way to an image begins and ends with.
#pragma once

#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/pixel_gather.h>

namespace petzval {

/// A black image of a scene's bands, of the pixels of a sensor and their aperture.
SpectralImage blank_image(const Scene& scene, const SensorGeometry& sensor, const ImagingOptions& options);

/// Puts into the report how dark and how bright the pixels of a band are. \param first  of an image's bands.
void note_extremes(std::span<const float> pixels, bool first, ImagingReport& report);

/// Adds to the report what a user should know of the image whose bands were put.
void note_result(ImagingReport& report);

}  // namespace petzval
