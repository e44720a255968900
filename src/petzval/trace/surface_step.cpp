// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/trace/surface_step.h>

#include <petzval/lens/bend-inl.h>
#include <petzval/trace/surface_meet-inl.h>

#include <cmath>
#include <optional>

namespace petzval {

namespace {

// The arithmetic that vectors of rays have too.
using HWY_NAMESPACE::AddedKinds;
using HWY_NAMESPACE::advance_point;
using HWY_NAMESPACE::Approach;
using HWY_NAMESPACE::approach;
using HWY_NAMESPACE::ConicSurface;
using HWY_NAMESPACE::cross;
using HWY_NAMESPACE::distance_to_plane;
using HWY_NAMESPACE::KindList;
using HWY_NAMESPACE::Powers;
using Prepared = Tracer::PreparedSurface;
using Point = HWY_NAMESPACE::RayAt<double>;

/// Newton stops when the point lies this near to a surface [mm]; a hundredth of the last digit that anybody
/// asks an optical path for.
constexpr double newton_tolerance_mm = 1e-12;
constexpr int newton_iterations = 60;

/// A ray on its way to a surface, and what it finds there. z runs in the sense of travel.
struct Met {
  Point at;
  double distance;
  double gradient[3];
};

ConicSurface<double> conic_of(const Prepared& surface, double sense) {
  return {sense * surface.shape.curvature, surface.shape.conic, surface.shape.one_plus_conic};
}

HWY_INLINE bool meet_plane(double sense, Met& met) {
  if (!(met.at.n > 0)) return false;
  met.distance = distance_to_plane(met.at);
  advance_point(met.distance, met.at);
  met.at.z = met.gradient[0] = met.gradient[1] = sense * 0.0;  // zeros are positive in the lens
  met.gradient[2] = 1;
  return true;
}

template <bool is_conic>
HWY_INLINE bool meet_conic(const ConicSurface<double>& surface, Met& met) {
  Point& at = met.at;
  met.distance = cross<is_conic>(surface, at).distance;
  if (!std::isfinite(met.distance)) return false;
  advance_point(met.distance, at);
  const double c = surface.curvature, gx = -c * at.x, gy = -c * at.y;
  const double gz = HWY_NAMESPACE::gradient_z(c * surface.one_plus_conic, at.z);
  if (!(gz > 0)) return false;  // beyond the rim, on the sheet that the sag formula does not reach
  met.gradient[0] = gx;
  met.gradient[1] = gy;
  met.gradient[2] = gz;
  return at.l * gx + at.m * gy + at.n * gz > 0;
}

template <class Kind>
std::optional<Met> meet_iterated(const Prepared& surface, double sense, const Point& ray) {
  const ConicSurface<double> conic = conic_of(surface, sense);
  for (const double guess : {cross<true>(conic, ray).distance, distance_to_plane(ray)}) {
    if (!std::isfinite(guess)) continue;
    // Newton starts from a point near the surface: a ray may come from so far that its whole distance has no
    // room for the last digits.
    Point start = ray;
    advance_point(guess, start);
    Approach<double> to{0, 0, 0, 0, INFINITY};
    for (int i = 0; i < newton_iterations && to.error >= newton_tolerance_mm; ++i)
      approach<Kind, false>(surface.shape, sense, start, newton_tolerance_mm, to);
    if (!(to.error < newton_tolerance_mm && to.slope > 0)) continue;
    advance_point(to.distance, start);
    return Met{start, guess + to.distance, {to.gradient_x, to.gradient_y, 1}};
  }
  return {};
}

template <class... Kind>
std::optional<Met> meet_added(KindList<Kind...>, [[maybe_unused]] const Prepared& surface,
                              [[maybe_unused]] double sense, [[maybe_unused]] const Point& ray) {
  std::optional<Met> met;
  [[maybe_unused]] std::size_t i = 0;
  ((surface.shape.added == i++ ? void(met = meet_iterated<Kind>(surface, sense, ray)) : void()), ...);
  return met;
}

/// Of a kind without a closed form.
std::optional<Met> meet_by_newton(const Prepared& surface, double sense, const SurfaceRay& ray) {
  const Point from{ray.x, ray.y, sense * ray.z, ray.l, ray.m, sense * ray.n};
  if (surface.shape.form == ShapeForm::powers) return meet_iterated<Powers<false>>(surface, sense, from);
  return meet_added(AddedKinds(), surface, sense, from);
}

/// With a sense that the compiler knows.
template <bool backward>
bool intersect_in_sense(const Prepared& surface, double index, SurfaceRay& ray, double normal[3]) {
  constexpr double sense = backward ? -1 : 1;
  Met met{{ray.x, ray.y, sense * ray.z, ray.l, ray.m, sense * ray.n}, 0, {}};
  if (surface.shape.is_iterated()) {
    const auto found = meet_by_newton(surface, sense, ray);
    if (!found) return false;
    met = *found;
  } else if (!(surface.shape.form == ShapeForm::plane    ? meet_plane(sense, met)
               : surface.shape.form == ShapeForm::sphere ? meet_conic<false>(conic_of(surface, sense), met)
                                                         : meet_conic<true>(conic_of(surface, sense), met))) {
    return false;
  }
  ray.x = met.at.x;
  ray.y = met.at.y;
  ray.z = sense * met.at.z;
  ray.opl += index * met.distance;
  const auto [gx, gy, gz] = met.gradient;
  const double scale = 1 / std::sqrt(gx * gx + gy * gy + gz * gz);
  normal[0] = sense * gx * scale;
  normal[1] = sense * gy * scale;
  normal[2] = gz * scale;
  return true;
}

}  // namespace

bool intersect(const Prepared& surface, double sense, double index, SurfaceRay& ray, double normal[3]) {
  return sense < 0 ? intersect_in_sense<true>(surface, index, ray, normal)
                   : intersect_in_sense<false>(surface, index, ray, normal);
}

void reflect(SurfaceRay& ray, const double normal[3]) {
  const double twice = 2 * (ray.l * normal[0] + ray.m * normal[1] + ray.n * normal[2]);
  ray.l -= twice * normal[0];
  ray.m -= twice * normal[1];
  ray.n -= twice * normal[2];
}

bool bend(const BendData<double>& bend, double sense, SurfaceRay& ray, const double normal[3]) {
  HWY_NAMESPACE::BentRay<double> bent{
      ray.x, ray.y, sense * normal[0], sense * normal[1], normal[2], ray.l, ray.m, sense * ray.n, 0};
  HWY_NAMESPACE::bend(bend, bent);
  const double turn = bend.mirror ? -1 : 1;
  ray.l = turn * bent.l, ray.m = turn * bent.m, ray.n = turn * sense * bent.n;
  ray.opl += bent.path;
  return std::isfinite(ray.n);
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
