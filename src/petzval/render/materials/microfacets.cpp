// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/render/materials/microfacets.h>

#include <algorithm>

namespace petzval::render {

Microfacets::Microfacets(double alpha_x, double alpha_y) : alpha_x_(alpha_x), alpha_y_(alpha_y) {
  if (smooth()) return;
  alpha_x_ = std::max(alpha_x_, 1e-4);
  alpha_y_ = std::max(alpha_y_, 1e-4);
}

double Microfacets::density(Vector3 m) const {
  if (!(m.z * m.z > 0)) return 0;
  const double slope_x = m.x / alpha_x_, slope_y = m.y / alpha_y_;
  const double sum = slope_x * slope_x + slope_y * slope_y + m.z * m.z;
  return 1 / (pi * alpha_x_ * alpha_y_ * sum * sum);
}

double Microfacets::lambda(Vector3 w) const {
  const double cos2 = w.z * w.z;
  if (!(cos2 > 0)) return 1e30;
  const double across = alpha_x_ * alpha_x_ * w.x * w.x + alpha_y_ * alpha_y_ * w.y * w.y;
  return (std::sqrt(1 + across / cos2) - 1) / 2;
}

double Microfacets::seen_density(Vector3 w, Vector3 m) const {
  const double cos = std::abs(w.z);
  if (!(cos > 0)) return 0;
  return std::abs(dot(w, m)) * density(m) / ((1 + lambda(w)) * cos);
}

Vector3 Microfacets::sample_seen(Vector3 w, double u, double v) const {
  // Stretched so that the facets are those of a hemisphere.
  Vector3 stretched = normalised(Vector3{alpha_x_ * w.x, alpha_y_ * w.y, w.z});
  if (stretched.z < 0) stretched = -stretched;
  const Vector3 t1 =
      stretched.z < 0.99999 ? normalised(cross(Vector3{0, 0, 1}, stretched)) : Vector3{1, 0, 0};
  const Vector3 t2 = cross(stretched, t1);
  const double r = std::sqrt(u), phi = 2 * pi * v;
  const double x = r * std::cos(phi), half = (1 + stretched.z) / 2;
  const double y = (1 - half) * std::sqrt(1 - x * x) + half * r * std::sin(phi);
  const double z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
  const Vector3 h = x * t1 + y * t2 + z * stretched;
  return normalised(Vector3{alpha_x_ * h.x, alpha_y_ * h.y, std::max(1e-9, h.z)});
}

}  // namespace petzval::render
