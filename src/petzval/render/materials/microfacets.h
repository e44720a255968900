// SPDX-License-Identifier: BSD-3-Clause
// Rough surfaces made of small mirrors.
#pragma once

#include <petzval/render/vector3.h>

#include <optional>

namespace petzval::render {

/// The distribution of Trowbridge & Reitz (GGX), with Smith's masking: everything in the frame of the
/// surface, z its normal. (Walter et al., EGSR 2007; Heitz, JCGT 3 (2014) 2, equations 16, 72, 99.)
class Microfacets {
 public:
  /// Slopes' widths along x and y. Below `smooth_alpha` the surface counts as a mirror.
  Microfacets(double alpha_x, double alpha_y);
  static constexpr double smooth_alpha = 1e-3;
  double mean_alpha() const { return std::sqrt(alpha_x_ * alpha_y_); }
  bool smooth() const { return alpha_x_ < smooth_alpha && alpha_y_ < smooth_alpha; }

  /// Density of facets of normal m over the surface [1/sr].
  double density(Vector3 m) const;
  /// Smith's Λ: light in direction w reaches 1/(1 + Λ) of the facets that face it.
  double lambda(Vector3 w) const;
  /// Share of facets lit from `wi` and seen from `wo`, heights correlated.
  double shown(Vector3 wo, Vector3 wi) const { return 1 / (1 + lambda(wo) + lambda(wi)); }
  /// Density of the facets that `w` sees [1/sr]; integrates to 1 over m.
  double seen_density(Vector3 w, Vector3 m) const;
  /// A facet normal with seen_density (Heitz, JCGT 7 (2018) 4); w.z ≠ 0.
  Vector3 sample_seen(Vector3 w, double u, double v) const;

 private:
  double alpha_x_, alpha_y_;
};

inline Vector3 reflected(Vector3 w, Vector3 normal) {
  return 2 * dot(w, normal) * normal - w;
}

/// The direction behind a boundary of relative index `eta` (far/near) with normal m on w's side; nothing at
/// total reflection.
inline std::optional<Vector3> refracted(Vector3 w, Vector3 m, double eta) {
  const double cos = dot(w, m), sin2_far = (1 - cos * cos) / (eta * eta);
  if (sin2_far >= 1) return {};
  return (cos / eta - std::sqrt(1 - sin2_far)) * m - (1 / eta) * w;
}

}  // namespace petzval::render
