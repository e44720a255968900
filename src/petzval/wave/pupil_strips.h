// SPDX-License-Identifier: BSD-3-Clause
// Integrals over a pupil, or over the overlap of two shifted ones, by strips.
#pragma once

#include <petzval/numeric/quadrature.h>
#include <petzval/wave/aperture_shape.h>

#include <array>
#include <complex>
#include <functional>
#include <map>
#include <vector>

namespace petzval {

/// Gauss-Legendre rules, made once each.
class RuleShelf {
 public:
  /// For a phase that makes `turns` turns over the interval, to 1e-9.
  const QuadratureRule& for_turns(double turns, int least);

 private:
  std::map<int, QuadratureRule> rules_;
};

/// A polynomial W(x, y) on [−1, 1]², by Chebyshev interpolation.
class PupilPolynomial {
 public:
  PupilPolynomial() = default;
  /// \param degree  of the polynomial in x and in y.
  PupilPolynomial(int degree, const std::function<double(double x, double y)>& w);

  bool is_zero() const { return coefficients_.empty(); }
  /// The coefficients in x at a height y.
  void row(double y, std::vector<double>& in_x) const;
  static double sum(const std::vector<double>& in_x, double x);

 private:
  std::size_t count_ = 0;
  std::vector<double> coefficients_;  ///< [degree in x][degree in y]
};

/// The shape in axes of which x points along one direction, with its wavefront in the same axes.
class PupilStrips {
 public:
  PupilStrips(const ApertureShape& shape, double angle_rad, PupilPolynomial w, double steepest,
              double most_curved);

  /// ∬ over the overlap of the shape shifted by +s and by −s along x of exp 2πi(W(x + s, y) − W(x − s, y)).
  std::complex<double> overlap(double s, RuleShelf& rules) const;
  /// ∬ over the shape of exp(−2πi W − iπ r x).
  std::complex<double> amplitude(double r, RuleShelf& rules) const;
  /// The largest s at which two shapes shifted by ±s meet.
  double largest_shift() const;

 private:
  /// A range of heights in which nothing but the crossings of the shift begins or ends. The height runs with
  /// a parameter from 0 to 1: over half a cosine, so that chords may end like square roots, or evenly where
  /// both ends are straight.
  struct Band {
    double low, high;
    const OutlinePiece *left, *right;
    bool is_even;
    double height(double t) const;
    double slope(double t) const;  ///< d height/d t
  };
  /// Up to three stretches of x.
  struct Stretches {
    std::array<std::pair<double, double>, 3> ends;
    std::size_t count = 0;
  };
  Stretches stretches(const Band& band, double y, double s) const;
  /// Values of the parameter between which the strips are smooth.
  std::vector<double> breaks(const Band& band, double s) const;

  double obstruction_, steepest_, most_curved_;
  PupilPolynomial w_;
  std::vector<OutlinePiece> pieces_;
  std::vector<Band> bands_;
};

}  // namespace petzval
