// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/base/version.h>
#include <petzval/imaging/psf_tails.h>
#include <petzval/sensor/lens_facts.h>
#include <petzval/simulate/image.h>
#include <petzval/simulate/image_pieces.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

std::string product_text(const ImagingOptions& options, const ImagingReport& report,
                         const std::string& between) {
  const ProductPlan& plan = report.product;
  const std::string rim = plan.exact.empty()
                              ? ""
                              : fmt::format("every cell its own PSF {:.0f} to {:.0f} cells from the axis, ",
                                            plan.exact.from, plan.exact.to);
  const std::string zones =
      plan.inner.empty()
          ? ""
          : fmt::format("{0} x {0} nodes in tiles of {1} x {1} within {2:.0f} cells of the axis, ",
                        plan.inner.front().nodes, plan.inner.front().tile, plan.inner.front().zone.to);
  const std::string far = report.tail_pixels == 0
                              ? ""
                              : fmt::format("light beyond {} pixels on pixels {} times as wide, ",
                                            report.tail_pixels, tail_coarseness(report.tail_pixels));
  const std::string error = fmt::format(
      "{} x {} cells a pixel, {}{}{}estimated error {:.1e} of {:g}; {} interpolated", report.cells_per_pixel,
      report.cells_per_pixel, zones, rim, far, report.estimated_error(), options.product.tolerance, between);
  if (plan.direct)
    return fmt::format("product, {0} x {0} nodes in tiles of {1} x {1} cells, gathered, {2}", plan.nodes,
                       plan.tile, error);
  if (plan.transform == 0) return fmt::format("blended sections of {0} x {0} cells, {1}", plan.tile, error);
  return fmt::format("product, {0} x {0} nodes in tiles of {1} x {1} cells, transforms of {2} x {2}, {3}",
                     plan.nodes, plan.tile, plan.transform, error);
}

std::string method_text(const ImagingOptions& options, const ImagingReport& report) {
  if (options.method == BlurMethod::none) return "distortion and illumination, no blur";
  const std::string between = options.interpolation == PsfInterpolation::otf ? "OTFs" : "PSFs";
  if (options.method == BlurMethod::exact)
    return fmt::format("exact, every cell its own PSF; {} interpolated", between);
  if (options.method == BlurMethod::product) return product_text(options, report, between);
  return fmt::format("{3}sections of {0} x {0} cells, transforms of {1} x {1}; {2} interpolated",
                     options.sections.section, report.transform_size, between,
                     options.method == BlurMethod::blended ? "blended " : "");
}

ImageReport& finish(const ImagePlan& plan, const Context& context, ImageReport& report) {
  report.method = method_text(plan.options.imaging, report.imaging);
  for (const std::string& line : report.imaging.notes) send_note(context, line);
  return report;
}

void tell(DepthReport deep, ImageReport& says) {
  says.imaging = std::move(deep.image);
  says.layers = std::move(deep.layers);
  says.pupil_to_sensor_mm = deep.pupil_to_sensor_mm;
}

FlareLayers flare_of(const ImagePlan& plan, const Context& context, SpectralImage& light) {
  const FlareOptions& options = plan.options.flare;
  LitLens lens = *plan.lens;
  for (const Psf& psf : plan.table.psf)
    lens.psf_mm = std::max(lens.psf_mm, psf.size / 2 * psf.spacing_um * mm_per_um);
  if (plan.options.imaging.method == BlurMethod::none) lens.psf_mm = 0;
  FlareLayers layers = flare_layers(
      lens, plan.frame, plan.scene.wavelengths_nm(),
      options.seeks() ? find_sources(plan.scene, lens.lens.total_track_mm(), options.search) : SourcesFound{},
      options, context);
  add_layers(layers, light);
  if (options.scatter) add_scatter(lens, options, layers, light, context);
  return layers;
}

}  // namespace

SpectralImage image(const ImagePlan& plan, const Context& context, ImageReport* report) {
  if (plan.options.bands) throw InputError("`bands` are a piece of an image, which image_piece() forms");
  const BandShare share = known_bands(plan);
  ImageReport unwanted;
  ImageReport& says = report ? *report : unwanted;
  SpectralImage light = result_within(context, [&](const ProgressCallback& progress) {
    if (!plan.depth)
      return form_image(plan.scene, plan.table, plan.frame, plan.options.imaging, progress, &says.imaging,
                        share, plan.memory.get());
    DepthReport deep;
    SpectralImage formed = form_depth_image(plan.scene, *plan.depth, plan.frame, plan.options.imaging,
                                            plan.options.depth, progress, &deep, share);
    tell(std::move(deep), says);
    return formed;
  });
  finish(plan, context, says);
  const Scene& scene = plan.scene;
  light.provenance = fmt::format(
      "petzval {} image: {} {} through {}, working f-number {:.4g}; {}", version(), scene.name,
      scene.distance_m() ? fmt::format("{:g} m from the sensor", *scene.distance_m()) : "at infinity",
      plan.table.lens_name, plan.table.first_order.working_f_number, says.method);
  if (plan.options.flare.any()) {
    says.flare = flare_of(plan, context, light);
    const auto [darkest, brightest] = std::ranges::minmax(light.values());
    says.imaging.darkest = double(darkest);
    says.imaging.brightest = double(brightest);
  }
  return light;
}

void image_bands(const ImagePlan& plan, const TakeBand& take, const Context& context, ImageReport* report) {
  if (plan.options.flare.any())
    throw InputError("light that goes astray is added to an image, not handed over band by band");
  const BandShare share = known_bands(plan);
  ImageReport unwanted;
  ImageReport& says = report ? *report : unwanted;
  run_within(context, [&](const ProgressCallback& progress) {
    if (plan.depth) {
      DepthReport deep;
      form_depth_bands(plan.scene, *plan.depth, plan.frame, plan.options.imaging, plan.options.depth, take,
                       progress, &deep, share);
      return tell(std::move(deep), says);
    }
    form_bands(plan.scene, plan.table, plan.frame, plan.options.imaging, take, progress, &says.imaging, share,
               plan.memory.get());
  });
  finish(plan, context, says);
}

SpectralImage image(const SceneRequest& scene, Optics optics, const ImageOptions& options,
                    const Context& context, ImageReport* report) {
  return image(plan_image(scene, std::move(optics), options, context), context, report);
}

SpectralImage image(Scene scene, Optics optics, const ImageOptions& options, const Context& context,
                    ImageReport* report) {
  return image(plan_image(std::move(scene), std::move(optics), options, context), context, report);
}

}  // namespace petzval
