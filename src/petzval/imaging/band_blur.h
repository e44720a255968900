// SPDX-License-Identifier: BSD-3-Clause
// The blur of one band after the other, by the method that was asked for.
#pragma once

#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/product_blur.h>

#include <chrono>
#include <optional>

namespace petzval {

/// Blurs planes of light, band by band; any number of planes of a band share its kernels.
///
///     BandBlur blur(table, options, report);
///     blur.prepare(550, source.grid, margin);
///     CellPlane image = blur(std::move(source));
///
/// What it chose, and the time that kernels took, is added to the report. Table, options and report must
/// outlive it.
class BandBlur {
 public:
  BandBlur(const LensDataTable& table, const ImagingOptions& options, ImagingReport& report)
      : table_(table), options_(options), centres_(table), report_(report) {}

  /// Makes the kernels of a wavelength for planes on a grid. \param margin  by which their images are smaller
  /// on every side.
  void prepare(double wavelength_nm, const SensorGeometry& grid, int margin);
  CellPlane operator()(CellPlane source, const ProgressCallback& progress = {}) const;

 private:
  void prepare_product(const SensorGeometry& grid);
  void prepare_sections(const SectionOptions& options);

  const LensDataTable& table_;
  const ImagingOptions& options_;
  const LightCentres centres_;
  ImagingReport& report_;
  int margin_ = 0;
  std::optional<PsfField> psfs_;
  std::optional<SectionOptions> sections_;
  std::optional<ProductBlur> product_;
  std::optional<ProductPlan> plan_;  ///< of the last band
  TransformBlur::KernelSets memory_;
};

/// Since a start [s].
double seconds_since(std::chrono::steady_clock::time_point start);

}  // namespace petzval
