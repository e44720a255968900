// SPDX-License-Identifier: BSD-3-Clause
// The rays of one field by where they cross the stop.
#pragma once

#include <petzval/analysis/pupil_rays.h>

#include <array>
#include <optional>

namespace petzval {

/// Aims real rays of a field at points of the stop surface, so that fans and maps are even in the pupil that
/// all fields and wavelengths share. Points are in units of the stop radius: (0, 0) is the chief ray, (0, 1)
/// the upper rim. Keep one for a whole fan: it begins each search at the last ray found. Not for use from
/// several threads at once.
class StopAim {
 public:
  /// Nothing where no ray of the field passes.
  static std::optional<StopAim> of(const FieldTracer& tracer, const ChiefRay& chief);

  /// The ray through (x, y) on the stop, its weights zero; nothing where the glass does not bring one there,
  /// or an aperture (as the tracer clips) stops it. Rays within a billionth of the rim pass.
  std::optional<PupilRay> ray(double x, double y);
  /// The same ray as it sets out, from the object or from the plane through vertex 1 across the beam.
  std::optional<Ray> launch(double x, double y);

 private:
  StopAim(const FieldTracer& tracer, const ChiefRay& chief, double nudge);
  struct Found {
    double x, y;  ///< on the stop [mm]
    double u, v;
  };
  std::optional<Found> search(double x_mm, double y_mm, const Found& from) const;
  std::optional<Tracer::Clearance> trace(double u, double v) const;
  std::optional<Tracer::Clearance> aimed(double x, double y);

  const FieldTracer* tracer_;
  ChiefRay chief_;
  Pencil pencil_;
  double nudge_, radius_mm_;
  Found start_, last_;
};

}  // namespace petzval
