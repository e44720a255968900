// SPDX-License-Identifier: BSD-3-Clause
// A second way to the light of ghosts, written without the code that it tests: photons that every surface
// of a lens reflects or lets through at random.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

namespace petzval::test {

/// Spheres and planes, each a circle that lets light pass, decentred if its pose or a group says so; the stop
/// a circle or a polygon. Bare glass.
class ReflectingLens {
 public:
  using V = std::array<double, 3>;

  ReflectingLens(const Lens& lens, double wavelength_nm) {
    double z = 0;
    index_.push_back(1);
    for (const Surface& surface : lens.surfaces) {
      vertex_.push_back(z);
      curvature_.push_back(surface.curvature_per_mm);
      clear_.push_back(surface.semi_diameter_mm.value_or(INFINITY));
      index_.push_back(surface.material.index(wavelength_nm));
      shift_.push_back({surface.pose.decentre_x_mm, surface.pose.decentre_y_mm});
      z += surface.thickness_mm;
    }
    for (const SurfaceGroup& group : lens.groups)
      for (std::size_t i = group.first; i <= group.last && i < shift_.size(); ++i) {
        shift_[i][0] += group.pose.decentre_x_mm;
        shift_[i][1] += group.pose.decentre_y_mm;
      }
    image_z_ = z;
    stop_ = lens.stop_index();
    blades_ = lens.stop_blades();
    stop_radius_ = stop_radius_mm(lens);
  }

  std::size_t count() const { return vertex_.size(); }

  struct Photon {
    V at{}, along{}, field{};  ///< the field is unit and across
  };
  /// Where it meets surface i, and the normal there; nothing where it misses.
  bool go_to(std::size_t i, V& at, const V& along, V& normal) const {
    const double c = curvature_[i], to_plane = (vertex_[i] - at[2]) / along[2];
    V p{at[0] + to_plane * along[0] - shift_[i][0], at[1] + to_plane * along[1] - shift_[i][1], 0};
    // c (x² + y² + z²) = 2 z from the vertex plane.
    const double b = along[2] - c * (p[0] * along[0] + p[1] * along[1]), q = c * (p[0] * p[0] + p[1] * p[1]);
    const double root = b * b - c * q;
    if (root < 0) return false;
    const double t = q / (b + std::copysign(std::sqrt(root), along[2]));
    for (int k = 0; k < 3; ++k) p[k] += t * along[k];
    normal = {-c * p[0], -c * p[1], 1 - c * p[2]};
    if (!(normal[2] > 0)) return false;
    at = {p[0] + shift_[i][0], p[1] + shift_[i][1], p[2] + vertex_[i]};
    return true;
  }
  bool is_open(std::size_t i, double at_x, double at_y) const {
    const double x = at_x - shift_[i][0], y = at_y - shift_[i][1];
    if (std::hypot(x, y) > clear_[i]) return false;
    if (i != stop_) return true;
    if (blades_.count == 0) return std::hypot(x, y) <= stop_radius_;
    // A regular polygon with a corner at the top, turned anticlockwise as seen from the film (x to the
    // right).
    const double step = 2 * std::numbers::pi / blades_.count;
    const double azimuth = std::atan2(-x, y) - blades_.rotation_deg * std::numbers::pi / 180;
    const double from_middle = std::remainder(azimuth - step / 2, step);
    return std::hypot(x, y) * std::cos(from_middle) <= stop_radius_ * std::cos(step / 2);
  }

  struct End {
    std::array<std::size_t, 4> turned;
    double x_mm, y_mm;
  };
  /// Follows one photon that is reflected so often, at most four times; nothing for all others.
  template <class Random>
  std::optional<End> follow(Photon photon, Random& random, int wanted = 2) const {
    std::uniform_real_distribution<double> even(0, 1);
    int reflections = 0;
    std::array<std::size_t, 4> turned{};
    std::size_t next = 0;
    bool forward = true;
    while (true) {
      if (forward && next == count()) break;
      V normal;
      if (!go_to(next, photon.at, photon.along, normal)) return {};
      if (!is_open(next, photon.at[0], photon.at[1])) return {};
      const double n1 = forward ? index_[next] : index_[next + 1],
                   n2 = forward ? index_[next + 1] : index_[next];
      if (meet(n1, n2, normal, photon, even(random))) {
        if (reflections == wanted) return {};
        turned[static_cast<std::size_t>(reflections++)] = next;
        forward = !forward;
      }
      if (forward)
        ++next;
      else if (next-- == 0)
        return {};
    }
    if (reflections != wanted) return {};
    const double t = (image_z_ - photon.at[2]) / photon.along[2];
    return End{turned, photon.at[0] + t * photon.along[0], photon.at[1] + t * photon.along[1]};
  }

