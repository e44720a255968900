// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/imaging/nearest_sample.h>

#include <limits>
#include <random>

namespace petzval {
namespace {

std::int64_t squared_distance(std::size_t a, std::size_t b, std::int64_t columns) {
  const auto across = static_cast<std::int64_t>(a) % columns - static_cast<std::int64_t>(b) % columns;
  const auto down = static_cast<std::int64_t>(a) / columns - static_cast<std::int64_t>(b) / columns;
  return across * across + down * down;
}

// Against a search through all of them.
TEST(NearestSamples, AreNoFartherThanAnyOther) {
  std::mt19937 random(3);
  for (const double share : {0.5, 0.05, 0.002}) {
    constexpr int columns = 37, rows = 29;
    std::vector<std::uint8_t> wanted(columns * rows);
    for (std::uint8_t& flag : wanted) flag = std::generate_canonical<double, 32>(random) < share ? 1 : 0;
    wanted[500] = 1;
    const std::vector<std::uint32_t> nearest = nearest_samples(columns, rows, wanted);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      ASSERT_EQ(wanted[nearest[i]], 1);
      std::int64_t least = std::numeric_limits<std::int64_t>::max();
      for (std::size_t j = 0; j < wanted.size(); ++j)
        if (wanted[j] != 0) least = std::min(least, squared_distance(i, j, columns));
      EXPECT_EQ(squared_distance(i, nearest[i], columns), least) << i;
    }
  }
}

TEST(NearestSamples, RefusesToFindWhatIsNotThere) {
  const std::vector<std::uint8_t> wanted(12);
  EXPECT_THROW(nearest_samples(4, 3, wanted), InputError);
  EXPECT_THROW(nearest_samples(4, 4, wanted), InputError);
}

}  // namespace
}  // namespace petzval
