// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/band_blur.h>
#include <petzval/imaging/exact_blur.h>

#include <algorithm>
#include <utility>

namespace petzval {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void BandBlur::prepare(double wavelength_nm, const SensorGeometry& grid, int margin) {
  // The next kernels go where the last ones were: those of two bands need not be kept at a time.
  if (product_) memory_ = std::move(*product_).take_memory();
  product_.reset();
  sections_.reset();
  margin_ = margin;
  if (options_.method == BlurMethod::none) return;
  psfs_.emplace(table_, wavelength_nm, grid.pitch_um, options_.interpolation, centres_);
  if (options_.by_sections()) prepare_sections(options_.section_options());
  if (options_.method == BlurMethod::product) prepare_product(grid);
}

CellPlane BandBlur::operator()(CellPlane source, const ProgressCallback& progress) const {
  if (options_.method == BlurMethod::none) return source;
  if (product_) return product_->blur(source, margin_);
  if (sections_) return blur_sections(source, *psfs_, margin_, *sections_, progress);
  return blur_exact(source, *psfs_, margin_, progress);
}

void BandBlur::prepare_sections(const SectionOptions& options) {
  sections_ = options;
  report_.transform_size = std::max(report_.transform_size, transform_size(options, psfs_->radius()));
}

void BandBlur::prepare_product(const SensorGeometry& grid) {
  const auto start = std::chrono::steady_clock::now();
  plan_ = plan_product(*psfs_, grid, options_.product, plan_);
  const ProductPlan plan = plan_ ? *plan_ : plan_blended(*psfs_, grid, options_.product);
  if (report_.product.tile == 0 || plan.estimated_error > report_.product.estimated_error)
    report_.product = plan;
  if (!plan_) return prepare_sections({plan.tile, 0, true});
  product_.emplace(*psfs_, grid, plan, std::move(memory_));
  report_.transform_size = std::max(report_.transform_size, plan.transform);
  report_.kernel_seconds += seconds_since(start);
}

}  // namespace petzval
