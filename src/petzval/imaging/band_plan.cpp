// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/imaging/band_plan.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace petzval {

namespace {

/// Cells beyond a source cell in whose light it shares.
int source_margin(int psf_margin) {
  return psf_margin > 0 ? 1 : 0;
}

}  // namespace

double half_diagonal_mm(const SensorGeometry& grid) {
  return std::hypot(grid.width_mm(), grid.height_mm()) / 2;
}

std::vector<BandPlan> plan_bands(const Scene& scene, const LensDataTable& table, const SensorGeometry& frame,
                                 const ImagingOptions& options) {
  const LightCentres centres(table);
  const std::vector<double>& wavelengths_nm = scene.wavelengths_nm();
  std::vector<std::optional<BandPlan>> found(wavelengths_nm.size());
  parallel_for(found.size(), [&](std::size_t band) {
    const double wavelength_nm = wavelengths_nm[band];
    int margin = 0;
    double least_captured = 1;
    if (options.method != BlurMethod::none) {
      const PsfReach reach = psf_reach(table, wavelength_nm, frame.pitch_um, centres);
      margin = reach.radius;
      least_captured = reach.least_captured;
    }
    if (options.by_sections()) transform_size(options.section_options(), margin);
    SceneMap map(table, centres, options.fit, wavelength_nm, scene,
                 half_diagonal_mm(grown(frame, margin + source_margin(margin))));
    found[band] = BandPlan{std::move(map), margin, least_captured};
  });
  std::vector<BandPlan> plans;
  for (std::optional<BandPlan>& plan : found) plans.push_back(*std::move(plan));
  return plans;
}

}  // namespace petzval
