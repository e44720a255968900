// SPDX-License-Identifier: BSD-3-Clause
// What apertures close inside a pupil, as the sensor sees it.
#pragma once

#include <petzval/analysis/field_tracer.h>
#include <petzval/numeric/chebyshev_surface.h>

#include <optional>
#include <vector>

namespace petzval {

/// Where the light of a direction (α, β) would cross each surface that is closed inside, fitted over the
/// pupil, and so which directions are dark.
class PupilMask {
 public:
  /// Nothing where no surface is closed inside, or apertures do not count.
  static std::optional<PupilMask> of(const FieldTracer& tracer, const ChiefRay& chief);

  bool is_dark(double alpha, double beta) const;

 private:
  struct Closed {
    std::vector<ApertureFigure> figures;
    ChebyshevSurface x_mm, y_mm;  ///< in the surface's own axes
  };
  std::vector<Closed> surfaces_;
};

/// Whether the light of a launched ray ends at what closes an aperture inside.
bool is_obscured(const FieldTracer& tracer, const Ray& launched);

}  // namespace petzval
