// SPDX-License-Identifier: BSD-3-Clause
// Spot sizes by field and wavelength.
#pragma once

#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/pupil_rays.h>

#include <optional>
#include <vector>

namespace petzval {

/// What each ray counts for: its area on the stop (as Zemax and CODE V count rays of a uniform pupil grid),
/// or its light.
enum class RayWeight { stop_area, light };

struct SpotRow {
  double field = 0, wavelength_nm = 0;
  double real_image_height_mm = 0;    ///< of the chief ray
  double centroid_um = 0;             ///< of the spot, along y from the chief ray
  double centroid_x_um = 0;           ///< along x; 0 by symmetry, but for blades
  double rms_radius_um = 0;           ///< about the centroid
  double rms_x_um = 0, rms_y_um = 0;  ///< about the centroid
  double max_radius_um = 0;           ///< of the rim and all rays inside it, about the centroid
  /// 1.22 λ N with N = √(π / 4Ω) of the exit cone of the field, Ω = n'² ∬ dα dβ.
  double airy_radius_um = 0;
};

/// \returns nothing where no ray passes.
std::optional<SpotRow> spot(const FieldTracer& tracer, const ChiefRay& chief,
                            RayWeight weight = RayWeight::stop_area, const PupilSampling& sampling = {});

/// Rows in the order fields × wavelengths. \throws InputError naming the field at which no ray passes.
std::vector<SpotRow> spot_table(const Lens& lens, const FieldTableRequest& request,
                                RayWeight weight = RayWeight::stop_area);

}  // namespace petzval
