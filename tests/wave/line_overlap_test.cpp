// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/wave/line_overlap.h>

#include <cmath>

namespace petzval {
namespace {

ChebyshevSurface::Line line_of(std::initializer_list<double> terms, double middle, double scale,
                               bool folded) {
  ChebyshevSurface::Line line;
  for (const double term : terms) line.terms[line.count++] = term;
  line.middle = middle, line.scale = scale, line.folded = folded;
  return line;
}

// A wave of quadratic phase, c x²: P(x) P*(x − s) turns evenly, by 2cs a unit, so that its integral is a
// sinc.
TEST(LineOverlap, OfAQuadraticPhaseIsASinc) {
  const double c = 3.1, s = 0.4, low = -0.7, length = 1.9;
  // c x² = (c/2)(1 + T_1(2x² − 1)), and in x itself c(T_0 + T_2)/2.
  for (const WaveLine& wave :
       {WaveLine{line_of({c / 2, c / 2}, 0, 1, true)}, WaveLine{line_of({c / 2, 0, c / 2}, 0, 1, false)}}) {
    const double turns = 2 * c * s, middle = low + 0.5 * length;
    const std::complex<double> expected =
        std::polar(1.0, 2 * pi * (turns * middle - c * s * s)) * std::sin(pi * turns * length) / (pi * turns);
    for (const int nodes : {40, 41, 43, 300}) {  // groups that are full and that are not
      const std::complex<double> sum = line_overlap(wave, low, length, s, gauss_legendre(nodes));
      EXPECT_NEAR(std::abs(sum - expected), 0, 1e-12) << nodes;
    }
  }
}

// Against the wave itself, place by place, also where a smooth amplitude would fall below 0.
TEST(LineOverlap, IsTheSumOfTheWaveTimesItself) {
  const WaveLine wave{line_of({0.3, -1.2, 0.4, 0.05}, 0.1, 0.8, false), line_of({0.6, 0.7}, 0.1, 0.8, false)};
  const QuadratureRule rule = gauss_legendre(37);
  const double low = -0.7, length = 1.4, shift = 0.15;
  std::complex<double> expected = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double at = low + length * rule.nodes[i];
    expected += length * rule.weights[i] * wave(at) * std::conj(wave(at - shift));
  }
  EXPECT_EQ(wave(-0.7), 0.0);
  EXPECT_NEAR(std::abs(line_overlap(wave, low, length, shift, rule) - expected), 0, 1e-13);
}

}  // namespace
}  // namespace petzval
