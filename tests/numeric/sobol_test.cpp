// SPDX-License-Identifier: BSD-3-Clause
// Sobol points and their scrambling: stratification is exact, and integrals converge faster than at random.
#include <gtest/gtest.h>
#include <petzval/numeric/sobol.h>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace petzval {
namespace {

/// The first points of Joe & Kuo's new-joe-kuo-6 in natural order, by hand.
TEST(Sobol, FirstPoints) {
  const double unit = 0x1p-32;
  const double points[4][4] = {
      {0, 0, 0, 0}, {0.5, 0.5, 0.5, 0.5}, {0.25, 0.75, 0.75, 0.75}, {0.75, 0.25, 0.25, 0.25}};
  for (std::uint32_t i = 0; i < 4; ++i)
    for (int d = 0; d < 4; ++d) EXPECT_DOUBLE_EQ(sobol(i, d) * unit, points[i][d]) << i << " " << d;
}

/// Each of 2^k intervals, and each of 2^a × 2^(k−a) boxes of the first two dimensions, holds one of 2^k
/// points, scrambled or not.
TEST(Sobol, EveryElementaryIntervalHoldsOnePoint) {
  constexpr int k = 8;
  for (const std::uint32_t seed : {1u, 77u, 123456u})
    for (int a = 0; a <= k; ++a) {
      std::set<std::pair<int, int>> boxes;
      for (std::uint32_t i = 0; i < (1u << k); ++i) {
        const auto [x, y] = SobolSample(seed, i).next2();
        ASSERT_TRUE(x >= 0 && x < 1 && y >= 0 && y < 1);
        boxes.emplace(static_cast<int>(x * (1 << a)), static_cast<int>(y * (1 << (k - a))));
      }
      EXPECT_EQ(boxes.size(), 1u << k) << seed << " " << a;
    }
}

/// Points of several sets together.
std::vector<std::array<double, 4>> points_together(int sets, std::uint32_t count) {
  std::vector<std::array<double, 4>> points;
  for (int set = 0; set < sets; ++set)
    for (std::uint32_t i = 0; i < count; ++i)
      points.push_back(SobolSample(123456u, i, digital_shifts(set, sets)).next4());
  return points;
}

// As digital_shifts() says: intervals that are all taken once, whatever the number of points; and boxes of
// 2, 4 and 8 times the volume that a point has on average, each with as many points. Each set alone is as
// good as one without a shift.
TEST(Sobol, ShiftedSetsFillEachOthersGaps) {
  for (const int sets : {2, 4, 8})
    for (int k = 0; (sets << k) <= 4096; ++k) {
      const std::uint32_t count = 1u << k;
      const int all = static_cast<int>(count) * sets;
      const auto points = points_together(sets, count);
      for (const std::size_t d : {0, 1, 2, 3}) {
        std::set<int> taken;
        for (const auto& p : points) taken.insert(static_cast<int>(p[d] * all));
        EXPECT_EQ(taken.size(), points.size()) << sets << " sets of " << count << ", dimension " << d;
      }
      if (k > 8) continue;  // of boxes no more is said
      for (int across = sets; across <= all; across *= 2) {
        std::map<std::pair<int, int>, int> boxes;
        for (const auto& p : points)
          ++boxes[{static_cast<int>(p[0] * across / sets), static_cast<int>(p[1] * all / across)}];
        for (const auto& [box, held] : boxes)
          ASSERT_EQ(held, sets) << sets << " sets of " << count << ", " << across;
      }
      std::set<std::pair<int, int>> alone;
      const int wide = 1 << k / 2, high = 1 << (k - k / 2);
      for (auto p = points.end() - count; p != points.end(); ++p)
        alone.emplace(static_cast<int>((*p)[0] * wide), static_cast<int>((*p)[1] * high));
      EXPECT_EQ(alone.size(), count);
    }
}

// Of a function that all sets see, four sets of 16 are quieter than four that do not know of each other,
// which have a fourth of the variance of one.
TEST(Sobol, ShiftedSetsAreQuieterTogether) {
  const auto variance = [](auto&& sum_of) {
    constexpr int seeds = 400;
    double squares = 0;
    for (std::uint32_t seed = 0; seed < seeds; ++seed) squares += std::pow(sum_of(seed) - 1, 2) / seeds;
    return squares;
  };
  const auto sum = [](std::uint32_t seed, std::uint32_t count, int set, int sets) {
    double total = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto p = SobolSample(seed, i, digital_shifts(set, sets)).next3();
      total += 8 * p[0] * p[1] * p[2] / count;
    }
    return total;
  };
  const double one_of_16 = variance([&](auto seed) { return sum(seed, 16, 0, 1); });
  const double four_of_16 = variance([&](auto seed) {
    double total = 0;
    for (int set = 0; set < 4; ++set) total += sum(seed, 16, set, 4) / 4;
    return total;
  });
  EXPECT_LT(four_of_16, 0.75 * one_of_16 / 4);
}

TEST(Sobol, SetsAndSeedsAreIndependent) {
  double covariance = 0, between_seeds = 0;
  constexpr int count = 4096;
  for (std::uint32_t i = 0; i < count; ++i) {
    SobolSample sample(5, i), other(6, i);
    const double x = sample.next1() - 0.5, y = sample.next1() - 0.5, z = other.next1() - 0.5;
    covariance += x * y / count, between_seeds += x * z / count;
  }
  // 1/12 each, were they the same; random pairs scatter by 1/(12·64).
  EXPECT_LT(std::abs(covariance), 5.0 / (12 * 64));
  EXPECT_LT(std::abs(between_seeds), 5.0 / (12 * 64));
}

/// χ² of scrambled digits over seeds: each of 64 values of the top six digits is equally likely.
TEST(Sobol, ScramblingIsUniform) {
  for (const std::uint32_t index : {0u, 1u, 12345u}) {
    constexpr int seeds = 64000;
    std::array<double, 64> counts{};
    for (std::uint32_t seed = 0; seed < seeds; ++seed)
      counts[owen_scrambled(sobol(index, 1), hashed(seed, 9)) >> 26] += 1;
    double chi2 = 0;
    for (const double count : counts)
      chi2 += (count - seeds / 64.0) * (count - seeds / 64.0) / (seeds / 64.0);
    EXPECT_LT(chi2, 63 + 5 * std::sqrt(2 * 63.0));
  }
}

/// The error of a smooth integral over 4 dimensions falls faster than 1/√n.
TEST(Sobol, IntegratesBetterThanChance) {
  constexpr std::uint32_t count = 4096;
  double squares = 0;
  for (std::uint32_t seed = 0; seed < 16; ++seed) {
    double sum = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto p = SobolSample(seed, i).next4();
      sum += 16 * p[0] * p[1] * p[2] * p[3] / count;
    }
    squares += (sum - 1) * (sum - 1) / 16;
  }
  // Chance: √((4/3)^4 − 1)/64 = 0.023.
  EXPECT_LT(std::sqrt(squares), 0.002);
}

}  // namespace
}  // namespace petzval
