// SPDX-License-Identifier: BSD-3-Clause
// e^{2πi cycles} in lanes. Included once for every instruction set, inside of foreach_target.
#if defined(PETZVAL_NUMERIC_TURN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_NUMERIC_TURN_INL_H_
#undef PETZVAL_NUMERIC_TURN_INL_H_
#else
#define PETZVAL_NUMERIC_TURN_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <iterator>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

/// Taylor's series about the nearest quarter turn, to 1e-16 in lanes of doubles, 1e-7 of floats.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_ATTR HWY_INLINE void turn_by(D d, V cycles, V& cosine, V& sine) {
  namespace hn = hwy::HWY_NAMESPACE;
  using T = hn::TFromD<D>;
  constexpr T two_pi = static_cast<T>(6.283185307179586477);
  const hn::RebindToSigned<D> whole;
  const auto quarters = hn::Round(hn::Mul(cycles, hn::Set(d, T{4})));
  const auto angle = hn::Mul(hn::NegMulAdd(quarters, hn::Set(d, T{0.25}), cycles), hn::Set(d, two_pi));
  const auto square = hn::Mul(angle, angle);
  constexpr double factorials[] = {1.0 / 1307674368000, 1.0 / 6227020800, 1.0 / 39916800, 1.0 / 362880,
                                   1.0 / 5040,          1.0 / 120,        1.0 / 6,        1.0};
  constexpr double even[] = {1.0 / 20922789888000, 1.0 / 87178291200, 1.0 / 479001600, 1.0 / 3628800,
                             1.0 / 40320,          1.0 / 720,         1.0 / 24,        1.0 / 2};
  constexpr std::size_t first = sizeof(T) == sizeof(double) ? 0 : 3;
  const auto term = [](double sign, double factor) { return static_cast<T>(sign * factor); };
  double sign = first % 2 == 0 ? -1 : 1;
  auto s = hn::Set(d, term(sign, factorials[first])), c = hn::Set(d, term(-sign, even[first]));
  for (std::size_t i = first + 1; i < std::size(factorials); ++i) {
    sign = -sign;
    s = hn::MulAdd(s, square, hn::Set(d, term(sign, factorials[i])));
    c = hn::MulAdd(c, square, hn::Set(d, term(-sign, even[i])));
  }
  s = hn::Mul(s, angle);
  c = hn::MulAdd(c, square, hn::Set(d, T{1}));
  // A quarter turn takes (c, s) to (−s, c).
  const auto turns = hn::ConvertTo(whole, quarters);
  const auto one = hn::Set(whole, 1), two = hn::Set(whole, 2);
  const auto odd = hn::RebindMask(d, hn::TestBit(turns, one));
  const auto cosine_negative = hn::RebindMask(d, hn::TestBit(hn::Add(turns, one), two));
  const auto sine_negative = hn::RebindMask(d, hn::TestBit(turns, two));
  cosine = hn::IfThenElse(odd, s, c);
  sine = hn::IfThenElse(odd, c, s);
  cosine = hn::IfThenElse(cosine_negative, hn::Neg(cosine), cosine);
  sine = hn::IfThenElse(sine_negative, hn::Neg(sine), sine);
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
