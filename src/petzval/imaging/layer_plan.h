// SPDX-License-Identifier: BSD-3-Clause
// The table and the band plans of one layer of depth.
#pragma once

#include <petzval/imaging/band_plan.h>
#include <petzval/imaging/depth_image.h>
#include <petzval/imaging/layer_scene.h>

#include <vector>

namespace petzval {

/// The lens's table for an object at the distance of a layer; the sensor stays where it is. With several
/// layers it has no more wavelengths than one in 5 %, between which bands lie. \param pixel_um  that PSFs
/// need not be much finer than. \param tolerance  ProductOptions::tolerance, of a single layer.
LensDataTable layer_table(const DepthCamera& camera, const DepthLayers& layers, std::size_t layer,
                          double pixel_um, double tolerance, const ProgressCallback& progress = {});
/// Lets the next layer_table() of this layer have this table, if the camera has a place for it.
void keep_layer_table(const DepthCamera& camera, const DepthLayers& layers, std::size_t layer,
                      double pixel_um, LensDataTable table);

/// plan_bands() of a layer.
std::vector<BandPlan> plan_layer(const Scene& scene, const LayerScene& layer, const LensDataTable& table,
                                 const SensorGeometry& frame, const ImagingOptions& options);

}  // namespace petzval
