// SPDX-License-Identifier: BSD-3-Clause
// Distances along a ray, for what a lamp beside it lights.
#pragma once

#include <petzval/render/media/phase_function.h>

#include <array>

namespace petzval::render {

/// How much a medium scatters on along a ray of the light that comes from a lamp beside it, by the angle at
/// which the lamp sees the place: −π/2 on the ray's far past, 0 nearest to the lamp, π/2 at its end [rad].
class AngleShares {
 public:
  /// \param g  of Henyey and Greenstein's phase function.
  explicit AngleShares(double g) {
    for (std::size_t i = 0; i < steps; ++i) {
      const double angle = ((static_cast<double>(i) + 0.5) / steps - 0.5) * pi;
      up_to_[i + 1] = up_to_[i] + henyey_greenstein(-std::sin(angle), g);
    }
    for (double& each : up_to_) each /= up_to_[steps];
  }
  double up_to(double angle) const {
    const double at = place_of(angle);
    const std::size_t step = step_of(at);
    return up_to_[step] + (at - static_cast<double>(step)) * (up_to_[step + 1] - up_to_[step]);
  }
  double angle_at(double share) const {
    const auto above = std::upper_bound(up_to_.begin() + 1, up_to_.end() - 1, share);
    const double end = *above, begin = *(above - 1);
    const double at = static_cast<double>(above - 1 - up_to_.begin()) + (share - begin) / (end - begin);
    return (at / steps - 0.5) * pi;
  }
  /// [1/rad]
  double density(double angle) const {
    const std::size_t step = step_of(place_of(angle));
    return (up_to_[step + 1] - up_to_[step]) * steps / pi;
  }

 private:
  static constexpr std::size_t steps = 64;
  static double place_of(double angle) { return (angle / pi + 0.5) * steps; }
  static std::size_t step_of(double at) {
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(steps - 1)));
  }
  std::array<double, steps + 1> up_to_{};
};

/// Distances as dense as the light of a lamp at distance d that is scattered on along the ray, which falls as
/// 1/d² and with the angle of scattering: by the angles at which the lamp sees them (Kulla & Fajardo, Comput.
/// Graph. Forum 31 (2012) 4, there without the phase function).
class Equiangular {
 public:
  /// \param way  unit. \param length  of the ray, which may be infinite. \param centre, radius2  ball about
  /// the lamp: its radius squared keeps the density from a peak that no lamp with an extent has. \param
  /// shares  must outlive this.
  Equiangular(Vector3 origin, Vector3 way, double length, Vector3 centre, double radius2,
              const AngleShares& shares)
      : shares_(&shares) {
    const Vector3 to_centre = centre - origin;
    along_ = dot(way, to_centre);
    constexpr double least = 1e-16;  // of a point that the ray meets: squared, over its distance
    const Vector3 across = to_centre - along_ * way;
    aside2_ = std::max(dot(across, across) + radius2, least * (along_ * along_ + 1));
    aside_ = std::sqrt(aside2_);
    first_ = shares.up_to(std::atan(-along_ / aside_));
    share_ = shares.up_to(std::atan((length - along_) / aside_)) - first_;
  }

  /// ∫ phase/d² along the ray, up to a factor.
  double light() const { return share_ / aside_; }
  /// Where the ray is nearest to the lamp, before its beginning too.
  double nearest() const { return along_; }
  double sample(double u) const { return along_ + aside_ * std::tan(shares_->angle_at(first_ + u * share_)); }
  double density(double distance) const {
    const double beyond = distance - along_;
    return shares_->density(std::atan(beyond / aside_)) * aside_ / (share_ * (aside2_ + beyond * beyond));
  }

 private:
  const AngleShares* shares_;
  double along_, aside2_, aside_, first_, share_;
};

}  // namespace petzval::render
