// SPDX-License-Identifier: BSD-3-Clause
// Random numbers that are functions of a counter: the same seed, purpose and place give the same number on
// any thread, in any order.
#pragma once

#include <array>
#include <cstdint>

namespace petzval {

/// Philox4x32-10: 128 random bits from a 128-bit counter under a 64-bit key (Salmon, Moraes, Dror & Shaw,
/// "Parallel random numbers: as easy as 1, 2, 3", SC'11).
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

/// The random numbers that belong to one place (a pixel, a row, a path) for one purpose (shot noise, the lens
/// sample):
///
///     RandomStream random(seed, shot_noise, pixel);
///     double electrons = random.poisson(mean);
///
/// Streams that differ in seed, purpose or place are independent; making one costs nothing. A stream lasts
/// for 2^33 numbers.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint32_t purpose, std::uint64_t place)
      : counter_{0, static_cast<std::uint32_t>(place), static_cast<std::uint32_t>(place >> 32), purpose},
        key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)} {}

  /// 64 random bits.
  std::uint64_t bits();
  /// Uniform in the open interval (0, 1): odd multiples of 2^−53, so that neither end occurs.
  double uniform();
  /// Standard normal, by inversion of the distribution function (Wichura, Algorithm AS 241 PPND16, Appl.
  /// Statist. 37 (1988) 477; relative error about 1e-16).
  double normal();
  /// Poisson of the given mean, for every mean from 0 up to 1e15: sequential inversion below 10, transformed
  /// rejection above (Hörmann, "The transformed rejection method for generating Poisson random variables",
  /// Insurance: Mathematics and Economics 12 (1993) 39, algorithm PTRS). No normal approximation at any
  /// level. A mean that is not above 0 gives 0. \throws InputError for NaN and for means above 1e15.
  double poisson(double mean);

 private:
  double poisson_by_inversion(double mean);
  double poisson_by_rejection(double mean);

  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 2> key_;
  std::uint64_t spare_ = 0;
  bool has_spare_ = false;
};

/// From this mean on Poisson numbers are drawn by rejection.
constexpr double poisson_rejection_least_mean = 10;

/// The standard normal deviate below which the share `probability` in (0, 1) of all lie; see
/// RandomStream::normal.
double normal_quantile(double probability);

}  // namespace petzval
