// SPDX-License-Identifier: BSD-3-Clause
// The batch trace through spheres, conics and planes on whatever SIMD the machine has: lanes are rays.
#pragma once

#include <petzval/trace/ray_batch.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace petzval {

/// One surface in the order of travel, with everything that does not depend on the ray worked out.
struct KernelSurface {
  double curvature, conic;
  double to_vertex_mm;     ///< added to z on arrival: the previous vertex minus this one
  double index_before;     ///< on the side the ray comes from
  double index_ratio;      ///< before / behind
  double clear_radius_sq;  ///< infinity: no clipping
};

struct KernelPath {
  std::vector<KernelSurface> surfaces;
  double first_vertex_z_mm = 0;
  double last_vertex_z_mm = 0;
  double sense = 1;      ///< +1 forward, −1 backward
  bool to_image = true;  ///< carry on to the image plane
  double image_z_mm = 0, image_index = 1;
};

/// Traces rays [0, rays.size()) in place and sets clean[i] = 1. Rays that fail, are clipped, or would need
/// the other form of the quadratic are left untouched with clean[i] = 0: the scalar trace deals with them and
/// says why.
void trace_batch_simd(const KernelPath& path, RayBatch& rays, std::vector<std::uint8_t>& clean);

}  // namespace petzval
