// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/numeric/normal_quantile_terms.h>
#include <petzval/numeric/random.h>
#include <petzval/numeric/random_lanes.h>

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/numeric/random_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
//
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace normal_quantile_terms;

using Doubles = hn::ScalableTag<double>;
using Words = hn::Repartition<std::uint64_t, Doubles>;
using Double = hn::Vec<Doubles>;
using Word = hn::Vec<Words>;  ///< 32 bits in the lower half; what stands in the upper one does not matter

/// Of the lower halves.
HWY_ATTR HWY_INLINE Word product(Word a, Word b) {
#if HWY_TARGET == HWY_SCALAR
  const std::uint64_t lower = 0xFFFFFFFF;
  return hn::Set(Words(), (hn::GetLane(a) & lower) * (hn::GetLane(b) & lower));
#else
  const hn::Repartition<std::uint32_t, Doubles> halves;
  return hn::MulEven(hn::BitCast(halves, a), hn::BitCast(halves, b));
#endif
}

/// Uniform in (0, 1) from the upper 52 bits: odd multiples of 2^−53.
HWY_ATTR HWY_INLINE Double uniform(Word upper, Word lower) {
  const Words d;
  const Word bits = hn::Or(hn::ShiftLeft<32>(upper), hn::And(lower, hn::Set(d, std::uint64_t{0xFFFFFFFF})));
  constexpr std::uint64_t exponent_of_one = std::uint64_t{0x3FF} << 52;
  const Double above_one =
      hn::BitCast(Doubles(), hn::Or(hn::ShiftRight<12>(bits), hn::Set(d, exponent_of_one)));
  return hn::Add(hn::Sub(above_one, hn::Set(Doubles(), 1.0)), hn::Set(Doubles(), 0x1p-53));
}

/// Philox4x32-10 for `count` places one after the other; see random.cpp.
HWY_ATTR void uniform_numbers_lanes(std::uint64_t seed, std::uint32_t purpose, std::uint64_t place,
                                    std::size_t count, double* first, double* second) {
  const Words d;
  const std::size_t lanes = hn::Lanes(d);
  const Word factor_0 = hn::Set(d, std::uint64_t{0xD2511F53}),
             factor_1 = hn::Set(d, std::uint64_t{0xCD9E8D57});
  for (std::size_t i = 0; i < count; i += lanes) {
    const Word at = hn::Add(hn::Set(d, place + i), hn::Iota(d, 0));
    Word c0 = hn::Zero(d), c1 = at, c2 = hn::ShiftRight<32>(at), c3 = hn::Set(d, std::uint64_t{purpose});
    std::uint32_t key_0 = static_cast<std::uint32_t>(seed), key_1 = static_cast<std::uint32_t>(seed >> 32);
    constexpr int rounds = 10;
    for (int round = 0; round < rounds; ++round) {
      const Word a = product(factor_0, c0), b = product(factor_1, c2);
      c0 = hn::Xor(hn::Xor(hn::ShiftRight<32>(b), c1), hn::Set(d, std::uint64_t{key_0}));
      c1 = b;
      c2 = hn::Xor(hn::Xor(hn::ShiftRight<32>(a), c3), hn::Set(d, std::uint64_t{key_1}));
      c3 = a;
      key_0 += 0x9E3779B9;
      key_1 += 0xBB67AE85;
    }
    // The arrays have room for whole vectors.
    hn::StoreU(uniform(c1, c0), Doubles(), first + i);
    hn::StoreU(uniform(c3, c2), Doubles(), second + i);
  }
}

template <std::size_t N>
HWY_ATTR HWY_INLINE Double polynomial(const double (&coefficients)[N], Double x) {
  const Doubles d;
  Double sum = hn::Set(d, coefficients[N - 1]);
  for (std::size_t i = N - 1; i-- > 0;) sum = hn::MulAdd(sum, x, hn::Set(d, coefficients[i]));
  return sum;
}

/// Algorithm AS 241 as normal_quantile() has it; its tails, one number in 3·10^10, are left to that.
HWY_ATTR void to_normal_lanes(double* values, std::size_t count) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < count; i += lanes) {
    const Double p = hn::LoadU(d, values + i);
    const Double q = hn::Sub(p, hn::Set(d, 0.5));
    const Double inner = hn::Sub(hn::Set(d, middle_square), hn::Mul(q, q));
    const Double middle =
        hn::Div(hn::Mul(q, polynomial(middle_over, inner)), polynomial(middle_under, inner));
    const Double outside = hn::Min(p, hn::Sub(hn::Set(d, 1.0), p));
    const Double r = hn::Sqrt(hn::Neg(hn::Log(d, outside)));
    const Double shifted = hn::Sub(r, hn::Set(d, flank_start));
    const Double flank = hn::Div(polynomial(flank_over, shifted), polynomial(flank_under, shifted));
    const auto is_middle = hn::Le(hn::Abs(q), hn::Set(d, middle_half_width));
    const auto is_tail = hn::And(hn::Not(is_middle), hn::Gt(r, hn::Set(d, tail_start)));
    if (!hn::AllFalse(d, is_tail)) {
      for (std::size_t k = i; k < i + lanes; ++k) values[k] = normal_quantile(values[k]);
      continue;
    }
    hn::StoreU(hn::IfThenElse(is_middle, middle, hn::CopySign(flank, q)), d, values + i);
  }
}

