// SPDX-License-Identifier: BSD-3-Clause
// What is done with a bordered band, against the same with full matrices.
#include <gtest/gtest.h>
#include <petzval/measure/sfr/bordered_band.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <random>

namespace petzval {
namespace {

/// Normal equations of random rows, and the same as a full matrix.
struct BothForms {
  BorderedBand band;
  Eigen::MatrixXd full;
};

BothForms normal_equations(int band, int border, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  BothForms both{BorderedBand(band, border), Eigen::MatrixXd::Zero(band + border, band + border)};
  for (int i = 0; i < 6 * (band + border); ++i) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(band + border);
    const int first = band == 0 ? 0 : static_cast<int>(random() % static_cast<unsigned>(band));
    for (int j = first; j < std::min(band, first + 6); ++j) row[j] = normal(random);
    for (int r = 0; r < border; ++r) row[band + r] = normal(random);
    both.full += row * row.transpose();
    for (int j = 0; j < band + border; ++j)
      for (int k = j; k < band + border; ++k)
        if (row[j] * row[k] != 0) both.band.at(k, j) += row[j] * row[k];
  }
  return both;
}

TEST(BorderedBand, DoesWhatFullMatricesDo) {
  // 1e-9 of the values: the condition of these matrices is below 1e4, that of a double 1e-16.
  for (const auto& [band, border] : {std::pair{0, 4}, {1, 4}, {5, 6}, {6, 1}, {40, 4}, {40, 6}, {40, 11}}) {
    const BothForms both = normal_equations(band, border, static_cast<unsigned>(7 * band + border));
    const int n = band + border;
    const BorderedCholesky factor(both.band);
    ASSERT_TRUE(factor.good());
    const Eigen::MatrixXd inverse = both.full.inverse();
    EXPECT_NEAR(factor.log_determinant(), std::log(both.full.determinant()), 1e-9 * n);
    BorderedBand::Block block = BorderedBand::Block::Random(n, BorderedBand::lanes);
    const std::array<double, BorderedBand::lanes> squares = both.band.quadratic(block);
    BorderedBand::Block solved = block;
    factor.solve_in_place(solved);
    for (int k = 0; k < BorderedBand::lanes; ++k) {
      const Eigen::VectorXd right = block.col(k), expected = inverse * right;
      EXPECT_LT((solved.col(k) - expected).norm(), 1e-9 * expected.norm());
      EXPECT_LT((factor.solve(right) - expected).norm(), 1e-9 * expected.norm());
      EXPECT_NEAR(squares[static_cast<std::size_t>(k)] / right.dot(both.full * right), 1, 1e-9);
    }
    const BorderedBand part = factor.inverse();
    for (int j = 0; j < n; ++j)
      for (int i = j; i < n; ++i)
        if (i >= band || i - j <= BorderedBand::width) {
          EXPECT_NEAR(part.at(i, j), inverse(i, j), 1e-9 * inverse.norm());
        }
    EXPECT_NEAR(trace_of_product(part, both.band), n, 1e-9 * n);
  }
}

TEST(BorderedBand, SaysWhatIsNotPositive) {
  BothForms both = normal_equations(20, 4, 3);
  both.band.at(10, 10) = -1;
  EXPECT_FALSE(BorderedCholesky(both.band).good());
}

}  // namespace
}  // namespace petzval
