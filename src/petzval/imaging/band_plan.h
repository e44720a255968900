// SPDX-License-Identifier: BSD-3-Clause
// What is known of each band of an image before any light is computed.
#pragma once

#include <petzval/imaging/image_formation.h>

#include <vector>

namespace petzval {

struct BandPlan {
  SceneMap map;
  int margin = 0;             ///< cells around the frame from which light may come in; 0 without blur
  double least_captured = 1;  ///< the least share of light that a PSF window holds
};

/// A plan for each band of the scene. \param frame  in cells, S × S to a pixel.
/// \throws InputError for wavelengths outside the table, or a transform that is too small.
std::vector<BandPlan> plan_bands(const Scene& scene, const LensDataTable& table, const SensorGeometry& frame,
                                 const ImagingOptions& options);

double half_diagonal_mm(const SensorGeometry& grid);

}  // namespace petzval
