// SPDX-License-Identifier: BSD-3-Clause
// Sums that do not depend on the order of what is added.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

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
    units_ += units_of(value);
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

  /// static_cast<Units>(value * units_in_one), which compilers make a call of their library of: here the 53
  /// bits of a double (IEEE 754) are shifted to their place.
  static Units units_of(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const auto exponent = static_cast<int>(bits >> 52 & 0x7ff);
    const auto digits = static_cast<Units>((bits & 0xfffffffffffff) | 0x10000000000000);
    const int shift = exponent - (1023 + 52) + 72;  // at most 50: the value is at most 2³⁰
    if (shift <= -53) return 0;
    const Units units = shift >= 0 ? digits << shift : digits >> -shift;
    return bits >> 63 ? -units : units;
  }

  Units units_ = 0;
};

}  // namespace petzval::render
