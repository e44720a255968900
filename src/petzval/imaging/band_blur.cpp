// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/band_blur.h>
#include <petzval/imaging/exact_blur.h>
#include <petzval/imaging/spread_wanted.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace petzval {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

namespace {

/// Kept of the plans of several bands: the one that allows the largest error.
void keep_coarser(const ProductPlan& plan, ProductPlan& kept) {
  if (kept.tile == 0 || plan.estimated_error > kept.estimated_error) kept = plan;
}

}  // namespace

void add_report(const ImagingReport& band, ImagingReport& all) {
  all.margin_cells = std::max(all.margin_cells, band.margin_cells);
  all.transform_size = std::max(all.transform_size, band.transform_size);
  if (band.product.tile != 0) keep_coarser(band.product, all.product);
  all.least_captured = std::min(all.least_captured, band.least_captured);
  all.distortion_seconds += band.distortion_seconds;
  all.blur_seconds += band.blur_seconds;
  all.kernel_seconds += band.kernel_seconds;
}

void BandBlur::choose(const BandPlan& band, double wavelength_nm, const SensorGeometry& frame,
                      const std::optional<ProductPlan>& hint) {
  // The next kernels go where the last ones were: those of two bands need not be kept at a time.
  if (product_) memory_ = std::move(*product_).take_memory();
  product_.reset();
  sections_.reset();
  grid_ = grown(frame, band.margin);
  margin_ = band.margin;
  if (options_.method == BlurMethod::none) return;
  psfs_.emplace(table_, wavelength_nm, frame.pitch_um, options_.interpolation, centres_,
                options_.is_preview() ? LatticeSteps::coarse : LatticeSteps::fine);
  if (options_.by_sections()) use_sections(options_.section_options());
  if (options_.method == BlurMethod::product) choose_product(band.map.look(), hint);
}

/// A plan's error is estimated for noise as strong as its mean. The factor by which errors are larger for
/// noise of the scene's contrast c, √((1 + Σh²)/(1/c² + Σh²)), h the kernels, where the lens lets light fall.
double BandBlur::harder_than_noise(const SceneLook& look) const {
  const double contrast = contrast_of_noise(contrast_);
  if (contrast == 1) return 1;
  const double lit_mm = std::min(half_diagonal_mm(grown(grid_, -margin_)), look.last_height_mm());
  double squares = 0, lights = 0;
  constexpr std::array<double, 3> heights{0, 0.5, 0.9};  // of what is lit
  for (const double height : heights) {
    const double light = std::pow(look.place(0, height * lit_mm).g_source_sr, 2);
    lights += light;
    for (const double weight : psfs_->kernel_at(0, height * lit_mm).weights)
      squares += light * weight * weight;
  }
  if (lights > 0) squares /= lights;
  return std::sqrt((1 + squares) / (1 / (contrast * contrast) + squares));
}

void BandBlur::choose_product(const SceneLook& look, const std::optional<ProductPlan>& hint) {
  const auto start = std::chrono::steady_clock::now();
  const SourceGrid source(grid_, margin_, &look);
  constexpr double least_tolerance = 1e-6;
  const double harder = harder_than_noise(look);
  ProductOptions options = options_.product;
  options.tolerance = std::max(least_tolerance, options.tolerance / harder);
  plan_ = plan_product(*psfs_, source, options, hint);
  const ProductPlan plan = plan_ ? *plan_ : plan_blended(*psfs_, source, options);
  ProductPlan for_scene = plan;
  for_scene.estimated_error *= harder;
  keep_coarser(for_scene, report_.product);
  if (!plan_) return use_sections({plan.tile, 0, true});
  report_.transform_size = std::max(report_.transform_size, plan.transform);
  report_.kernel_seconds += seconds_since(start);
}

void BandBlur::use_sections(const SectionOptions& options) {
  sections_ = options;
  report_.transform_size = std::max(report_.transform_size, transform_size(options, psfs_->radius()));
}

void BandBlur::make_kernels() {
  if (options_.method != BlurMethod::product || sections_ || product_) return;
  const auto start = std::chrono::steady_clock::now();
  product_.emplace(*psfs_, grid_, *plan_, std::move(memory_));
  if (!plan_->wants_psfs()) psfs_.reset();
  report_.kernel_seconds += seconds_since(start);
}

double BandBlur::bytes() const {
  constexpr double psf_bytes = 64e6;
  const bool keeps_psfs = options_.method != BlurMethod::none && !(product_ && !plan_->wants_psfs());
  return (product_ ? plan_->kernel_bytes : 0) + (keeps_psfs ? psf_bytes : 0);
}

CellPlane BandBlur::operator()(CellPlane source, const ProgressCallback& progress) const {
  if (options_.method == BlurMethod::none) return source;
  if (product_) return product_->blur(source, margin_);
  if (sections_) return blur_sections(source, *psfs_, margin_, *sections_, progress);
  return blur_exact(source, *psfs_, margin_, progress);
}

}  // namespace petzval
