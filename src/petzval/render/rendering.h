// SPDX-License-Identifier: BSD-3-Clause
// What comes of rendering.
#pragma once

#include <petzval/image/spectral_image.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace petzval::render {

/// What a picture's first surfaces are, seen through the lens: means over the rays that met one.
struct FirstSurfaces {
  std::vector<float>
      depth;  ///< distance from the film along the camera's axis [scene units]; infinity where nothing is met
  std::vector<float> normal;  ///< world space, [pixel][3]
  std::vector<float> albedo;  ///< [band][pixel]
  std::vector<float> share;   ///< of the rays that met a surface
};

struct Rendering {
  SpectralImage irradiance;  ///< [W·m⁻²·nm⁻¹], of the window; of its pixel aperture
  /// What each light of the scene gives of `irradiance`, if that was asked for; by Lights::sources.
  std::vector<SpectralImage> light_groups;
  std::optional<FirstSurfaces> first_surfaces;
  std::uint64_t rays = 0, passed = 0;  ///< camera rays, and those that got through the lens
  bool complete = true;
  bool denoised = false;
  int samples_per_pixel = 0;    ///< that were taken
  std::optional<double> noise;  ///< estimate, if RenderOptions::noise asks for one
};

}  // namespace petzval::render