/// The first draw of PTRS (random.cpp) where that alone decides: `numbers` gets its number, or −1 where more
/// is to be asked. On entry `numbers` holds v.
HWY_ATTR void poisson_first_draws(const double* means, const double* u_values, double* numbers,
                                  std::size_t count, double least_mean) {
  const Doubles d;
  const auto set = [&](double value) HWY_ATTR { return hn::Set(d, value); };
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const Double mean = hn::LoadU(d, means + i), v = hn::LoadU(d, numbers + i);
    const Double u = hn::Sub(hn::LoadU(d, u_values + i), set(0.5));
    const Double b = hn::Add(set(0.931), hn::Mul(set(2.53), hn::Sqrt(mean)));
    const Double a = hn::Add(set(-0.059), hn::Mul(set(0.02483), b));
    const Double v_r = hn::Sub(set(0.9277), hn::Div(set(3.6224), hn::Sub(b, set(2.0))));
    const Double us = hn::Sub(set(0.5), hn::Abs(u));
    const Double slope = hn::Add(hn::Div(hn::Add(a, a), us), b);
    const Double k = hn::Floor(hn::Add(hn::Add(hn::Mul(slope, u), mean), set(0.43)));
    // The last also leaves out NaN and what is too great.
    const auto decided = hn::And(hn::And(hn::Ge(us, set(0.07)), hn::Le(v, v_r)),
                                 hn::And(hn::Ge(mean, set(least_mean)), hn::Le(mean, set(1e15))));
    hn::StoreU(hn::IfThenElse(decided, k, set(-1.0)), d, numbers + i);
  }
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace petzval {

namespace {

HWY_EXPORT(uniform_numbers_lanes);
HWY_EXPORT(to_normal_lanes);
HWY_EXPORT(poisson_first_draws);

/// Whole vectors of any machine at a time, in memory that fits into the nearest cache.
constexpr std::size_t block = 512;
using Block = double[block];

}  // namespace

void uniform_numbers(std::uint64_t seed, std::uint32_t purpose, std::uint64_t place, std::span<double> first,
                     std::span<double> second) {
  Block a, b;
  for (std::size_t from = 0; from < first.size(); from += block) {
    const std::size_t count = std::min(block, first.size() - from);
    HWY_DYNAMIC_DISPATCH(uniform_numbers_lanes)(seed, purpose, place + from, count, a, b);
    std::copy(a, a + count, first.begin() + static_cast<std::ptrdiff_t>(from));
    if (!second.empty()) std::copy(b, b + count, second.begin() + static_cast<std::ptrdiff_t>(from));
  }
}

void to_normal(std::span<double> probabilities) {
  Block values;
  for (std::size_t from = 0; from < probabilities.size(); from += block) {
    const std::size_t count = std::min(block, probabilities.size() - from);
    const auto begin = probabilities.begin() + static_cast<std::ptrdiff_t>(from);
    std::copy(begin, begin + static_cast<std::ptrdiff_t>(count), values);
    std::fill(values + count, values + block, 0.5);
    HWY_DYNAMIC_DISPATCH(to_normal_lanes)(values, count);
    std::copy(values, values + count, begin);
  }
}

void poisson_numbers(std::uint64_t seed, std::uint32_t purpose, std::uint64_t place,
                     std::span<const double> means, std::span<double> numbers) {
  Block u, drawn, here;
  for (std::size_t from = 0; from < means.size(); from += block) {
    const std::size_t count = std::min(block, means.size() - from);
    std::copy_n(means.begin() + static_cast<std::ptrdiff_t>(from), count, here);
    std::fill(here + count, here + block, 0.0);
    HWY_DYNAMIC_DISPATCH(uniform_numbers_lanes)(seed, purpose, place + from, count, u, drawn);
    HWY_DYNAMIC_DISPATCH(poisson_first_draws)(here, u, drawn, count, poisson_rejection_least_mean);
    for (std::size_t i = 0; i < count; ++i)
      numbers[from + i] =
          drawn[i] >= 0 ? drawn[i] : RandomStream(seed, purpose, place + from + i).poisson(here[i]);
  }
}

}  // namespace petzval

#endif  // HWY_ONCE
