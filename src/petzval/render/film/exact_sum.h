// SPDX-License-Identifier: BSD-3-Clause
// Sums that do not depend on the order of what is added.
#pragma once

#include <cmath>

namespace petzval::render {

/// A sum in fixed point, 128 bits wide: what is added is rounded towards 0 to a multiple of 2⁻⁷² (2·10⁻²²),
/// once, and the rest is exact. So the parts of a sum may be gathered by anybody in any order, and put
/// together they are the bits of one sum; sums of doubles are not. One value counts as at most 2³⁰, and 2²⁴
/// of them always fit.
class ExactSum {
 public:
  ExactSum() = default;

  ExactSum& operator+=(double value) {
    // What is not a number counts as nothing, so that one path in a billion does not blacken a picture.
    if (!(std::abs(value) < most)) value = std::isnan(value) ? 0 : std::copysign(most, value);
    units_ += static_cast<Units>(value * units_in_one);
    return *this;
  }
  ExactSum& operator+=(const ExactSum& other) {
    units_ += other.units_;
    return *this;
  }
  double value() const { return static_cast<double>(units_) / units_in_one; }
  friend bool operator==(const ExactSum&, const ExactSum&) = default;

 private:
  __extension__ typedef __int128 Units;
  static constexpr double most = 0x1p30, units_in_one = 0x1p72;

  Units units_ = 0;
};

}  // namespace petzval::render
