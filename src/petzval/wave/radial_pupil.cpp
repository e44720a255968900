// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/bessel.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/wave/radial_pupil.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace petzval {

namespace {

/// Σ_j f(coefficient j+1) at t, as Horner would, with the factor of the derivative.
double polynomial(const std::vector<double>& w, double t, int derivative) {
  double sum = 0;
  for (std::size_t j = w.size(); j-- > 0;) {
    const int power = static_cast<int>(j) + 1;
    double factor = 1;
    for (int d = 0; d < derivative; ++d) factor *= power - d;
    if (factor != 0) sum += factor * w[j] * std::pow(t, power - derivative);
  }
  return sum;
}

/// max − min of W over the pupil: how many turns the phase of an overlap can make.
double range_of(const RadialPupil& pupil) {
  double low = pupil.aberration(pupil.obstruction * pupil.obstruction), high = low;
  constexpr int samples = 200;
  for (int i = 0; i <= samples; ++i) {
    const double rho = pupil.obstruction + (1 - pupil.obstruction) * i / samples;
    const double w = pupil.aberration(rho * rho);
    low = std::min(low, w);
    high = std::max(high, w);
  }
  return high - low;
}

/// Nodes that a Gauss-Legendre rule needs for a phase that makes `turns` turns over the interval.
int node_count(double turns) {
  const double half_range = pi * turns;
  return 26 + static_cast<int>(std::ceil(0.5 * half_range + 2.5 * std::cbrt(half_range)));
}

/// ∬ cos 2π(W(|p + s|) − W(|p − s|)) over the overlap of a disc of radius `a` about −s and one of radius `b`
/// ≤ a about +s, p in the plane. Strips at right angles to the shift; each of the two arcs that bound the
/// overlap is walked by its own angle.
double overlap_integral(const RadialPupil& pupil, double a, double b, double s, const QuadratureRule& rule) {
  const auto strip = [&](double x, double height) {
    double sum = 0;
    for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
      const double y = height * rule.nodes[j], y2 = y * y;
      const double w = pupil.aberration((x + s) * (x + s) + y2) - pupil.aberration((x - s) * (x - s) + y2);
      sum += rule.weights[j] * std::cos(2 * pi * w);
    }
    return 2 * height * sum;
  };
  // The arc of radius r about `centre`, seen from the far end (direction −1: left of it, +1: right), to
  // `angle`.
  const auto arc = [&](double centre, double r, double direction, double angle) {
    double sum = 0;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double theta = angle * rule.nodes[i], sine = std::sin(theta);
      sum += rule.weights[i] * r * sine * strip(centre + direction * r * std::cos(theta), r * sine);
    }
    return angle * sum;
  };
  if (2 * s >= a + b) return 0;
  if (2 * s <= a - b) return arc(s, b, -1, pi);  // the smaller disc lies within the larger one
  if (a == b) return 2 * arc(-s, a, 1, std::acos(std::min(1.0, s / a)));
  const double chord = (a * a - b * b) / (4 * s);
  return arc(s, b, -1, std::acos(std::clamp((s - chord) / b, -1.0, 1.0))) +
         arc(-s, a, 1, std::acos(std::clamp((chord + s) / a, -1.0, 1.0)));
}

double otf_at(const RadialPupil& pupil, double s, const QuadratureRule& rule) {
  const double inner = pupil.obstruction;
  double sum = overlap_integral(pupil, 1, 1, s, rule);
  if (inner > 0)
    sum += overlap_integral(pupil, inner, inner, s, rule) - 2 * overlap_integral(pupil, 1, inner, s, rule);
  return sum / (pi * (1 - inner * inner));
}

QuadratureRule otf_rule(const RadialPupil& pupil) {
  return gauss_legendre(node_count(2 * range_of(pupil)));
}

}  // namespace

double RadialPupil::aberration(double t) const {
  double sum = 0;
  for (std::size_t j = w_waves.size(); j-- > 0;) sum = (sum + w_waves[j]) * t;
  return sum;
}

double RadialPupil::slope(double t) const {
  return polynomial(w_waves, t, 1);
}

void RadialPupil::validate() const {
  constexpr double largest = 1000;
  for (std::size_t j = 0; j < w_waves.size(); ++j)
    if (!(std::abs(w_waves[j]) <= largest))
      throw InputError(fmt::format("W{:02}0 = {} waves: from -{} to {} is right", 2 * (j + 1), w_waves[j],
                                   largest, largest));
  if (!(obstruction >= 0 && obstruction < 1))
    throw InputError(fmt::format(
        "a central obstruction of {}: its radius over the pupil's is from 0 to below 1", obstruction));
}

