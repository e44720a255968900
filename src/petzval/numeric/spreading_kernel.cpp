// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/numeric/fft.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/numeric/spreading_kernel.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double half_width = SpreadingKernel::width / 2.0;
// 0.97: a little below the cut-off of the first alias (the paper's γ).
constexpr double beta = 0.97 * pi * SpreadingKernel::width * (1 - 0.5 / SpreadingKernel::oversampling);

double kernel(double u) {
  const double t = u / half_width, rest = 1 - t * t;
  return rest > 0 ? std::exp(beta * (std::sqrt(rest) - 1)) : (rest == 0 ? std::exp(-beta) : 0);
}

}  // namespace

SpreadingKernel::SpreadingKernel() {
  // Interpolation in Chebyshev points of t = 2·offset − 1, turned into powers of t.
  constexpr int n = degree + 1;
  for (int i = 0; i < width; ++i) {
    std::array<double, n> series{};
    for (int j = 0; j < n; ++j) {
      const double angle = pi * (j + 0.5) / n;
      const double value = kernel(i - half_width + 0.5 * (std::cos(angle) + 1));
      for (int m = 0; m < n; ++m)
        series[static_cast<std::size_t>(m)] += (m == 0 ? 1.0 : 2.0) / n * value * std::cos(m * angle);
    }
    std::array<double, n> previous{1}, current{0, 1}, power{};
    for (int m = 0; m < n; ++m) {
      const auto& chebyshev = m == 0 ? previous : current;
      for (int p = 0; p < n; ++p)
        power[static_cast<std::size_t>(p)] +=
            series[static_cast<std::size_t>(m)] * chebyshev[static_cast<std::size_t>(p)];
      if (m == 0) continue;
      std::array<double, n> next{};
      for (int p = 0; p < n; ++p)
        next[static_cast<std::size_t>(p)] = (p > 0 ? 2 * current[static_cast<std::size_t>(p - 1)] : 0) -
                                            previous[static_cast<std::size_t>(p)];
      previous = current;
      current = next;
    }
    for (int p = 0; p < n; ++p)
      coefficients_[static_cast<std::size_t>(p)][static_cast<std::size_t>(i)] =
          power[static_cast<std::size_t>(p)];
  }
}

std::vector<double> SpreadingKernel::correction(int highest, int size) const {
  // The kernel is smooth but for the last 1e-12 of its height at the ends.
  const QuadratureRule rule = gauss_legendre(4 * width, 0, half_width);
  std::vector<double> result(static_cast<std::size_t>(highest) + 1);
  for (std::size_t k = 0; k < result.size(); ++k) {
    double transform = 0;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
      transform += 2 * rule.weights[i] * kernel(rule.nodes[i]) *
                   std::cos(2 * pi * static_cast<double>(k) * rule.nodes[i] / size);
    result[k] = 1 / transform;
  }
  return result;
}

const SpreadingKernel& spreading_kernel() {
  static const SpreadingKernel kernel;
  return kernel;
}

int spreading_grid_size(int highest) {
  const double needed = SpreadingKernel::oversampling * (2.0 * highest + 1);
  return good_fft_size(std::max(2 * SpreadingKernel::width, static_cast<int>(std::ceil(needed))));
}

}  // namespace petzval
