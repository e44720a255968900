// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/numeric/nonuniform_fft.h>

#include <cmath>
#include <map>
#include <random>

namespace petzval {
namespace {

using Column = std::vector<std::complex<double>>;

PointMasses random_points(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-1.5, 2.5), mass(-1, 1);
  PointMasses points;
  for (int i = 0; i < count; ++i) points.add(anywhere(random), anywhere(random), mass(random));
  return points;
}

std::map<int, Column> transform(const PointMasses& points, int k_max, int l_max, int period,
                                std::size_t bytes) {
  std::vector<Column> columns(static_cast<std::size_t>(k_max) + 1);
  NonuniformFft2(k_max, l_max)
      .transform(points, period, bytes, [&](int k, std::span<const std::complex<double>> f) {
        EXPECT_TRUE(columns[static_cast<std::size_t>(k)].empty()) << "visited twice: " << k;
        columns[static_cast<std::size_t>(k)].assign(f.begin(), f.end());
      });
  std::map<int, Column> result;
  for (std::size_t k = 0; k < columns.size(); ++k) result[static_cast<int>(k)] = columns[k];
  return result;
}

TEST(NonuniformFft, IsTheSumThatItSaysItIs) {
  const PointMasses points = random_points(60);
  const int k_max = 23, l_max = 17;
  const auto columns = transform(points, k_max, l_max, 10, 1 << 20);
  double error = 0, size = 0;
  for (int k = 0; k <= k_max; ++k)
    for (int l = -l_max; l <= l_max; ++l) {
      std::complex<double> sum = 0;
      for (std::size_t j = 0; j < points.size(); ++j)
        sum += points.mass[j] * std::polar(1.0, -2 * pi * (k * points.x[j] + l * points.y[j]));
      const auto& column = columns.at(k);
      ASSERT_EQ(column.size(), 35u);
      error += std::norm(column[static_cast<std::size_t>(l + l_max)] - sum);
      size += std::norm(sum);
    }
  // The kernel's own error goes as exp(−π w √(1 − 1/σ)) = 1e-11, with a factor of a few.
  EXPECT_LT(std::sqrt(error / size), 1e-10);
}

TEST(NonuniformFft, OneDimensionIsTheSumToo) {
  const PointMasses points = random_points(40);
  const std::vector<std::complex<double>> line = nonuniform_fft(points.y, points.mass, 30);
  ASSERT_EQ(line.size(), 31u);
  for (std::size_t l = 0; l < line.size(); ++l) {
    std::complex<double> sum = 0;
    for (std::size_t j = 0; j < points.size(); ++j)
      sum += points.mass[j] * std::polar(1.0, -2 * pi * static_cast<double>(l) * points.y[j]);
    EXPECT_LT(std::abs(line[l] - sum), 1e-10);
  }
}

TEST(NonuniformFft, PassesAndThreadsChangeNothing) {
  const PointMasses points = random_points(300);
  const auto whole = transform(points, 40, 31, 16, std::size_t{1} << 30);
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{5000}}) {
    const auto passes = transform(points, 40, 31, 16, bytes);
    EXPECT_EQ(whole, passes) << bytes << " bytes";
  }
  const ThreadLimit one(1);
  EXPECT_EQ(whole, transform(points, 40, 31, 16, std::size_t{1} << 30));
}

TEST(NonuniformFft, VisitsAliasesInOrderOnOneThread) {
  const PointMasses points = random_points(10);
  for (const int period : {1, 2, 7, 10}) {
    std::vector<std::vector<int>> order(static_cast<std::size_t>(period));
    NonuniformFft2(33, 3).transform(points, period, 2000, [&](int k, std::span<const std::complex<double>>) {
      order[static_cast<std::size_t>(std::min(k % period, (period - k % period) % period))].push_back(k);
    });
    std::size_t visits = 0;
    for (const auto& group : order) {
      EXPECT_TRUE(std::is_sorted(group.begin(), group.end()));
      visits += group.size();
    }
    EXPECT_EQ(visits, 34u) << "period " << period;
  }
}

TEST(NonuniformFft, RefusesSizesThatNoMemoryHolds) {
  EXPECT_THROW(NonuniformFft2(-1, 3), InputError);
  EXPECT_THROW(NonuniformFft2(1 << 30, 3), InputError);
}

}  // namespace
}  // namespace petzval