std::vector<double> radial_psf(const RadialPupil& pupil, std::span<const double> r) {
  pupil.validate();
  double reach = 0;
  for (const double each : r) {
    if (!(std::abs(each) <= 1e4))
      throw InputError(fmt::format("a PSF at {} lambda N: up to 10000 is right", each));
    reach = std::max(reach, std::abs(each));
  }
  const QuadratureRule rule =
      gauss_legendre(node_count(0.5 * reach + geometric_radius(pupil)) + 8, pupil.obstruction, 1);
  std::vector<std::complex<double>> amplitude;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double rho = rule.nodes[i];
    amplitude.push_back(std::polar(2 * rule.weights[i] * rho, 2 * pi * pupil.aberration(rho * rho)));
  }
  const double area = 1 - pupil.obstruction * pupil.obstruction;
  std::vector<double> psf;
  for (const double each : r) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < amplitude.size(); ++i)
      sum += amplitude[i] * bessel_j0(pi * each * rule.nodes[i]);
    psf.push_back(std::norm(sum) / (area * area));
  }
  return psf;
}

std::vector<double> radial_otf(const RadialPupil& pupil, std::span<const double> s) {
  pupil.validate();
  const QuadratureRule rule = otf_rule(pupil);
  std::vector<double> otf;
  for (const double each : s) otf.push_back(each == 0 ? 1 : otf_at(pupil, each, rule));
  return otf;
}

std::vector<double> radial_otf_table(const RadialPupil& pupil, int count) {
  pupil.validate();
  if (count < 1) throw InputError("a table of an OTF needs at least one step");
  const double inner = pupil.obstruction;
  std::vector<double> breaks{0, 1};
  if (inner > 0) breaks.insert(breaks.end(), {inner, 0.5 * (1 - inner), 0.5 * (1 + inner)});
  std::sort(breaks.begin(), breaks.end());
  const QuadratureRule rule = otf_rule(pupil);
  const int nodes = 40 + static_cast<int>(4 * geometric_radius(pupil));

  std::vector<double> table(static_cast<std::size_t>(count) + 1);
  table[0] = 1;
  for (std::size_t b = 0; b + 1 < breaks.size(); ++b) {
    const double from = breaks[b], width = breaks[b + 1] - from;
    if (width <= 0) continue;
    // At the breaks the OTF goes as the 3/2 power of the distance: with s = from + width (1 − cos θ)/2 it is
    // analytic in θ, and so well met by a polynomial in θ.
    std::vector<double> theta, value, weight;
    for (int j = 0; j < nodes; ++j) {
      const double angle = pi * (2 * j + 1) / (2 * nodes);
      theta.push_back(0.5 * pi * (1 - std::cos(angle)));
      value.push_back(otf_at(pupil, from + width * 0.5 * (1 - std::cos(theta.back())), rule));
      weight.push_back((j % 2 == 0 ? 1 : -1) * std::sin(angle));
    }
    const auto first = static_cast<std::size_t>(std::ceil(from * count));
    for (std::size_t i = std::max<std::size_t>(first, 1); i < table.size(); ++i) {
      const double s = static_cast<double>(i) / count;
      if (s > breaks[b + 1]) break;
      const double at = std::acos(std::clamp(1 - 2 * (s - from) / width, -1.0, 1.0));
      double numerator = 0, denominator = 0;
      for (int j = 0; j < nodes; ++j) {
        const auto jj = static_cast<std::size_t>(j);
        const double distance = at - theta[jj];
        if (distance == 0) {
          numerator = value[jj], denominator = 1;
          break;
        }
        numerator += weight[jj] / distance * value[jj];
        denominator += weight[jj] / distance;
      }
      table[i] = numerator / denominator;
    }
  }
  table.back() = 0;
  return table;
}

RadialTail radial_tail(const RadialPupil& pupil) {
  const double inner = pupil.obstruction;
  // A rim of radius ε: with z = πr and β = dP/dρ/(iρP) there, scaled to the rim,
  // |∫ P J0 ρ dρ|² → ε/(πz³) (1 + (3/8 + 3β²)/(εz)²) in the mean.
  const auto add_rim = [&](RadialTail& tail, double radius) {
    const double beta = 4 * pi * radius * radius * pupil.slope(radius * radius);
    tail.k3 += radius;
    tail.k5 += (0.375 + 3 * beta * beta) / (pi * pi * radius);
  };
  RadialTail tail;
  add_rim(tail, 1);
  if (inner > 0) add_rim(tail, inner);
  const double scale = 1 / (pi * pi * pi * (1 - inner * inner));
  return {tail.k3 * scale, tail.k5 * scale};
}

double geometric_radius(const RadialPupil& pupil) {
  double largest = 0;
  constexpr int samples = 200;
  for (int i = 0; i <= samples; ++i) {
    const double rho = pupil.obstruction + (1 - pupil.obstruction) * i / samples;
    largest = std::max(largest, std::abs(4 * rho * pupil.slope(rho * rho)));
  }
  return largest;
}

}  // namespace petzval
