// SPDX-License-Identifier: BSD-3-Clause
// One surface, one ray: intersection and refraction. The arithmetic that all traces share.
#pragma once

#include <petzval/trace/tracer.h>

namespace petzval {

/// A ray relative to the vertex of the surface that it is about to meet.
struct SurfaceRay {
  double x, y, z;  ///< point [mm]
  double l, m, n;  ///< unit direction
  double opl;      ///< signed optical path so far [mm]
};

/// From axes of lens space into those of a surface off its place, and back.
inline void enter_frame(const Frame& frame, SurfaceRay& ray) {
  const auto& [ox, oy, oz] = frame.offset_mm;
  const Frame::Vector point = frame.from_lens({ray.x - ox, ray.y - oy, ray.z - oz});
  const Frame::Vector direction = frame.from_lens({ray.l, ray.m, ray.n});
  ray = {point[0], point[1], point[2], direction[0], direction[1], direction[2], ray.opl};
}
inline void leave_frame(const Frame& frame, SurfaceRay& ray) {
  const auto& [ox, oy, oz] = frame.offset_mm;
  const Frame::Vector point = frame.to_lens({ray.x, ray.y, ray.z});
  const Frame::Vector direction = frame.to_lens({ray.l, ray.m, ray.n});
  ray = {point[0] + ox, point[1] + oy, point[2] + oz, direction[0], direction[1], direction[2], ray.opl};
}

/// Carries the ray to the surface and writes the unit normal (on the +z side at the vertex). `sense` is +1
/// for light that travels from object to image and −1 for a backward trace: it picks the root at which the
/// ray crosses the surface in that sense, whatever the sign of its own z cosine. The path grows by `index`
/// times the signed distance. Returns false when there is no such point on the sheet through the vertex.
bool intersect(const Tracer::PreparedSurface& surface, double sense, double index, SurfaceRay& ray,
               double normal[3]);

/// Throws the ray back at a unit normal.
void reflect(SurfaceRay& ray, const double normal[3]);

/// Sends the ray into the order of a grating, or through an ideal lens, and adds their phase to the path;
/// false where the order is evanescent. \param bend  in the sense of travel.
bool bend(const BendData<double>& bend, double sense, SurfaceRay& ray, const double normal[3]);

/// Vector Snell at a unit normal; false on total internal reflection. `ratio` = n_before / n_after.
bool refract(double ratio, double sense, SurfaceRay& ray, const double normal[3]);

}  // namespace petzval
