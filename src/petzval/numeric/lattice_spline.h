// SPDX-License-Identifier: BSD-3-Clause
// A smooth surface through values on a rectangular lattice.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace petzval {

/// A cubic in x − start, for start ≤ x < the start of the next.
struct CubicStretch {
  double start = 0;
  std::array<double, 4> coefficients{};

  double operator()(double x) const {
    const double u = x - start;
    return coefficients[0] + u * (coefficients[1] + u * (coefficients[2] + u * coefficients[3]));
  }
  double derivative(double x) const {
    const double u = x - start;
    return coefficients[1] + u * (2 * coefficients[2] + u * 3 * coefficients[3]);
  }
};

/// The bicubic spline through values at the knots of a lattice: two continuous derivatives, no knot at the
/// second and the last but one value of a line ("not a knot"; de Boor, A Practical Guide to Splines, 1978,
/// ch. IV and XVII), so that cubics along either axis are met everywhere. With three knots along an axis it
/// is a parabola there, with two a straight line. Outside the lattice it goes on as the outermost patch's
/// tangent.
class LatticeSpline {
 public:
  LatticeSpline() = default;  ///< only to be assigned to
  /// \param values  [knot of y][knot of x]. \throws InputError unless both axes have two knots or more and
  /// increase, and sizes agree.
  LatticeSpline(std::vector<double> x, std::vector<double> y, std::vector<double> values);

  double operator()(double x, double y) const { return at(x, y).value; }
  struct Tangent {
    double value, along_x, along_y;
  };
  Tangent at(double x, double y) const;

  /// Makes the patch between knots (i, i + 1) of x and (j, j + 1) of y bilinear: where values end at one of
  /// its corners, a cubic would swing.
  void flatten(std::size_t i, std::size_t j);

  /// The line of this y, as one cubic for each interval of x, and of its derivative along y.
  void row(double y, std::vector<CubicStretch>& values, std::vector<CubicStretch>& along_y) const;

  const std::vector<double>& x() const { return x_; }
  const std::vector<double>& y() const { return y_; }

 private:
  using Patch = std::array<std::array<double, 4>, 4>;  ///< [power of y][power of x]
  std::size_t patch_index(std::size_t i, std::size_t j) const { return j * (x_.size() - 1) + i; }

  std::vector<double> x_, y_, values_;
  std::vector<Patch> patches_;
};

/// The slopes at the knots of the spline along one axis. \throws nothing; sizes agree, x increases.
std::vector<double> spline_slopes(std::span<const double> x, std::span<const double> values);

}  // namespace petzval
