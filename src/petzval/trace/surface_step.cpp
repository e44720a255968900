// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/trace/surface_step.h>

#include <cmath>

namespace petzval {

namespace {

using Prepared = Tracer::PreparedSurface;

/// Newton stops when the point lies this near to an asphere [mm]; a hundredth of the last digit that anybody
/// asks an optical path for.
constexpr double asphere_tolerance_mm = 1e-12;
constexpr int asphere_iterations = 60;

void advance(SurfaceRay& ray, double distance) {
  ray.x += distance * ray.l;
  ray.y += distance * ray.m;
  ray.z += distance * ray.n;
}

/// Signed distance to the conic c(x² + y² + (1+k)z²) = 2z, the root with sense·(direction·gradient) ≥ 0, in
/// the form that does not cancel. NaN when the ray misses.
double conic_distance(const Prepared& surface, double sense, const SurfaceRay& ray) {
  const double c = surface.curvature, q = 1 + surface.conic;
  const double f = c * (ray.x * ray.x + ray.y * ray.y + q * ray.z * ray.z) - 2 * ray.z;
  const double g = ray.n - c * (ray.l * ray.x + ray.m * ray.y + q * ray.n * ray.z);
  const double a = c * (1 + surface.conic * ray.n * ray.n);
  const double root = sense * std::sqrt(g * g - a * f);  // NaN below zero: a miss
  return g * root >= 0 ? f / (g + root) : (g - root) / a;
}

/// Sag and (dz/dr)/r at r; false beyond the conic's rim.
bool asphere_sag(const Prepared& surface, double r_sq, double& sag, double& slope_over_r) {
  const double c = surface.curvature;
  const double under = 1 - (1 + surface.conic) * c * c * r_sq;
  if (!(under > 0)) return false;
  const double root = std::sqrt(under), r = std::sqrt(r_sq);
  double value = 0, slope = 0;  // Horner for Σ a_p r^p and its derivative
  for (std::size_t p = surface.polynomial.size(); p-- > 0;) {
    slope = slope * r + value;
    value = value * r + surface.polynomial[p];
  }
  sag = c * r_sq / (1 + root) + value;
  slope_over_r = c / root + (r > 0 ? slope / r : 0.0);
  return true;
}

/// Newton along a ray that is already near the surface; the distance grows by what it walks.
bool polish_on_asphere(const Prepared& surface, double sense, SurfaceRay& ray, double& distance,
                       double normal[3]) {
  const SurfaceRay start = ray;
  double further = 0;
  for (int i = 0; i < asphere_iterations && std::isfinite(further); ++i) {
    ray = start;
    advance(ray, further);
    double sag, slope_over_r;
    if (!asphere_sag(surface, ray.x * ray.x + ray.y * ray.y, sag, slope_over_r)) return false;
    const double error = ray.z - sag;
    const double nx = -slope_over_r * ray.x, ny = -slope_over_r * ray.y;
    const double rate = ray.l * nx + ray.m * ny + ray.n;
    if (std::abs(error) < asphere_tolerance_mm) {
      const double scale = 1 / std::sqrt(nx * nx + ny * ny + 1);
      normal[0] = nx * scale;
      normal[1] = ny * scale;
      normal[2] = scale;
      distance += further;
      return sense * rate > 0;
    }
    further -= error / rate;
  }
  return false;
}

bool intersect_asphere(const Prepared& surface, double sense, SurfaceRay& ray, double& distance,
                       double normal[3]) {
  const SurfaceRay start = ray;
  const double from_conic = conic_distance(surface, sense, start);
  const double from_plane = -start.z / start.n;
  for (const double guess : {from_conic, from_plane}) {
    if (!std::isfinite(guess)) continue;
    // Newton starts from a point near the surface: a ray may come from so far that its whole distance has no
    // room for the last digits.
    ray = start;
    distance = guess;
    advance(ray, distance);
    if (polish_on_asphere(surface, sense, ray, distance, normal)) return true;
  }
  return false;
}

}  // namespace

bool intersect(const Prepared& surface, double sense, double index, SurfaceRay& ray, double normal[3]) {
  double distance;
  if (!surface.polynomial.empty()) {
    if (!intersect_asphere(surface, sense, ray, distance, normal)) return false;
  } else if (surface.curvature == 0) {
    if (!(sense * ray.n > 0)) return false;
    distance = -ray.z / ray.n;
    advance(ray, distance);
    ray.z = 0;
    normal[0] = normal[1] = 0;
    normal[2] = 1;
  } else {
    distance = conic_distance(surface, sense, ray);
    if (!std::isfinite(distance)) return false;
    advance(ray, distance);
    const double c = surface.curvature;
    const double nz = 1 - c * (1 + surface.conic) * ray.z;
    if (!(nz > 0)) return false;  // beyond the rim, on the sheet that the sag formula does not reach
    const double nx = -c * ray.x, ny = -c * ray.y;
    const double scale = 1 / std::sqrt(nx * nx + ny * ny + nz * nz);
    normal[0] = nx * scale;
    normal[1] = ny * scale;
    normal[2] = nz * scale;
    if (!(sense * (ray.l * normal[0] + ray.m * normal[1] + ray.n * normal[2]) > 0)) return false;
  }
  ray.opl += index * distance;
  return true;
}

bool refract(double ratio, double sense, SurfaceRay& ray, const double normal[3]) {
  if (ratio == 1) return true;
  const double cos_in = sense * (ray.l * normal[0] + ray.m * normal[1] + ray.n * normal[2]);
  const double under = 1 - ratio * ratio * (1 - cos_in * cos_in);
  if (under < 0) return false;
  const double bend = sense * (std::sqrt(under) - ratio * cos_in);
  ray.l = ratio * ray.l + bend * normal[0];
  ray.m = ratio * ray.m + bend * normal[1];
  ray.n = ratio * ray.n + bend * normal[2];
  return true;
}

}  // namespace petzval
