// SPDX-License-Identifier: BSD-3-Clause
#include "plain_trace.h"

#include <cmath>

namespace plain {

template <class T>
bool trace(const std::vector<Surface<T>>& surfaces, Ray<T>& ray) {
  for (const Surface<T>& surface : surfaces) {
    T distance, normal_x = 0, normal_y = 0, normal_z = 1;
    const T c = surface.curvature;
    if (c == 0) {
      distance = -ray.z / ray.n;
    } else {
      const T f = c * (ray.x * ray.x + ray.y * ray.y + ray.z * ray.z) - 2 * ray.z;
      const T g = ray.n - c * (ray.l * ray.x + ray.m * ray.y + ray.n * ray.z);
      const T under = g * g - c * f;
      if (under < 0) return false;
      distance = f / (g + std::sqrt(under));
    }
    ray.x += distance * ray.l;
    ray.y += distance * ray.m;
    ray.z += distance * ray.n;
    if (ray.x * ray.x + ray.y * ray.y > surface.clear_radius * surface.clear_radius) return false;
    if (c != 0) {
      normal_x = -c * ray.x;
      normal_y = -c * ray.y;
      normal_z = 1 - c * ray.z;
    }
    const T e = surface.index_ratio;
    const T cosine = ray.l * normal_x + ray.m * normal_y + ray.n * normal_z;
    const T transmitted_sq = 1 - e * e * (1 - cosine * cosine);
    if (transmitted_sq < 0) return false;
    const T bend = std::sqrt(transmitted_sq) - e * cosine;
    ray.l = e * ray.l + bend * normal_x;
    ray.m = e * ray.m + bend * normal_y;
    ray.n = e * ray.n + bend * normal_z;
    ray.z -= surface.thickness;
  }
  const T distance = -ray.z / ray.n;
  ray.x += distance * ray.l;
  ray.y += distance * ray.m;
  ray.z = 0;
  return true;
}

template bool trace(const std::vector<Surface<float>>& surfaces, Ray<float>& ray);
template bool trace(const std::vector<Surface<double>>& surfaces, Ray<double>& ray);

}  // namespace plain
