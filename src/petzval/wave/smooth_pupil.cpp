// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/wave/smooth_pupil.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace petzval {

double SmoothPupil::alpha_max() const {
  return *std::max_element(outline_alpha.begin(), outline_alpha.end());
}

double SmoothPupil::widest() const {
  return std::max(2 * alpha_max(), beta_high() - beta_low());
}

double SmoothPupil::narrowest() const {
  return std::min(2 * alpha_max(), beta_high() - beta_low());
}

double SmoothPupil::lambda_n_mm() const {
  return wavelength_nm * mm_per_nm / (image_index * widest());
}

double SmoothPupil::half_chord(double beta) const {
  if (!(beta > beta_low() && beta < beta_high())) return 0;
  constexpr std::size_t stencil = 4;
  const auto above = std::upper_bound(outline_beta.begin(), outline_beta.end(), beta, std::greater<>());
  const auto next = static_cast<std::size_t>(above - outline_beta.begin());
  // The smooth piece that holds β, and the stencil about it inside that piece.
  const auto corner = std::lower_bound(corners.begin(), corners.end(), next);
  const std::size_t piece_end = corner == corners.end() ? outline_beta.size() : *corner + 1;
  const std::size_t piece_start = corner == corners.begin() ? 0 : *(corner - 1);
  const std::size_t count = std::min(stencil, piece_end - piece_start);
  const std::size_t wanted = next > stencil / 2 ? next - stencil / 2 : 0;
  const std::size_t first = std::clamp(wanted, piece_start, piece_end - count);
  double square = 0;
  for (std::size_t i = first; i < first + count; ++i) {
    double weight = outline_alpha[i] * outline_alpha[i];
    for (std::size_t j = first; j < first + count; ++j)
      if (j != i) weight *= (beta - outline_beta[j]) / (outline_beta[i] - outline_beta[j]);
    square += weight;
  }
  return std::sqrt(std::max(square, 0.0));
}

double SmoothPupil::amplitude_square_integral() const {
  constexpr int nodes_each = 32;
  const QuadratureRule along = gauss_legendre(nodes_each), turns = gauss_legendre(nodes_each, 0, pi);
  const std::vector<double> ends = smooth_intervals(*this);
  std::vector<double> series(amplitude.terms());
  double sum = 0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    for (std::size_t b = 0; b < turns.nodes.size(); ++b) {
      // β over half a cosine: chords end like square roots.
      const double half_width = 0.5 * (ends[i + 1] - ends[i]);
      const double beta = ends[i] + half_width * (1 - std::cos(turns.nodes[b]));
      const double d_beta = turns.weights[b] * half_width * std::sin(turns.nodes[b]);
      const double half = half_chord(beta);
      amplitude.series(beta, series);
      for (std::size_t a = 0; a < along.nodes.size(); ++a) {
        const double ratio = half * along.nodes[a] / amplitude.x_scale();
        sum +=
            2 * half * along.weights[a] * d_beta * std::pow(chebyshev_sum(series, 2 * ratio * ratio - 1), 2);
      }
    }
  return sum;
}

std::vector<double> smooth_intervals(const SmoothPupil& pupil) {
  std::vector<double> ends{pupil.beta_low()};
  for (std::size_t i = pupil.corners.size(); i-- > 0;) ends.push_back(pupil.outline_beta[pupil.corners[i]]);
  ends.push_back(pupil.beta_high());
  return ends;
}

}  // namespace petzval
