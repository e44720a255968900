// SPDX-License-Identifier: BSD-3-Clause
// The opening through which the light of a sky comes into a room.
#pragma once

#include <petzval/render/vector3.h>

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace petzval::render {

/// A part of the unit square.
struct SquareWindow {
  std::array<double, 2> low, high;
};

/// A density over the unit square, constant in each of side × side cells, of which any window can be drawn
/// from by itself (summed-area table: Crow 1984).
class WindowedDistribution {
 public:
  /// \param weights  row by row, none negative.
  WindowedDistribution(std::vector<double> weights, int side);

  /// ∬ weight du dv.
  double integral(const SquareWindow& window) const;
  /// The cell's weight.
  double weight(double u, double v) const;
  struct Point {
    double u = 0, v = 0;
  };
  /// By weight. Not of a window without any.
  Point sample(const SquareWindow& window, double u, double v) const;

 private:
  double sum_to(double across, double down) const;
  double sum(double left, double right, double top, double bottom) const;

  int side_;
  std::vector<double> weights_, sums_;
};

/// A rectangle that light from far away comes through, and what there is of it in the directions beyond,
/// rectified: by the angles from its normal along its two sides, in which the rectangle is a rectangle as
/// seen from anywhere (Bitterli, Novák & Jarosz, Comput. Graph. Forum 34 (2015) 4).
class Portal {
 public:
  /// \param corners  in turn: x is from the first to the last, y from the first to the second, and x × y
  /// looks out to the sky (pbrt-v4). \throws InputError unless they are a rectangle.
  explicit Portal(const std::array<Vector3, 4>& corners);

  /// Fills the map. \param side  of it, in cells. \param luminance  from a direction. \param bright  some
  /// directions that must not be missed.
  void rectify(int side, const std::function<double(Vector3)>& luminance, const std::vector<Vector3>& bright);

  /// Whether a ray leaves through it.
  bool lets_out(Vector3 origin, Vector3 direction) const;
  /// ∫ luminance dω through it.
  double fluence(Vector3 from) const;
  /// As fluence(), of that which a surface of this normal gets, rather too much.
  double irradiance(Vector3 from, Vector3 normal, bool both_sides) const;
  struct Sample {
    Vector3 direction;
    double pdf = 0;  ///< over solid angle; 0: there is none
  };
  Sample sample(Vector3 from, double u, double v) const;
  double pdf(Vector3 from, Vector3 direction) const;

 private:
  std::optional<SquareWindow> window(Vector3 from) const;
  Vector3 direction_at(double u, double v) const;

  std::array<Vector3, 4> corners_;
  Vector3 x_, y_, z_;
  double wide_, high_;
  std::optional<WindowedDistribution> map_;
};

}  // namespace petzval::render
