// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/numeric/sobol.h>

#include <algorithm>
#include <bit>

namespace petzval {

namespace {

constexpr int dimensions = 4;
constexpr double unit = 0x1p-32;

using DirectionNumbers = std::array<std::uint32_t, 32>;

/// Degree and coefficients of the primitive polynomials and the first odd numbers m of dimensions 2 to 4 (Joe
/// & Kuo, SIAM J. Sci. Comput. 30 (2008) 2635: new-joe-kuo-6).
struct Primitive {
  int degree;
  std::uint32_t coefficients;
  std::array<std::uint32_t, 3> m;
};
constexpr std::array<Primitive, 3> primitives{{{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}}};

constexpr DirectionNumbers direction_numbers(int dimension) {
  DirectionNumbers v{};
  if (dimension == 0) {
    for (int i = 0; i < 32; ++i) v[static_cast<std::size_t>(i)] = 1u << (31 - i);
    return v;
  }
  const Primitive primitive = primitives[static_cast<std::size_t>(dimension - 1)];
  const int s = primitive.degree;
  for (int i = 0; i < 32; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (i < s) {
      v[at] = primitive.m[at] << (31 - i);
      continue;
    }
    const std::uint32_t back = v[at - static_cast<std::size_t>(s)];
    v[at] = back ^ (back >> s);
    for (int k = 1; k < s; ++k)
      if (primitive.coefficients >> (s - 1 - k) & 1) v[at] ^= v[at - static_cast<std::size_t>(k)];
  }
  return v;
}

constexpr std::uint32_t reversed_bits(std::uint32_t x) {
#if defined(__GNUC__)
  x = __builtin_bswap32(x);
#else
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
#endif
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// The exclusive or of the direction numbers of all bits of each byte of an index. Scrambling works on digits
/// in reverse, and its result is the next index: so everything here is kept in reverse, index and numbers.
using ByteTables = std::array<std::array<std::array<std::uint32_t, 256>, 4>, dimensions>;

constexpr ByteTables make_reversed_tables() {
  ByteTables tables{};
  for (int d = 0; d < dimensions; ++d) {
    const DirectionNumbers v = direction_numbers(d);
    for (std::size_t byte = 0; byte < 4; ++byte)
      for (std::size_t value = 0; value < 256; ++value)
        for (std::size_t bit = 0; bit < 8; ++bit)
          if (value >> bit & 1)
            tables[static_cast<std::size_t>(d)][byte][value] ^= reversed_bits(v[31 - (8 * byte + bit)]);
  }
  return tables;
}

constexpr ByteTables reversed_tables = make_reversed_tables();

/// sobol() in reverse, of an index in reverse.
std::uint32_t reversed_sobol(std::uint32_t index, int dimension) {
  const auto& table = reversed_tables[static_cast<std::size_t>(dimension)];
  return table[0][index & 255] ^ table[1][index >> 8 & 255] ^ table[2][index >> 16 & 255] ^
         table[3][index >> 24];
}

/// owen_scrambled() of digits in reverse, in reverse.
std::uint32_t scrambled_in_reverse(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

constexpr int most_shift_bits = 3;
constexpr std::uint32_t all = 0xffffffff;
/// For two, four and eight sets: by dimension, the shift (in reverse) of each binary digit of a set's number.
/// Those of dimension 0 are columns of Pascal's triangle modulo two, so that no interval is taken twice. The
/// others were searched digit by digit for small t of the digital nets that 2^n points of all sets are
/// together (Niederreiter 1987), by the ranks of their generator matrices up to 12 digits: first of
/// dimensions 0 and 1, and 0 to 2, which choose and sample lights; then of 2 and 3, and of the other pairs.
constexpr std::uint32_t shift_digits[most_shift_bits][dimensions][most_shift_bits]{
    {{all}, {all}, {all}, {all}},
    {{all, 0xaaaaaaaa}, {0xbdb, 0x56d}, {0xb55, 0x5fe}, {0xab6, 0xf5b}},
    {{all, 0xaaaaaaaa, 0xcccccccc}, {0xd55, 0xbf2, 0x4cb}, {0x692, 0xfa9, 0x5cd}, {0x539, 0xcdf, 0xbaa}}};

using ShiftTables = std::array<std::array<DigitalShifts, 1 << most_shift_bits>, most_shift_bits + 1>;

constexpr ShiftTables make_shifts() {
  ShiftTables tables{};
  for (std::size_t bits = 1; bits <= most_shift_bits; ++bits)
    for (std::size_t set = 0; set < 1u << bits; ++set)
      for (std::size_t d = 0; d < dimensions; ++d)
        for (std::size_t bit = 0; bit < bits; ++bit)
          if (set >> bit & 1) tables[bits][set][d] ^= shift_digits[bits - 1][d][bit];
  return tables;
}

constexpr ShiftTables shifts_by_bits = make_shifts();

}  // namespace

const DigitalShifts& digital_shifts(int set, int sets) {
  const auto bits = std::min<std::size_t>(std::bit_width(static_cast<unsigned>(sets - 1)), most_shift_bits);
  return shifts_by_bits[bits][static_cast<std::size_t>(set) & ((1u << bits) - 1)];
}

std::uint32_t sobol(std::uint32_t index, int dimension) {
  return reversed_bits(reversed_sobol(reversed_bits(index), dimension));
}

std::uint32_t owen_scrambled(std::uint32_t digits, std::uint32_t seed) {
  return reversed_bits(scrambled_in_reverse(reversed_bits(digits), seed));
}

template <std::size_t Count>
std::array<double, Count> SobolSample::next() {
  const std::uint32_t set_seed = hashed(seed_, set_++);
  const std::uint32_t shuffled = scrambled_in_reverse(reversed_bits(index_), set_seed);
  std::array<double, Count> point;
  for (std::size_t d = 0; d < Count; ++d)
    point[d] = unit * reversed_bits(scrambled_in_reverse(
                          reversed_sobol(shuffled, static_cast<int>(d)) ^ (*shifts_)[d],
                          hashed(set_seed, 0x9e3779b9u + static_cast<std::uint32_t>(d))));
  return point;
}

double SobolSample::next1() {
  return next<1>()[0];
}
std::array<double, 2> SobolSample::next2() {
  return next<2>();
}
std::array<double, 3> SobolSample::next3() {
  return next<3>();
}
std::array<double, 4> SobolSample::next4() {
  return next<4>();
}

}  // namespace petzval
