// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/render/materials/sheen.h>

#include <cmath>

namespace petzval::render {

namespace {

/// Points of the quadrature over directions, each way: f is smooth in the roots of the cosines.
constexpr int points_of_sheen = 64;

/// The first column, in place of light along the surface, which meets nothing.
constexpr double least_root = 1e-2;

/// Smith's Λ, as fitted in the paper's table 1 and equation 3.
double masking(double cos, double alpha) {
  const double t = (1 - alpha) * (1 - alpha);
  const auto at = [&](double rough, double fine) { return rough + (fine - rough) * t; };
  const double a = at(21.5473, 25.3245), b = at(3.82987, 3.32435), c = at(0.19823, 0.16801),
               d = at(-1.97760, -1.27393), e = at(-4.32054, -4.85967);
  const auto fit = [&](double x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
  return std::exp(cos < 0.5 ? fit(cos) : 2 * fit(0.5) - fit(1 - cos));
}

double undimmed_value(Vector3 wo, Vector3 wi, double alpha) {
  const Vector3 m = normalised(wo + wi);
  const double sin2 = std::max(0.0, 1 - m.z * m.z), out = std::abs(wo.z), in = std::abs(wi.z);
  const double density = (2 + 1 / alpha) * std::pow(sin2, 0.5 / alpha) / (2 * pi);
  return density / (4 * out * in * (1 + masking(out, alpha) + masking(in, alpha)));
}

double alpha_of(double row, int rows) {
  const double root = std::sqrt(Sheen::least_alpha) + (1 - std::sqrt(Sheen::least_alpha)) * row / (rows - 1);
  return root * root;
}

}  // namespace

Sheen::Sheen() {
  parallel_for(roughnesses, [&](std::size_t r) {
    const double alpha = alpha_of(static_cast<double>(r), roughnesses);
    for (int c = 0; c < angles; ++c) {
      const double root = std::max(least_root, static_cast<double>(c) / (angles - 1)), cos = root * root;
      const Vector3 wo{std::sqrt(1 - cos * cos), 0, cos};
      double sum = 0;
      for (int i = 0; i < points_of_sheen; ++i)
        for (int j = 0; j < points_of_sheen; ++j) {
          const double s = (i + 0.5) / points_of_sheen, z = s * s, turn = pi * (j + 0.5) / points_of_sheen;
          const double across = std::sqrt(1 - z * z);
          const Vector3 wi{across * std::cos(turn), across * std::sin(turn), z};
          sum += undimmed_value(wo, wi, alpha) * z * 2 * s;
        }
      table_[r][static_cast<std::size_t>(c)] = 2 * pi * sum / (points_of_sheen * points_of_sheen);
    }
  });
}

double Sheen::undimmed(double cos, double alpha) const {
  const double least = std::sqrt(least_alpha);
  const double row =
                   (std::sqrt(std::clamp(alpha, least_alpha, 1.0)) - least) / (1 - least) * (roughnesses - 1),
               column = std::clamp(std::sqrt(cos), 0.0, 1.0) * (angles - 1);
  const int r = std::min(static_cast<int>(row), roughnesses - 2),
            c = std::min(static_cast<int>(column), angles - 2);
  const double t = row - r, s = column - c;
  const auto value = [&](int i, int j) {
    return table_[static_cast<std::size_t>(r + i)][static_cast<std::size_t>(c + j)];
  };
  return (1 - t) * ((1 - s) * value(0, 0) + s * value(0, 1)) + t * ((1 - s) * value(1, 0) + s * value(1, 1));
}

double Sheen::value(Vector3 wo, Vector3 wi, double alpha) const {
  const double used = std::clamp(alpha, least_alpha, 1.0);
  const double most = std::max({1.0, undimmed(std::abs(wo.z), used), undimmed(std::abs(wi.z), used)});
  return undimmed_value(wo, wi, used) / most;
}

}  // namespace petzval::render
