// SPDX-License-Identifier: BSD-3-Clause
// Owen-scrambled Sobol points.
#pragma once

#include <array>
#include <cstdint>

namespace petzval {

/// Coordinate 0 … 3 of point `index` of the Sobol sequence, as a fixed-point number of 32 bits (Joe & Kuo
/// 2008).
std::uint32_t sobol(std::uint32_t index, int dimension);

/// Nested uniform (Owen) scrambling of the 32 binary digits, the permutations taken from a hash of `seed`
/// (Laine & Karras 2011, with the constants of Vegdahl 2021).
std::uint32_t owen_scrambled(std::uint32_t digits, std::uint32_t seed);

/// A well mixed 32-bit hash of two numbers, for making seeds.
inline std::uint32_t hashed(std::uint32_t a, std::uint32_t b) {
  std::uint64_t x = (static_cast<std::uint64_t>(a) << 32) ^ b;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return static_cast<std::uint32_t>((x ^ (x >> 31)) >> 32);
}

/// Of each of the four dimensions, digits by which a set of points is shifted before it is scrambled.
using DigitalShifts = std::array<std::uint32_t, 4>;

constexpr int most_shifted_sets = 8;
/// Shifts of point set `set` out of `sets` that share their seeds, so that they fill each other's gaps: the
/// first 2^n points of each together have one point in each of 2^n·sets intervals of every dimension, and
/// nearly so in boxes of dimensions 0 to 2. That holds if `sets` is a power of two, and up to 4096 points of
/// all sets; with more, dimensions 1 to 3 gain no finer intervals. Each set is a Sobol sequence for itself.
/// Sets `most_shifted_sets` apart have the same shifts: give them other seeds.
const DigitalShifts& digital_shifts(int set, int sets);

/// Numbers in [0, 1) for one sample of a pixel: every call takes the next dimensions. Sets of up to four
/// dimensions are Sobol points stratified together; different sets are independent permutations of the same
/// samples (Burley, "Practical hash-based Owen scrambling", JCGT 9 (2020) 4).
///
///     SobolSample sample(hashed(pixel, seed), index);   // the index-th of the samples of that pixel
///     const auto [u, v] = sample.next2();
class SobolSample {
 public:
  SobolSample(std::uint32_t seed, std::uint32_t index, const DigitalShifts& shifts = digital_shifts(0, 1))
      : shifts_(&shifts), seed_(seed), index_(index) {}

  double next1();
  std::array<double, 2> next2();
  std::array<double, 3> next3();
  std::array<double, 4> next4();
  /// As one of these, for numbers that nobody wants.
  void skip() { ++set_; }

 private:
  template <std::size_t Count>
  std::array<double, Count> next();

  const DigitalShifts* shifts_;
  std::uint32_t seed_, index_, set_ = 0;
};

}  // namespace petzval
