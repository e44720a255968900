// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/render/camera/lamp_guide.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

/// Ellipses are this much larger than the lamp, and by the error of the polynomials twice over.
constexpr double rim_margin = 1.05, error_margin = 2;
/// Larger ones find the lamp too seldom to be worth it.
constexpr double most_larger = 6;
/// An image of the lamp that is wider than the light of its middle by more is seen through all of the pupil.
constexpr double most_wider = 3;

/// A light ray on the film.
struct Landed {
  double x_mm, y_mm, alpha, beta;
};

/// A part of the plane of the first vertex that rays are sent through.
struct Window {
  double left, right, bottom, top;
};

/// Light of one point through one lens.
class PointOfLight {
 public:
  PointOfLight(const Tracer& tracer, Vector3 at_mm) : tracer_(tracer), at_mm_(at_mm) {}

  /// The rays of a grid over a window that reach the film, and the window that holds them.
  std::vector<Landed> through(const Window& window, Window* passed = nullptr) const {
    constexpr int side = 32;
    RayBatch rays;
    std::vector<std::array<double, 2>> aims;
    for (int i = 0; i < side * side; ++i) {
      const double x = window.left + (window.right - window.left) * (i % side + 0.5) / side;
      const double y = window.bottom + (window.top - window.bottom) * (i / side + 0.5) / side;
      const Vector3 along = normalised(Vector3{x, y, 0} - at_mm_);
      if (!(along.z > 0)) continue;
      aims.push_back({x, y});
      rays.push_back(at_mm_.x, at_mm_.y, at_mm_.z, along.x, along.y, along.z);
    }
    tracer_.trace(rays);
    std::vector<Landed> landed;
    Window hit{window.right, window.left, window.top, window.bottom};
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (rays.status[i] != RayStatus::ok) continue;
      landed.push_back({rays.x_mm[i], rays.y_mm[i], rays.l[i], rays.m[i]});
      hit = {std::min(hit.left, aims[i][0]), std::max(hit.right, aims[i][0]),
             std::min(hit.bottom, aims[i][1]), std::max(hit.top, aims[i][1])};
    }
    if (passed && !landed.empty()) {
      const double dx = (window.right - window.left) / side, dy = (window.top - window.bottom) / side;
      *passed = {hit.left - dx, hit.right + dx, hit.bottom - dy, hit.top + dy};
    }
    return landed;
  }

 private:
  const Tracer& tracer_;
  Vector3 at_mm_;
};

/// Through which part of the first surface the lamp is seen.
std::optional<Window> window_of(const PointOfLight& lamp, const Tracer& tracer) {
  const double clear = std::sqrt(tracer.clip_radius_sq(0, Tracer::Clip::apertures));
  const double reach = std::isfinite(clear) ? clear : 10 * tracer.stop_radius_mm();
  Window window{-reach, reach, -reach, reach};
  constexpr int zooms = 2;
  for (int zoom = 0; zoom < zooms; ++zoom)
    if (lamp.through(Window(window), &window).empty()) return {};
  return window;
}

}  // namespace

LampDisk::Terms LampDisk::terms(double x_mm, double y_mm) const {
  const double x = (x_mm - x_mm_) / radius_mm_, y = (y_mm - y_mm_) / radius_mm_;
  return {1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y};
}

LampDisk::Ellipse LampDisk::ellipse(double x_mm, double y_mm) const {
  const Terms at = terms(x_mm, y_mm);
  std::array<double, 6> sums{};
  for (std::size_t k = 0; k < sums.size(); ++k)
    for (std::size_t i = 0; i < at.size(); ++i) sums[k] += numbers_[k][i] * at[i];
  return {sums[0], sums[1], sums[2], sums[3], sums[4], sums[5]};
}

std::array<double, 2> LampDisk::Ellipse::within(double towards_alpha, double towards_beta) const {
  const double det = determinant(), da = towards_alpha - alpha, db = towards_beta - beta;
  return {(d * da - b * db) / det, (a * db - c * da) / det};
}

/// What is known of a lamp's light while its disk is being found.
class LampDisk::Fit {
 public:
  Fit(const Lamp& lamp, std::span<const Tracer> tracers, const LensPlace& place)
      : lamp_(lamp), tracers_(tracers), place_(place), across_(normalised(lamp.centre)) {}

  std::optional<LampDisk> disk() {
    const Tracer& tracer = tracers_.front();
    const std::optional<Window> window = window_of(PointOfLight(tracer, place_of(0, 0)), tracer);
    if (!window) return {};
    window_ = *window;
    const std::vector<Landed> rays = light_of(tracer, 0, 0);
    if (!place_disk(rays)) return {};
    const auto middle = fitted(rays), right = fitted(light_of(tracer, 1, 0)),
               up = fitted(light_of(tracer, 0, 1));
    if (!right || !up) return {};
    disk_.numbers_[0] = (*middle)[0], disk_.numbers_[1] = (*middle)[1];
    for (std::size_t i = 0; i < Terms().size(); ++i)
      for (std::size_t k = 0; k < 2; ++k) {
        disk_.numbers_[2 + 2 * k][i] = (*right)[k][i] - (*middle)[k][i];
        disk_.numbers_[3 + 2 * k][i] = (*up)[k][i] - (*middle)[k][i];
      }
    const double larger = rim_margin + error_margin * worst_error();
    if (!(larger < most_larger)) return {};
    for (std::size_t k = 2; k < disk_.numbers_.size(); ++k)
      for (double& each : disk_.numbers_[k]) each *= larger;
    return disk_;
  }

