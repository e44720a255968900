// SPDX-License-Identifier: BSD-3-Clause
// From a scene with depth through a lens to the irradiance on a sensor.
#pragma once

#include <petzval/imaging/depth_layers.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/optics/build.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace petzval {

/// A lens as it is used, and how its tables are to be made. Each layer of the scene has its
/// own distance, so that of the lens's object does not matter.
struct DepthCamera {
  Lens lens;
  TableOptions table;  ///< wavelengths, and the image height that it must reach
  /// If there is such a place: where tables that were made to fit scene and frame to each other wait for the
  /// image, which takes them.
  std::shared_ptr<std::map<std::string, LensDataTable>> made = nullptr;
};

struct DepthReport {
  ImagingReport image;
  std::vector<DepthLayer> layers;
  double pupil_to_sensor_mm = 0;  ///< the viewpoint
};

/// Forms the image of a scene with depth, layer by layer from the farthest to the nearest. Each layer is
/// imaged as a planar scene at its distance (form_image), through a lens data table of its own, and covers
/// what is behind it as far as the light cones of pixels meet it.
///
/// In each layer k, blurred by its own kernels after distortion and g_source: E the light of what lies in it,
/// A the same of a white world, W of a white plane, D of what is not hidden by nearer layers, at a twentieth
/// of its weight what is (its nearest samples that are not hidden stand for it). Then
///
///     image ← E W/D + (1 − A/D) · image.
///
/// The division by D spreads what is seen of a layer over what is hidden of it (normalised convolution), and
/// makes neighbouring layers add up: with kernels that do not differ the layers give E of the whole scene, at
/// every place, whatever the depths are. (The occlusion-aware model of Ikoma, Nguyen, Metzler, Peng &
/// Wetzstein 2021, IEEE ICCP, eq. 7 to 9, here with radiometry and a guess of what is behind.)
///
/// \param progress  of all layers. \param report  may be null.
/// \throws InputError as form_image(), for depths inside the lens, or a lens without viewpoint. Memory: the
/// planes of all bands, in cells. The bytes do not depend on the number of threads.
/// \param share  of the bands, when several processes form one image: it knows those of others.
SpectralImage form_depth_image(const Scene& scene, const DepthCamera& camera, const SensorGeometry& sensor,
                               const ImagingOptions& options, const DepthOptions& depth,
                               const ProgressCallback& progress = {}, DepthReport* report = nullptr,
                               const BandShare& share = {});

/// The same without an image: once the layers of all bands are there, each is handed over, in order.
void form_depth_bands(const Scene& scene, const DepthCamera& camera, const SensorGeometry& sensor,
                      const ImagingOptions& options, const DepthOptions& depth, const TakeBand& take,
                      const ProgressCallback& progress = {}, DepthReport* report = nullptr,
                      const BandShare& share = {});

}  // namespace petzval
