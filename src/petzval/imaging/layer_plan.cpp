// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/camera/camera.h>
#include <petzval/imaging/layer_plan.h>
#include <petzval/trace/tracer.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// An eighth of a pixel is fine enough for the samples of a PSF that is blurred over many; finer ones would
/// make tables slow. Of a picture of dgauss-50mm that changes 4e-4 (relative L2).
int largest_psf_size(const DepthLayers& layers, std::size_t layer, double pixel_um, int usual) {
  if (layers.layers.size() == 1) return usual;  // as the same scene without depth has it
  constexpr double samples_per_pixel = 8, pixels_about = 8;
  constexpr int least = 128;
  const double pixels = std::abs(layers.layers[layer].blur_um) / pixel_um + pixels_about;
  return std::min(usual, std::max(least, static_cast<int>(std::ceil(samples_per_pixel * pixels))));
}

}  // namespace

LensDataTable layer_table(const DepthCamera& camera, const DepthLayers& layers, std::size_t layer,
                          double pixel_um, const ProgressCallback& progress) {
  Lens lens = camera.lens;
  // The real stop follows from the paraxial pupil and where the object is; it must not differ by the layer.
  if (const double stop_mm = stop_radius_mm(lens); layers.layers.size() > 1 && std::isfinite(stop_mm))
    lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, stop_mm};
  Camera at_layer(std::move(lens));
  at_layer.place_object_at_m(layers.layers[layer].distance_m);
  TableOptions options = camera.table;
  options.largest_psf_size = largest_psf_size(layers, layer, pixel_um, options.largest_psf_size);
  return build_lens_data_table(at_layer.lens(), options, progress);
}

std::vector<BandPlan> plan_layer(const Scene& scene, const LayerScene& layer, const LensDataTable& table,
                                 const SensorGeometry& frame, const ImagingOptions& options) {
  std::vector<BandPlan> plans;
  for (const double wavelength_nm : scene.wavelengths_nm())
    plans.push_back(std::move(plan_bands(layer.blank(wavelength_nm), table, frame, options).front()));
  return plans;
}

}  // namespace petzval
