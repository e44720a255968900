// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_family.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace petzval {

namespace {

double sinc_of(double x) {
  return std::abs(x) < 1e-9 ? 1 : std::sin(pi * x) / (pi * x);
}

}  // namespace

double EdgeShape::airy_px() const {
  return std::exp(log_airy);
}

EdgeFamily::EdgeFamily(const EdgeShape& shape, double normal_rad, double knot_px, int count)
    : splines(decltype(splines)::Zero(count, columns)), tail1(decltype(tail1)::Zero()) {
  // 1 − 4s/π is what a transform begins with whose edge misses A/d far away, A = 2 λN/π³.
  const double airy_px = shape.airy_px(), tail = 2 / (pi * pi * pi) * airy_px;
  tail1 << tail - 1 / pi, 0, tail, 0;
  const double c = std::cos(normal_rad), s = std::sin(normal_rad);
  // A spectrum of lines, whose profile comes again after twice the range of the splines.
  const double line = 1 / (2 * (count + 10) * knot_px), highest = std::min(1 / airy_px, 0.5 / knot_px);
  const int half = (count + 1) / 2;
  for (double f = 0.5 * line; f < highest; f += line) {
    const double share = f * airy_px, root = std::sqrt(1 - share * share);
    const double rest =
        sinc_of(f * c) * sinc_of(f * s) * std::exp(-2 * pi * pi * std::max(shape.variance, -0.1) * f * f);
    const double mtf = 2 / pi * (std::acos(share) - share * root) * rest;
    // What the closed forms of EdgeSpreadModel leave of it.
    const double fade = std::exp(-2 * pi * f), of_tail = -2 * pi * pi * f * fade;
    const double odd[columns] = {mtf - fade - tail1[profile] * of_tail, 0,
                                 -4 / pi * share * root * rest - tail * of_tail, -2 * pi * pi * f * f * mtf};
    const double sinc = sinc_of(f * knot_px), cube = sinc * sinc * sinc;
    const double weight = 2 * line / (cube * cube), per_slope = 1 / (2 * pi * f);
    const double turn = 2 * pi * f * knot_px, start = -0.5 * (count - 1) * turn;
    const double turn_cos = std::cos(turn), turn_sin = std::sin(turn);
    double cosine = std::cos(start), sine = std::sin(start);
    const double w0 = weight * per_slope * odd[0], w1 = -weight * mtf, w2 = weight * per_slope * odd[2],
                 w3 = weight * per_slope * odd[3];
    for (int j = 0; j < half; ++j) {
      double* const of_spline = splines.data() + static_cast<std::ptrdiff_t>(j) * columns;
      of_spline[profile] += w0 * sine;
      of_spline[offset] += w1 * cosine;
      of_spline[log_airy] += w2 * sine;
      of_spline[variance] += w3 * sine;
      const double next = cosine * turn_cos - sine * turn_sin;
      sine = sine * turn_cos + cosine * turn_sin;
      cosine = next;
    }
  }
  for (int j = 0; j < count / 2; ++j) {
    splines.row(count - 1 - j) = -splines.row(j);
    splines(count - 1 - j, offset) = splines(j, offset);
  }
}

}  // namespace petzval
