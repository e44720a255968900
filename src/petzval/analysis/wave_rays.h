// SPDX-License-Identifier: BSD-3-Clause
// Rays of a pupil as the plane waves that they stand for at the image point.
#pragma once

#include <petzval/analysis/field_tracer.h>

#include <vector>

namespace petzval {

/// One node of a pupil at the image surface, in the directions s and t of Psf.
struct WaveRay {
  double alpha = 0, beta = 0;  ///< exit direction cosines, β towards positive t
  double phase_waves = 0;      ///< φ of PupilWaves
  double amplitude = 0;        ///< a = √(T dq/(dα dβ)), from the ray's real neighbours
  double transmittance = 1;    ///< T, of the losses that the tracer counts
  double s_mm = 0, t_mm = 0;   ///< on the image surface, from the chief ray's point
  bool passes = false;         ///< reached the image; apertures are not asked
};

/// Traces all nodes of a boundary, or any others of the same pencil, each with two neighbours.
std::vector<WaveRay> trace_wave_rays(const FieldTracer& tracer, const ChiefRay& chief,
                                     const PupilBoundary& pupil, const std::vector<PupilNode>& nodes);

}  // namespace petzval
