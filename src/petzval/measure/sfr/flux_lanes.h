// SPDX-License-Identifier: BSD-3-Clause
// What straight sides contribute to a flux, on whatever SIMD the machine has.
#pragma once

#include <cstddef>
#include <vector>

namespace petzval {

/// Straight lines, by where they begin and the way to their end.
class FluxSides {
 public:
  void add(double from_x, double from_y, double way_x, double way_y);
  bool empty() const { return from_x_.empty(); }
  /// Σ ∫ (r·n)/r³ ds at (x, y), n to the left of the way in the picture.
  double flux(double x, double y) const;

 private:
  std::size_t used_ = 0;  ///< behind them lines of no length, up to a multiple of eight
  std::vector<double> from_x_, from_y_, way_x_, way_y_;
};

}  // namespace petzval
