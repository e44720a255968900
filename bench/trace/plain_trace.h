// SPDX-License-Identifier: BSD-3-Clause
// The baseline that the SIMD batches are measured against: a sphere tracer as one writes it first, ray after
// ray, surface after surface, compiled with -O2.
#pragma once

#include <vector>

namespace plain {

template <class T>
struct Surface {
  T curvature, thickness, index_ratio, clear_radius;
};

template <class T>
struct Ray {
  T x, y, z, l, m, n;
};

/// To the vertex plane of the last surface plus its thickness; false for a ray that misses, is clipped or
/// totally reflected.
template <class T>
bool trace(const std::vector<Surface<T>>& surfaces, Ray<T>& ray);

}  // namespace plain
