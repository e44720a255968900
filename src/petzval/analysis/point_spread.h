// SPDX-License-Identifier: BSD-3-Clause
// The diffraction PSF of a lens at a field point.
#pragma once

#include <petzval/analysis/field_tracer.h>
#include <petzval/wave/angle_characteristic.h>

#include <optional>

namespace petzval {

/// Grid and quadrature of one PSF.
struct PsfPlan {
  int size = 0;           ///< samples a side
  double spacing_um = 0;  ///< at or below λN/2
  int radial_nodes = 0, azimuths = 0;
};

/// What the caller fixes; zeros are chosen: the window from the ray spot plus twelve λN, the spacing 0.45 λN,
/// the quadrature from the largest phase that the window and the aberration put on the pupil's rim.
struct PsfOptions {
  int size = 0;
  double spacing_um = 0;
  int largest_size = 256;  ///< of a chosen size; a spot that needs more is cut, and `Psf::captured` tells
  int radial_nodes = 0, azimuths = 0;
};

/// \returns nothing when no ray of the field passes.
std::optional<PsfPlan> plan_psf(const FieldTracer& tracer, const ChiefRay& chief,
                                const PsfOptions& options = {});

/// The pupil of a field as plane waves at the sensor (METHODS: angle characteristic): real rays through the
/// vignetted pupil, β towards positive t, away from the axis.
std::optional<PupilWaves> pupil_waves(const FieldTracer& tracer, const ChiefRay& chief, int radial_nodes,
                                      int azimuths);

/// Plan, rays and sum in one. Nothing when no ray passes.
std::optional<Psf> point_spread(const FieldTracer& tracer, const ChiefRay& chief,
                                const PsfOptions& options = {});

}  // namespace petzval
