// SPDX-License-Identifier: BSD-3-Clause
// The rays of one field through its vignetted pupil, as nodes of a quadrature that knows where each of them
// crosses the stop.
#pragma once

#include <petzval/analysis/field_tracer.h>

#include <vector>

namespace petzval {

/// A ray at the image surface: of the half pupil u ≥ 0, or of the whole of a stop with blades. Its three
/// weights are the areas that it stands for, its mirror image's counted, so that sums over rays are integrals
/// over the pupil; rays on the rim have none.
struct PupilRay {
  double x_mm = 0, y_mm = 0;            ///< on the image surface, from the chief ray's point
  double alpha = 0, beta = 0;           ///< direction cosines along x and y
  double path_mm = 0;                   ///< optical path to the image surface, minus the chief ray's
  double stop_x_mm = 0, stop_y_mm = 0;  ///< where it crosses the stop
  double stop_area_mm2 = 0;             ///< on the real stop surface
  double entrance_measure = 0;     ///< du dv of Pencil, proportional to the light: mm² of the beam, or sr
  double exit_solid_angle_sr = 0;  ///< dα dβ
  bool mirrored = true;            ///< stands for its mirror image in x, too
};

struct PupilSampling {
  int radial_nodes = 20;
  int azimuths = 128;  ///< even, ≥ 8; corners of a vignetted pupil converge as 1/azimuths²
};

/// Gauss-Legendre in radius × uniform in azimuth inside the boundary of what passes (PupilBoundary), then the
/// rim with weights of zero. Areas on the stop and at the exit come from the Jacobian of real neighbouring
/// rays, so nothing is counted on a grid and no ray needs aiming. Empty where no ray passes.
std::vector<PupilRay> pupil_rays(const FieldTracer& tracer, const ChiefRay& chief,
                                 const PupilSampling& sampling = {});

/// The nodes alone, with `entrance_measure` as their only weight: for the light of a spot, at a fifth of the
/// cost.
std::vector<PupilRay> light_rays(const FieldTracer& tracer, const ChiefRay& chief,
                                 const PupilSampling& sampling = {});

/// `rings` rings of rays, the k-th of 6k, evenly over the entrance beam: points of a spot diagram. Rings are
/// the rim made smaller, and from ray to ray equal areas lie between them, however the beam is stretched.
/// Mirror symmetric, both halves, weights of zero, the chief ray not among them.
std::vector<PupilRay> ring_rays(const FieldTracer& tracer, const ChiefRay& chief, int rings);

/// n'² ∬ dα dβ over the exit cone [sr].
double exit_solid_angle_sr(const FieldTracer& tracer, const std::vector<PupilRay>& rays);

}  // namespace petzval
