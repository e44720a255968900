// SPDX-License-Identifier: BSD-3-Clause
// A second ray tracer, written apart from the first: in long double, a sphere by its centre and a quadratic,
// an asphere by bisection on its sag and a normal from differences. A pose is a list of elementary moves of
// points in space. It shares no line with src/petzval/trace.
#pragma once

#include <petzval/lens/lens.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace petzval::independent {

using Real = long double;
using Vec = std::array<Real, 3>;

inline Real dot(const Vec& a, const Vec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec along(const Vec& p, const Vec& d, Real t) {
  return {p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]};
}
inline Vec unit(const Vec& a) {
  const Real norm = std::sqrt(dot(a, a));
  return {a[0] / norm, a[1] / norm, a[2] / norm};
}

struct IndependentRay {
  Vec point, direction;
  Real path = 0;
};

/// One elementary move: a shift along an axis, or a turn about a line through `pivot` along it.
struct Move {
  int axis;
  bool turn;
  Real amount;  ///< [mm] or [rad]
  Vec pivot{};

  void point(Vec& p, Real sign) const {
    if (!turn) {
      p[axis] += sign * amount;
      return;
    }
    for (int a = 0; a < 3; ++a) p[a] -= pivot[a];
    direction(p, sign);
    for (int a = 0; a < 3; ++a) p[a] += pivot[a];
  }
  void direction(Vec& d, Real sign) const {
    if (!turn) return;
    Real& first = d[(axis + 1) % 3];
    Real& second = d[(axis + 2) % 3];
    const Real c = std::cos(amount), s = sign * std::sin(amount), before = first;
    first = c * before - s * second;
    second = s * before + c * second;
  }
};

/// What brings something from its place in the prescription to where it stands. Turns about axes that turn
/// along, x, y, z in turn, are turns about fixed axes in the opposite order.
inline void append_moves(const Pose& pose, Real pivot_z, std::vector<Move>& moves) {
  const Real degree = std::acos(Real(-1)) / 180;
  const Vec pivot{0, 0, pivot_z};
  moves.push_back({2, true, pose.tilt_z_deg * degree, pivot});
  moves.push_back({1, true, pose.tilt_y_deg * degree, pivot});
  moves.push_back({0, true, pose.tilt_x_deg * degree, pivot});
  moves.push_back({0, false, pose.decentre_x_mm});
  moves.push_back({1, false, pose.decentre_y_mm});
  moves.push_back({2, false, pose.shift_z_mm});
}

/// Of every surface, and of the sensor last.
inline std::vector<std::vector<Move>> moves_of(const Lens& lens) {
  std::vector<std::vector<Move>> all(lens.surfaces.size() + 1);
  std::vector<Real> z{0};
  for (const Surface& s : lens.surfaces) z.push_back(z.back() + s.thickness_mm);
  for (std::size_t i = 0; i < all.size(); ++i)
    append_moves(i < lens.surfaces.size() ? lens.surfaces[i].pose : lens.sensor_pose, z[i], all[i]);
  for (const SurfaceGroup& group : lens.groups)
    for (std::size_t i = group.first; i <= group.last; ++i)
      append_moves(group.pose, z[group.first] + group.pivot_mm, all[i]);
  return all;
}

inline void go_into(const std::vector<Move>& moves, IndependentRay& ray) {
  for (auto move = moves.rbegin(); move != moves.rend(); ++move)
    move->point(ray.point, -1), move->direction(ray.direction, -1);
}
inline void come_out(const std::vector<Move>& moves, IndependentRay& ray) {
  for (const Move& move : moves) move.point(ray.point, 1), move.direction(ray.direction, 1);
}

class SphereTracer {
 public:
  SphereTracer(const Lens& lens, double wavelength_nm, Real stop_radius) {
    Real z = 0;
    for (const Surface& s : lens.surfaces) {
      Real clear = s.semi_diameter_mm ? Real(*s.semi_diameter_mm) : Real(1e30);
      if (s.stop) clear = std::min(clear, stop_radius);
      surfaces_.push_back({z, s.curvature_per_mm == 0 ? Real(0) : 1 / Real(s.curvature_per_mm),
                           Real(s.material.index(wavelength_nm)), clear, s.conic, s.asphere});
      z += s.thickness_mm;
    }
    image_z_ = z;
    if (has_poses(lens)) moves_ = moves_of(lens);
  }

  Real image_z() const { return image_z_; }

  /// Through all surfaces in the direction of travel; nothing when it misses, is clipped or totally
  /// reflected. With poses, rays behind the lens are in the axes of the sensor at image_z().
  std::optional<IndependentRay> trace(IndependentRay ray, bool backward, bool clip = true) const {
    const std::size_t count = surfaces_.size();
    if (backward && !moves_.empty()) come_out(moves_.back(), ray);
    for (std::size_t step = 0; step < count; ++step) {
      const std::size_t i = backward ? count - 1 - step : step;
      const Real before_surface = i == 0 ? Real(1) : surfaces_[i - 1].index_after;
      const Real n1 = backward ? surfaces_[i].index_after : before_surface;
      const Real n2 = backward ? before_surface : surfaces_[i].index_after;
      if (!moves_.empty()) go_into(moves_[i], ray);
      if (!meet(surfaces_[i], n1, ray)) return {};
      if (clip &&
          ray.point[0] * ray.point[0] + ray.point[1] * ray.point[1] > surfaces_[i].clear * surfaces_[i].clear)
        return {};
      if (!bend(surfaces_[i], n1, n2, ray)) return {};
      if (!moves_.empty()) come_out(moves_[i], ray);
    }
    if (!backward && !moves_.empty()) go_into(moves_.back(), ray);
    return ray;
  }

