// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/imaging/image_table.h>
#include <petzval/imaging/layer_plan.h>
#include <petzval/lens/lens_file.h>
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

/// Bands lie between two wavelengths of a table: some that are a twentieth apart are enough. Of a picture of
/// double-gauss in 31 bands that changes 2e-5 (relative L2). The first and the last are kept.
std::vector<double> sparse_wavelengths_nm(const std::vector<double>& bands_nm) {
  constexpr double widest_step = 1.05;
  std::vector<double> kept;
  for (std::size_t i = 0; i < bands_nm.size(); ++i)
    if (kept.empty() || i + 1 == bands_nm.size() || bands_nm[i + 1] > widest_step * kept.back())
      kept.push_back(bands_nm[i]);
  return kept;
}

/// What the table of a layer is made of.
struct LayerLens {
  Lens lens;
  TableOptions options;

  std::string key() const { return fmt::format("{} {}", options.largest_psf_size, lens_to_json(lens)); }
};

LayerLens layer_lens(const DepthCamera& camera, const DepthLayers& layers, std::size_t layer,
                     double pixel_um) {
  Lens lens = camera.lens;
  // The real stop follows from the paraxial pupil and where the object is; it must not differ by the layer.
  if (const double stop_mm = stop_radius_mm(lens); layers.layers.size() > 1 && std::isfinite(stop_mm))
    lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, stop_mm};
  MountedLens at_layer(std::move(lens));
  at_layer.place_object_at_m(layers.layers[layer].distance_m);
  TableOptions options = camera.table;
  options.largest_psf_size = largest_psf_size(layers, layer, pixel_um, options.largest_psf_size);
  if (layers.layers.size() > 1) options.wavelengths_nm = sparse_wavelengths_nm(options.wavelengths_nm);
  return {at_layer.lens(), std::move(options)};
}

}  // namespace

LensDataTable layer_table(const DepthCamera& camera, const DepthLayers& layers, std::size_t layer,
                          double pixel_um, double tolerance, const ProgressCallback& progress) {
  const LayerLens own = layer_lens(camera, layers, layer, pixel_um);
  if (camera.made)
    if (auto made = camera.made->extract(own.key())) return std::move(made.mapped());
  // Layers lie a pixel of blur apart: what lies between two is farther from either than this.
  constexpr double between_layers = 1e-2;
  constexpr int cells_a_pixel = 2;
  return build_image_table(own.lens, own.options,
                           {pixel_um / cells_a_pixel, layers.layers.size() == 1 ? tolerance : between_layers},
                           progress);
}

void keep_layer_table(const DepthCamera& camera, const DepthLayers& layers, std::size_t layer,
                      double pixel_um, LensDataTable table) {
  if (camera.made)
    camera.made->insert_or_assign(layer_lens(camera, layers, layer, pixel_um).key(), std::move(table));
}

std::vector<BandPlan> plan_layer(const Scene& scene, const LayerScene& layer, const LensDataTable& table,
                                 const SensorGeometry& frame, const ImagingOptions& options) {
  std::vector<BandPlan> plans;
  for (const double wavelength_nm : scene.wavelengths_nm())
    plans.push_back(std::move(plan_bands(layer.blank(wavelength_nm), table, frame, options).front()));
  return plans;
}

}  // namespace petzval