  /// Without chance: reflected at the two surfaces of a pair. \return the place on the sensor.
  std::optional<std::array<double, 2>> along_pair(V at, V along, std::size_t first,
                                                  std::size_t second) const {
    std::size_t next = 0;
    bool forward = true;
    int turns = 0;
    while (next < count()) {
      V normal;
      if (!go_to(next, at, along, normal)) return {};
      const double n1 = forward ? index_[next] : index_[next + 1],
                   n2 = forward ? index_[next + 1] : index_[next];
      const bool turn = (turns == 0 && next == first) || (turns == 1 && next == second && !forward);
      const double length = std::sqrt(dot(normal, normal));
      for (double& each : normal) each /= length;
      const double cosine = dot(along, normal);
      if (turn) {
        for (int k = 0; k < 3; ++k) along[k] -= 2 * cosine * normal[k];
        forward = !forward;
        ++turns;
      } else {
        const double r = n1 / n2, under = 1 - r * r * (1 - cosine * cosine);
        if (under < 0) return {};
        const double bend = std::copysign(std::sqrt(under), cosine) - r * cosine;
        for (int k = 0; k < 3; ++k) along[k] = r * along[k] + bend * normal[k];
      }
      if (forward)
        ++next;
      else
        --next;
    }
    const double t = (image_z_ - at[2]) / along[2];
    return std::array{at[0] + t * along[0], at[1] + t * along[1]};
  }

 private:
  static double dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  static V cross(const V& a, const V& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }

  /// Turns the photon back or lets it through, as its polarisation has it. \return whether it is turned.
  static bool meet(double n1, double n2, V normal, Photon& photon, double chance) {
    if (n1 == n2) return false;
    const double length = std::sqrt(dot(normal, normal));
    double cosine = dot(photon.along, normal) / length;
    const double sign = cosine < 0 ? -1 : 1;
    for (double& each : normal) each *= sign / length;
    cosine *= sign;
    V s = cross(photon.along, normal);
    const double sine = std::sqrt(dot(s, s));
    if (sine < 1e-9)
      s = photon.field;
    else
      for (double& each : s) each /= sine;
    const V p = cross(s, photon.along);
    const double field_s = dot(photon.field, s), field_p = dot(photon.field, p);
    const double r = n1 / n2, under = 1 - r * r * (1 - cosine * cosine);
    double rs = 1, rp = 1, cosine_2 = 0;
    if (under > 0) {
      cosine_2 = std::sqrt(under);
      rs = (n1 * cosine - n2 * cosine_2) / (n1 * cosine + n2 * cosine_2);
      rp = (n2 * cosine - n1 * cosine_2) / (n2 * cosine + n1 * cosine_2);
    }
    const double back = rs * rs * field_s * field_s + rp * rp * field_p * field_p;
    const bool turns = chance < back;
    if (turns) {
      for (int k = 0; k < 3; ++k) photon.along[k] -= 2 * cosine * normal[k];
    } else {
      for (int k = 0; k < 3; ++k) photon.along[k] = r * photon.along[k] + (cosine_2 - r * cosine) * normal[k];
      rs = std::sqrt(1 - rs * rs);
      rp = std::sqrt(1 - rp * rp);
    }
    const V p_after = cross(s, photon.along);
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      photon.field[k] = rs * field_s * s[k] + rp * field_p * p_after[k];
      square += photon.field[k] * photon.field[k];
    }
    for (double& each : photon.field) each /= std::sqrt(square);
    return turns;
  }

  std::vector<double> vertex_, curvature_, clear_, index_;
  std::vector<std::array<double, 2>> shift_;
  double image_z_ = 0, stop_radius_ = 0;
  std::size_t stop_ = 0;
  StopBlades blades_;
};

}  // namespace petzval::test
