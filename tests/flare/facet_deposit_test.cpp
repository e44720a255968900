// SPDX-License-Identifier: BSD-3-Clause
// Areas of triangles within pixels against counted points; light that is kept.
#include <gtest/gtest.h>
#include <petzval/flare/facet_deposit.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace petzval {
namespace {

std::vector<double> deposited(const std::vector<LightFacet>& facets, int columns, int rows, int stripe) {
  std::vector<double> pixels(static_cast<std::size_t>(columns * rows));
  for (int from = 0; from < rows; from += stripe) {
    const int to = std::min(rows, from + stripe);
    deposit_facets(facets, {columns, from, to,
                            std::span(pixels).subspan(static_cast<std::size_t>(from * columns),
                                                      static_cast<std::size_t>((to - from) * columns))});
  }
  return pixels;
}

bool holds(const LightFacet& facet, double x, double y) {
  const auto side = [&](std::size_t i, std::size_t j) {
    return (facet.column[j] - facet.column[i]) * (y - facet.row[i]) -
           (x - facet.column[i]) * (facet.row[j] - facet.row[i]);
  };
  const double a = side(0, 1), b = side(1, 2), c = side(2, 0);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

LightFacet random_facet(std::mt19937_64& random, double from, double to) {
  std::uniform_real_distribution<double> place(from, to);
  LightFacet facet;
  for (std::size_t i = 0; i < 3; ++i) facet.column[i] = place(random), facet.row[i] = place(random);
  facet.flux = 1;
  return facet;
}

// 64 × 64 points in each pixel: a straight edge misses by at most one row of them, 1/64 of a pixel.
TEST(FacetDeposit, SharesAreTheAreasWithinPixels) {
  constexpr int size = 12, points = 64;
  std::mt19937_64 random(3);
  for (int run = 0; run < 40; ++run) {
    const LightFacet facet = random_facet(random, -4, size + 4);
    const double area = 0.5 * std::abs((facet.column[1] - facet.column[0]) * (facet.row[2] - facet.row[0]) -
                                       (facet.column[2] - facet.column[0]) * (facet.row[1] - facet.row[0]));
    if (area < 0.5) continue;
    const std::vector<double> pixels = deposited({facet}, size, size, 5);
    for (int row = 0; row < size; ++row)
      for (int column = 0; column < size; ++column) {
        int inside = 0;
        for (int j = 0; j < points; ++j)
          for (int i = 0; i < points; ++i)
            inside += holds(facet, column + (i + 0.5) / points, row + (j + 0.5) / points) ? 1 : 0;
        EXPECT_NEAR(pixels[static_cast<std::size_t>(row * size + column)] * area,
                    double(inside) / (points * points), 2.0 / points)
            << run << " " << row << " " << column;
      }
  }
}

TEST(FacetDeposit, KeepsAllLightOfWhatLiesInside) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> small(-1e-9, 1e-9);
  for (int run = 0; run < 300; ++run) {
    LightFacet facet = random_facet(random, 0, 40);
    if (run % 3 == 1)  // flat to nothing
      for (std::size_t i = 0; i < 3; ++i) facet.row[i] = 20.3 + 0.1 * facet.column[i] + small(random);
    if (run % 3 == 2)  // within a pixel, or nearly
      for (std::size_t i = 0; i < 3; ++i)
        facet.row[i] = 7.99 + 1e-3 * facet.row[i], facet.column[i] = 3.99 + 1e-3 * facet.column[i];
    const std::vector<double> pixels = deposited({facet}, 40, 40, 7);
    EXPECT_NEAR(std::accumulate(pixels.begin(), pixels.end(), 0.0), 1, 1e-9) << run;
    for (const double each : pixels) EXPECT_GE(each, -1e-9) << run;
  }
}

TEST(FacetDeposit, ShadesAsTheCornersSay) {
  LightFacet facet{{10, 190, 40}, {15, 60, 180}, 1, {0.2, 1.3, 1.5}};
  const std::vector<double> pixels = deposited({facet}, 200, 200, 200);
  double sum = 0, column = 0, row = 0;
  for (int r = 0; r < 200; ++r)
    for (int c = 0; c < 200; ++c) {
      const double value = pixels[static_cast<std::size_t>(r * 200 + c)];
      sum += value, column += value * (c + 0.5), row += value * (r + 0.5);
    }
  // ∫ λi λj over a triangle is area/12, of λi² area/6 (barycentric λ).
  double expected_column = 0, expected_row = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const double weight = facet.shade[i] / (i == j ? 6 : 12);
      expected_column += weight * facet.column[j];
      expected_row += weight * facet.row[j];
    }
  // Pixels at the rim have the shade of their middle: of 180 pixels across, half of one at most.
  EXPECT_NEAR(sum, 1, 2e-3);
  EXPECT_NEAR(column / sum, expected_column, 0.2);
  EXPECT_NEAR(row / sum, expected_row, 0.2);
}

TEST(FacetDeposit, DoesNotDependOnTheStripesButByRounding) {
  std::mt19937_64 random(7);
  std::vector<LightFacet> facets;
  for (int i = 0; i < 60; ++i) facets.push_back(random_facet(random, -20, 60));
  const std::vector<double> whole = deposited(facets, 40, 40, 40), parts = deposited(facets, 40, 40, 3);
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_NEAR(whole[i], parts[i], 1e-12);
}

}  // namespace
}  // namespace petzval