 private:
  /// A point of the lamp across the line of sight, in radii, in the space of the lens [mm].
  Vector3 place_of(double right, double up) const {
    const Vector3 p = lamp_.centre + lamp_.radius * (right * across_.x + up * across_.y);
    const double unit = place_.scene_units_per_mm;
    return {p.x / unit, p.y / unit, place_.origin_z_mm - p.z / unit};
  }
  std::vector<Landed> light_of(const Tracer& tracer, double right, double up) const {
    return PointOfLight(tracer, place_of(right, up)).through(window_);
  }

  bool place_disk(const std::vector<Landed>& rays) {
    if (rays.size() < fewest_rays) return false;
    for (const Landed& ray : rays)
      disk_.x_mm_ += ray.x_mm / static_cast<double>(rays.size()),
          disk_.y_mm_ += ray.y_mm / static_cast<double>(rays.size());
    for (const Landed& ray : rays) disk_.radius_mm_ = std::max(disk_.radius_mm_, from_middle_mm(ray));
    disk_.reach_mm_ = disk_.radius_mm_;
    // The rim's light lands beyond that of the middle.
    for (const auto& [right, up] : {std::pair{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}})
      for (const Landed& ray : light_of(tracers_.front(), right, up))
        disk_.reach_mm_ = std::max(disk_.reach_mm_, from_middle_mm(ray));
    return disk_.reach_mm_ < most_wider * disk_.radius_mm_;
  }
  double from_middle_mm(const Landed& ray) const {
    return std::hypot(ray.x_mm - disk_.x_mm_, ray.y_mm - disk_.y_mm_);
  }

  /// Directions by place, in the least squares of all rays.
  std::optional<std::array<Terms, 2>> fitted(const std::vector<Landed>& rays) const {
    if (rays.size() < fewest_rays) return {};
    const auto count = static_cast<Eigen::Index>(rays.size());
    Eigen::MatrixXd matrix(count, 10), values(count, 2);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Landed& ray = rays[static_cast<std::size_t>(i)];
      const Terms at = disk_.terms(ray.x_mm, ray.y_mm);
      for (Eigen::Index k = 0; k < 10; ++k) matrix(i, k) = at[static_cast<std::size_t>(k)];
      values(i, 0) = ray.alpha, values(i, 1) = ray.beta;
    }
    const Eigen::MatrixXd solved = matrix.colPivHouseholderQr().solve(values);
    std::array<Terms, 2> result;
    for (Eigen::Index k = 0; k < 10; ++k)
      for (Eigen::Index axis = 0; axis < 2; ++axis)
        result[static_cast<std::size_t>(axis)][static_cast<std::size_t>(k)] = solved(k, axis);
    return result;
  }

  /// By how many radii of the lamp its light misses the place in its ellipse, in every colour and on the rim.
  double worst_error() const {
    double worst = 0;
    const auto compare = [&](const Tracer& tracer, double right, double up) {
      for (const Landed& ray : light_of(tracer, right, up)) {
        const auto [s, t] = disk_.ellipse(ray.x_mm, ray.y_mm).within(ray.alpha, ray.beta);
        const double error = std::hypot(s - right, t - up);
        worst = std::isfinite(error) ? std::max(worst, error) : most_larger;
      }
    };
    for (const Tracer& tracer : tracers_) compare(tracer, 0, 0);
    compare(tracers_.front(), -1, 0), compare(tracers_.front(), 0, -1);
    return worst;
  }

  static constexpr std::size_t fewest_rays = 40;
  const Lamp& lamp_;
  std::span<const Tracer> tracers_;
  const LensPlace& place_;
  Frame across_;
  Window window_{};
  LampDisk disk_;
};

std::optional<LampDisk> LampDisk::find(const Lamp& lamp, std::span<const Tracer> tracers,
                                       const LensPlace& place) {
  return Fit(lamp, tracers, place).disk();
}

double LampDisk::area_sr() const {
  return pi * std::abs(ellipse(x_mm_, y_mm_).determinant());
}

bool LampDisk::reaches(double x_mm, double y_mm) const {
  const double x = x_mm - x_mm_, y = y_mm - y_mm_;
  return x * x + y * y <= reach_mm_ * reach_mm_;
}

std::array<double, 2> LampDisk::direction(double x_mm, double y_mm, double s, double t) const {
  const Ellipse e = ellipse(x_mm, y_mm);
  return {e.alpha + e.a * s + e.b * t, e.beta + e.c * s + e.d * t};
}

double LampDisk::density_per_sr(double x_mm, double y_mm, double alpha, double beta) const {
  const Ellipse e = ellipse(x_mm, y_mm);
  const auto [s, t] = e.within(alpha, beta);
  return s * s + t * t <= 1 ? 1 / (pi * std::abs(e.determinant())) : 0;
}

}  // namespace petzval::render
