// SPDX-License-Identifier: BSD-3-Clause
// Curves through tabulated values: a monotone cubic by default, a least-squares polynomial where one is asked
// for.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace petzval {

/// The interval of an increasing abscissa that `at` falls into: i with x[i] ≤ at < x[i+1], the first or the
/// last interval outside the range. Needs at least two entries.
std::size_t bracket(std::span<const double> x, double at);

/// A continuously differentiable curve through points that never leaves the span of two neighbours: between
/// (x[i], y[i]) and (x[i+1], y[i+1]) it runs monotonically, whatever the data.
///
/// Slopes are those of the quartic through the five nearest points, so that a smooth curve is met to the
/// fourth order in the spacing; they are then limited to [0, 3] times the neighbouring secants, which is
/// sufficient for monotony (Fritsch & Carlson, SIAM J. Numer. Anal. 17 (1980) 238; Hyman, SIAM J. Sci. Stat.
/// Comput. 4 (1983) 645). The price: at a point higher or lower than both its neighbours the slope is zero.
/// A curve that carries on beyond its points rises everywhere if they do: its slopes are limited to [1/3, 2]
/// times the secants.
///
///     MonotoneCubic g(height_mm, g_sr, MonotoneCubic::Start::even);
///     double g_there = g(1.25);
class MonotoneCubic {
 public:
  /// What is known of the curve at the first point: nothing, or that it is mirrored there as an even (slope
  /// zero) or an odd function is; the mirrored points then take part in the slopes.
  enum class Start { free, even, odd };
  /// Outside the points: the end value is held, or the end slope carries on.
  enum class Beyond { hold, linear };

  MonotoneCubic() = default;  ///< only to be assigned to
  /// One point makes a constant. \throws InputError unless the sizes agree, there is a point, x strictly
  /// increases and everything is finite.
  MonotoneCubic(std::vector<double> x, std::vector<double> y, Start start = Start::free,
                Beyond beyond = Beyond::hold);

  double operator()(double x) const;
  double derivative(double x) const;
  /// Where the curve has the value y, for curves that strictly increase or decrease throughout; exact to
  /// rounding, so that inverse(f(x)) == x to about 1e-15 of the range. Outside the values it follows `Beyond`
  /// (hold: the end).
  double inverse(double y) const;

  /// The ends of the range.
  double front() const { return x_.front(); }
  double back() const { return x_.back(); }

 private:
  struct Piece {
    double value, slope, quadratic, cubic;
  };
  double inverse_in(std::size_t i, double y) const;

  std::vector<double> x_, y_;
  std::vector<Piece> pieces_;  ///< in powers of x − x[i]
  double first_slope_ = 0, last_slope_ = 0;
  Beyond beyond_ = Beyond::hold;
};

/// Which powers a polynomial has.
enum class Powers {
  all,          ///< 0, 1, 2, …
  no_constant,  ///< 1, 2, 3, …
  even,         ///< 0, 2, 4, …
  odd           ///< 1, 3, 5, …
};

/// A polynomial in u = x / scale.
struct PolynomialFit {
  double scale = 1;
  std::vector<double> coefficients;  ///< [power of u]
  double rms_residual = 0, max_residual = 0;

  double operator()(double x) const;
  double derivative(double x) const;
};

/// The polynomial of the given order (1 to 8) that fits the points best in the sense of least squares, by
/// Householder QR in x scaled to [−1, 1].
/// \throws InputError if sizes differ, a number is not finite, or there are fewer distinct points than
/// coefficients.
PolynomialFit fit_polynomial(std::span<const double> x, std::span<const double> y, int order,
                             Powers powers = Powers::all);

}  // namespace petzval
