// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/numeric/quadrature.h>
#include <petzval/render/materials/fresnel.h>
#include <petzval/render/media/diffuse_albedo.h>

#include <Eigen/Dense>
#include <cmath>

namespace petzval::render {

namespace {

/// Directions inside on each side of the angle of total reflection, where reflectance has a kink.
constexpr int directions = 10;
constexpr int most_iterations = 200;
/// Far below what a walk at random tells apart.
constexpr double small_change = 1e-7;
constexpr int halvings = 30;

/// Cosines inside, and what a quadrature over them needs.
struct InsideDirections {
  Eigen::ArrayXd cos, weight, reflected;  ///< `reflected`: by the boundary, back inside

  explicit InsideDirections(double eta)
      : cos(2 * directions), weight(2 * directions), reflected(2 * directions) {
    const double critical = std::sqrt(std::max(0.0, 1 - 1 / (eta * eta)));
    const QuadratureRule total = gauss_legendre(directions, 0, critical),
                         partial = gauss_legendre(directions, critical, 1);
    for (int i = 0; i < directions; ++i) {
      const auto at = static_cast<std::size_t>(i);
      cos[i] = total.nodes[at], weight[i] = total.weights[at];
      cos[directions + i] = partial.nodes[at], weight[directions + i] = partial.weights[at];
    }
    for (int i = 0; i < 2 * directions; ++i) reflected[i] = dielectric_reflectance(cos[i], 1 / eta);
  }
};

/// H(cos) of even scattering.
Eigen::ArrayXd h_function(double albedo, const InsideDirections& inside) {
  Eigen::ArrayXd h = Eigen::ArrayXd::Ones(inside.cos.size());
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    Eigen::ArrayXd next(h.size());
    for (Eigen::Index i = 0; i < h.size(); ++i) {
      const double sum = (inside.weight * inside.cos * h / (inside.cos[i] + inside.cos)).sum();
      next[i] = 1 / (std::sqrt(1 - albedo) + albedo / 2 * sum);
    }
    const double change = (next - h).abs().maxCoeff();
    h = (h + next) / 2;  // else it swings
    if (change < small_change) break;
  }
  return h;
}

double diffuse_albedo(double albedo, const InsideDirections& inside) {
  const Eigen::ArrayXd h = h_function(albedo, inside);
  const Eigen::Index n = h.size();
  // What comes up from the half space, of what goes down into it.
  Eigen::MatrixXd reflection(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    reflection.row(i) = (albedo / 2 * h[i] * inside.weight * inside.cos * h / (inside.cos[i] + inside.cos));
  // Light comes in as it would go out.
  const Eigen::VectorXd entered = (1 - inside.reflected).matrix();
  const Eigen::MatrixXd again = reflection * inside.reflected.matrix().asDiagonal();
  const Eigen::VectorXd up =
      (Eigen::MatrixXd::Identity(n, n) - again).partialPivLu().solve(reflection * entered);
  const Eigen::ArrayXd flux = inside.weight * inside.cos * (1 - inside.reflected);
  return (flux * up.array()).sum() / flux.sum();
}

}  // namespace

double diffuse_albedo(double albedo, double eta) {
  return diffuse_albedo(albedo, InsideDirections(eta));
}

double scattering_albedo(double reflectance, double eta, double g) {
  if (reflectance >= 1) return 1;
  if (reflectance <= 0) return 0;
  const InsideDirections inside(eta);
  // The colour is nearly straight in the root of what is absorbed.
  double low = 0, high = 1;
  for (int i = 0; i < halvings; ++i) {
    const double root = (low + high) / 2;
    (diffuse_albedo(1 - root * root, inside) > reflectance ? low : high) = root;
  }
  const double even = 1 - high * high;
  return even / (1 - g + even * g);
}

}  // namespace petzval::render
