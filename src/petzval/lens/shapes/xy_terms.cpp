// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/lens/shapes/xy_terms.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace petzval {

namespace {

double binomial_number(int n, int k) {
  double result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// Noll's j → radial degree, and azimuthal order: positive for cosines, negative for sines.
std::pair<int, int> noll_orders(int j) {
  int n = 0;
  while ((n + 1) * (n + 2) / 2 < j) ++n;
  const int place = j - n * (n + 1) / 2 - 1;  // within the degree
  const int m = n % 2 == 0 ? 2 * ((place + 1) / 2) : 2 * (place / 2) + 1;
  return {n, j % 2 == 0 ? m : -m};
}

/// Adds factor · r^2p · (x² + y²)^… cos or sin of mφ r^m, expanded.
void add_harmonic(int m, bool sine, int squares, double factor, XyTerms& terms) {
  // r^m cos mφ and r^m sin mφ are the real and the imaginary part of (x + iy)^m.
  for (int k = sine ? 1 : 0; k <= m; k += 2) {
    const double sign = (k / 2) % 2 == 0 ? 1 : -1;
    for (int s = 0; s <= squares; ++s)
      terms[{m - k + 2 * (squares - s), k + 2 * s}] +=
          factor * sign * binomial_number(m, k) * binomial_number(squares, s);
  }
}

double factorial(int n) {
  return std::tgamma(n + 1.0);
}

}  // namespace

XyTerms xy_terms_of_list(const std::vector<double>& coefficients) {
  XyTerms terms;
  int degree = 1, of_y = 0;
  for (const double coefficient : coefficients) {
    if (coefficient != 0) terms[{degree - of_y, of_y}] = coefficient;
    if (++of_y > degree) ++degree, of_y = 0;
  }
  return terms;
}

XyTerms xy_terms_of_zernike(const std::vector<double>& coefficients) {
  XyTerms terms;
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    if (coefficients[i] == 0) continue;
    const auto [n, order] = noll_orders(static_cast<int>(i) + 1);
    const int m = std::abs(order);
    const double norm = coefficients[i] * std::sqrt((n + 1.0) * (m == 0 ? 1 : 2));
    for (int s = 0; s <= (n - m) / 2; ++s) {
      const double radial = (s % 2 == 0 ? 1 : -1) * factorial(n - s) /
                            (factorial(s) * factorial((n + m) / 2 - s) * factorial((n - m) / 2 - s));
      add_harmonic(m, order < 0, (n - m) / 2 - s, norm * radial, terms);
    }
  }
  return terms;
}

std::vector<double> packed_xy_terms(double radius_mm, const XyTerms& terms) {
  int degree = 0;
  for (const auto& [powers, coefficient] : terms) degree = std::max(degree, powers.first + powers.second);
  std::vector<double> packed{1 / radius_mm};
  for (int of_x = degree; of_x >= 0; --of_x)
    for (int of_y = degree - of_x; of_y >= 0; --of_y) {
      const auto found = terms.find({of_x, of_y});
      packed.push_back(found == terms.end() ? 0.0 : found->second);
    }
  return packed;
}

}  // namespace petzval
