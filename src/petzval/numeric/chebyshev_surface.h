// SPDX-License-Identifier: BSD-3-Clause
// A smooth function of two variables, known at scattered points.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace petzval {

/// p(x, y) = Σ C_mn T_m(u) T_n(v) over 2m + n ≤ degree, with Chebyshev polynomials T of u = 2(x/x_scale)² − 1
/// and v = (y − y_middle)/y_scale: what is mirror symmetric in x, fitted over the bounding box of its points.
/// Without that symmetry Σ D_mn (x/x_scale) T_m(u) T_n(v) over 2m + 1 + n ≤ degree stands beside it.
class ChebyshevSurface {
 public:
  static constexpr int highest_degree = 47;
  struct Line;
  enum class Symmetry { even_in_x, none };

  ChebyshevSurface() = default;

  /// One surface for each list of values at the points (x, y), by least squares. The points share their
  /// normal equations. Empty when the points do not determine the polynomial. \throws InputError if sizes
  /// differ, a number is not finite or the degree is above highest_degree.
  static std::vector<ChebyshevSurface> fit(std::span<const double> x, std::span<const double> y,
                                           std::span<const std::span<const double>> values, int degree,
                                           Symmetry symmetry = Symmetry::even_in_x);
  /// Coefficients of a polynomial of this degree.
  static std::size_t unknowns(int degree, Symmetry symmetry = Symmetry::even_in_x);

  /// Where the polynomials stand.
  struct Frame {
    double x_scale = 1, y_middle = 0, y_scale = 1;
  };
  Frame frame() const { return {x_scale_, y_middle_, y_scale_}; }
  /// The same polynomial, of what is even in x, by Chebyshev terms of another frame.
  ChebyshevSurface in_frame(const Frame& frame) const;
  /// Σ weights[i] surfaces[i] of what is even in x, term by term: in the frame that is the sum of theirs.
  static ChebyshevSurface blend(std::span<const ChebyshevSurface> surfaces, std::span<const double> weights);

  double operator()(double x, double y) const;
  /// All of one y, over x, and all of one x, over y.
  Line at_y(double y) const;
  Line at_x(double x) const;
  /// The length of a series().
  std::size_t terms() const { return static_cast<std::size_t>(degree_ / 2 + 1); }
  double x_scale() const { return x_scale_; }
  /// What is even in x of p(·, y) = Σ series[m] T_m(2(x/x_scale)² − 1). \param series  terms() numbers.
  void series(double y, std::span<double> series) const;

  /// Of the values that were fitted.
  double rms_residual() const { return rms_residual_; }
  double max_residual() const { return max_residual_; }

 private:
  int degree_ = 0;
  double x_scale_ = 1, y_middle_ = 0, y_scale_ = 1;
  std::vector<double> coefficients_{0.0};  ///< m-major, n = 0 … degree − 2m
  std::vector<double> odd_ = {};           ///< likewise, n = 0 … degree − 1 − 2m; empty: even
  double rms_residual_ = 0, max_residual_ = 0;
};

/// A surface along a line: Σ terms[n] T_n(t) with t = r = (along − middle)/scale, or, folded, t = 2r² − 1.
struct ChebyshevSurface::Line {
  std::array<double, highest_degree + 1> terms;  ///< the first `count` of them
  std::size_t count = 0;
  double middle = 0, scale = 1;
  bool folded = false;

  double operator()(double along) const;
};

/// Σ series[m] T_m(u), by Clenshaw's recurrence; at least one term.
double chebyshev_sum(std::span<const double> series, double u);

}  // namespace petzval
