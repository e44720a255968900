// SPDX-License-Identifier: BSD-3-Clause
// The blur of one band after the other, by the method that was asked for.
#pragma once

#include <petzval/imaging/band_plan.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/product_blur.h>

#include <chrono>
#include <optional>

namespace petzval {

/// Blurs planes of light, band by band; any number of planes of a band share its kernels.
///
///     BandBlur blur(table, centres, options, report, contrast);
///     blur.choose(plan, 550, frame, {});
///     blur.make_kernels();
///     CellPlane image = blur(std::move(source));
///
/// What it chose, and the time that kernels took, is added to the report. Everything it is given must outlive
/// it.
class BandBlur {
 public:
  /// \param contrast  CellChoice::contrast of the scene.
  BandBlur(const LensDataTable& table, const LightCentres& centres, const ImagingOptions& options,
           ImagingReport& report, double contrast)
      : table_(table), options_(options), centres_(centres), report_(report), contrast_(contrast) {}

  /// Decides how a wavelength is blurred. \param band  its plan. \param frame  of the images [cells]; planes
  /// of light are larger by the plan's margin on every side. \param hint  the plan() of a neighbouring band.
  void choose(const BandPlan& band, double wavelength_nm, const SensorGeometry& frame,
              const std::optional<ProductPlan>& hint);
  /// Makes its kernels; nothing if they are made.
  void make_kernels();
  /// That the kernels take.
  double bytes() const;
  /// What was chosen; absent for other methods than `product`, and where PSFs are too large for it.
  const std::optional<ProductPlan>& plan() const { return plan_; }
  CellPlane operator()(CellPlane source, const ProgressCallback& progress = {}) const;

 private:
  void choose_product(const SceneLook& look, const std::optional<ProductPlan>& hint);
  void use_sections(const SectionOptions& options);
  double harder_than_noise(const SceneLook& look) const;

  const LensDataTable& table_;
  const ImagingOptions& options_;
  const LightCentres& centres_;
  ImagingReport& report_;
  double contrast_;
  SensorGeometry grid_;
  int margin_ = 0;
  std::optional<PsfField> psfs_;
  std::optional<SectionOptions> sections_;
  std::optional<ProductBlur> product_;
  std::optional<ProductPlan> plan_;  ///< of the last band
  TransformBlur::KernelSets memory_;
};

/// Adds what is said of one band to what is said of all.
void add_report(const ImagingReport& band, ImagingReport& all);

/// Since a start [s].
double seconds_since(std::chrono::steady_clock::time_point start);

}  // namespace petzval