 private:
  struct Sphere {
    Real z, radius, index_after, clear, conic;
    std::map<int, double> powers;

    bool aspheric() const { return conic != 0 || !powers.empty(); }
    Real sag(Real r) const {
      Real z_of_r = 0;
      if (radius != 0)
        z_of_r = r * r / (radius * (1 + std::sqrt(1 - (1 + conic) * r * r / (radius * radius))));
      for (const auto& [power, coefficient] : powers) {
        Real term = coefficient;
        for (int i = 0; i < power; ++i) term *= r;
        z_of_r += term;
      }
      return z_of_r;
    }
    /// Differences over h and h/2, extrapolated: the error is of order h⁴.
    Real slope(Real r) const {
      const Real h = 1e-4L;
      const auto difference = [&](Real step) {
        return (sag(std::abs(r + step)) - sag(std::abs(r - step))) / (2 * step);
      };
      return (4 * difference(h / 2) - difference(h)) / 3;
    }
  };

  /// How far the ray at t is behind an aspheric surface.
  static Real behind(const Sphere& s, const IndependentRay& ray, Real t) {
    const Vec p = along(ray.point, ray.direction, t);
    return p[2] - s.z - s.sag(std::hypot(p[0], p[1]));
  }
  static bool meet_asphere(const Sphere& s, Real index, IndependentRay& ray) {
    const Real plane = (s.z - ray.point[2]) / ray.direction[2];
    for (Real reach = 1e-3L; reach < 20; reach *= 2) {
      Real low = plane - reach, high = plane + reach;
      const Real at_low = behind(s, ray, low), at_high = behind(s, ray, high);
      if (!std::isfinite(at_low) || !std::isfinite(at_high) || (at_low < 0) == (at_high < 0)) continue;
      for (int i = 0; i < 70; ++i) {
        const Real middle = (low + high) / 2;
        ((behind(s, ray, middle) < 0) == (at_low < 0) ? low : high) = middle;
      }
      ray.point = along(ray.point, ray.direction, low);
      ray.path += index * low;
      return true;
    }
    return false;
  }

  static bool meet(const Sphere& s, Real index, IndependentRay& ray) {
    if (s.aspheric()) return meet_asphere(s, index, ray);
    Real t;
    if (s.radius == 0) {
      t = (s.z - ray.point[2]) / ray.direction[2];
    } else {
      const Vec from_centre = {ray.point[0], ray.point[1], ray.point[2] - (s.z + s.radius)};
      const Real b = dot(from_centre, ray.direction), c = dot(from_centre, from_centre) - s.radius * s.radius;
      const Real under = b * b - c;
      if (under < 0) return false;
      const Real t1 = -b - std::sqrt(under), t2 = -b + std::sqrt(under);
      // The crossing on the vertex's half of the sphere, on the side of the centre where the vertex is.
      const Real z1 = ray.point[2] + t1 * ray.direction[2], z2 = ray.point[2] + t2 * ray.direction[2];
      t = std::abs(z1 - s.z) < std::abs(z2 - s.z) ? t1 : t2;
    }
    ray.point = along(ray.point, ray.direction, t);
    ray.path += index * t;
    return true;
  }

  static bool bend(const Sphere& s, Real n1, Real n2, IndependentRay& ray) {
    Vec normal = {0, 0, 1};
    if (const Real r = std::hypot(ray.point[0], ray.point[1]); s.aspheric() && r > 0)
      normal = unit({-s.slope(r) * ray.point[0] / r, -s.slope(r) * ray.point[1] / r, 1});
    else if (s.radius != 0 && !s.aspheric())
      normal = unit({ray.point[0], ray.point[1], ray.point[2] - (s.z + s.radius)});
    // Cross-product form: the tangential part of n·d is kept.
    const Real cosine = dot(ray.direction, normal);
    Vec tangential;
    for (int a = 0; a < 3; ++a) tangential[a] = (ray.direction[a] - cosine * normal[a]) * n1 / n2;
    const Real sine_sq = dot(tangential, tangential);
    if (sine_sq > 1) return false;
    const Real out = std::copysign(std::sqrt(1 - sine_sq), cosine);
    for (int a = 0; a < 3; ++a) ray.direction[a] = tangential[a] + out * normal[a];
    return true;
  }

  std::vector<Sphere> surfaces_;
  std::vector<std::vector<Move>> moves_;  ///< none: no poses
  Real image_z_ = 0;
};

}  // namespace petzval::independent
