// SPDX-License-Identifier: BSD-3-Clause
// Product convolution against the exact method, at the tolerance that was asked for.
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/imaging/exact_blur.h>
#include <petzval/imaging/product_blur.h>

#include <algorithm>
#include <cstdio>

namespace petzval {
namespace {

using namespace testing;

constexpr double grid_um = 6.25;

CellPlane blurred(const PsfField& psfs, const CellPlane& source, int margin, const ProductPlan& plan) {
  return ProductBlur(psfs, source.grid, plan).blur(source, margin);
}

TEST(LobattoNodes, ReachBothEndsAndTheirPolynomialsSumToOne) {
  for (int count = 2; count <= 6; ++count) {
    const std::vector<double> nodes = lobatto_nodes(count);
    EXPECT_EQ(nodes.front(), 0);
    EXPECT_NEAR(nodes.back(), 1, 1e-15);
    for (const double at : {0.0, 0.1, 0.5, 0.77, 1.0}) {
      double sum = 0, power = 0;
      const std::vector<double> weights = lagrange_weights(nodes, at);
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        sum += weights[a];
        power += weights[a] * std::pow(nodes[a], count - 1);
      }
      EXPECT_NEAR(sum, 1, 1e-13);
      EXPECT_NEAR(power, std::pow(at, count - 1), 1e-13) << "interpolation is exact up to this power";
    }
  }
}

// Where the PSF is the same everywhere, tiles of any size are a plain convolution: any difference is a fault
// of layout, lanes, flips, margins or wrap-around. A round spot is the same at every azimuth but for what its
// splines bend: 1e-5 of the image's norm.
TEST(ProductBlur, IsAPlainConvolutionWhereThePsfIsConstant) {
  TableRecipe recipe;
  recipe.psf = [](double, double) { return psf_of_spots({{0, 0, grid_um, grid_um, 1}}, 101, grid_um / 10); };
  const PsfField psfs(make_table(recipe), 550, grid_um);
  for (const SensorGeometry grid :
       {SensorGeometry{96, 64, grid_um}, {77, 51, grid_um}, {5, 90, grid_um}, {1, 1, grid_um}}) {
    const CellPlane source = random_plane(grid);
    const CellPlane expected = blur_exact(source, psfs, 0);
    for (const auto& [tile, nodes, transform] : {std::tuple{8, 2, 32},
                                                 {3, 3, 32},
                                                 {9, 4, 32},
                                                 {40, 2, 64},
                                                 {60, 3, 96},
                                                 {40, 5, 128},
                                                 {130, 2, 192},
                                                 {200, 2, 256},
                                                 {300, 2, 384},
                                                 {400, 3, 512}})
      EXPECT_LT(relative_l2(blurred(psfs, source, 0, {tile, nodes, transform}), expected), 1e-5)
          << grid.columns << " x " << grid.rows << " in tiles of " << tile << ", " << nodes << " nodes";
    for (const auto& [tile, nodes] : {std::pair{2, 2}, {8, 2}, {16, 3}, {50, 4}, {200, 2}})
      EXPECT_LT(relative_l2(blurred(psfs, source, 0, {tile, nodes, 0, true}), expected), 1e-5)
          << grid.columns << " x " << grid.rows << " gathered in tiles of " << tile << ", " << nodes
          << " nodes";
  }
}

class ProductAgainstExact : public ::testing::TestWithParam<double> {};

// Tiles of two cells with nodes in both (and the next tile's first): every cell has the kernel of its own
// place, at every azimuth, for PSFs that lean to one side too.
TEST_P(ProductAgainstExact, AgreesToRoundingWhenEveryCellIsANode) {
  const PsfField psfs(make_table(comatic_recipe(GetParam())), 550, 25.0);
  for (const SensorGeometry grid : {SensorGeometry{60, 44, 25.0}, {53, 37, 25.0}}) {
    const CellPlane source = random_plane(grid);
    const CellPlane exact = blur_exact(source, psfs, 2);
    EXPECT_LT(relative_l2(blurred(psfs, source, 2, {2, 3, 32}), exact), 5e-7);
    EXPECT_LT(relative_l2(blurred(psfs, source, 2, {2, 3, 0, true}), exact), 5e-7);
  }
}

// Two ways to the same sums.
TEST_P(ProductAgainstExact, GathersWhatTransformsMake) {
  const PsfField psfs(make_table(comatic_recipe(GetParam())), 550, 12.5);
  for (const SensorGeometry grid : {SensorGeometry{90, 74, 12.5}, {53, 37, 12.5}}) {
    const CellPlane source = random_plane(grid);
    for (const auto& [tile, nodes] : {std::pair{12, 2}, {20, 3}, {14, 5}})
      EXPECT_LT(relative_l2(blurred(psfs, source, 3, {tile, nodes, 0, true}),
                            blurred(psfs, source, 3, {tile, nodes, 64})),
                5e-7)
          << tile << ", " << nodes;
  }
}

// Tiles that fill some of a transform, most of it or, with the kernels about them, all.
TEST_P(ProductAgainstExact, GathersWhatTransformsOfAnySizeMake) {
  const PsfField psfs(make_table(comatic_recipe(GetParam())), 550, 12.5);
  const CellPlane source = random_plane({230, 174, 12.5});
  for (const int transform : TileTransform::sizes)
    for (const int tile : {transform / 5, transform / 2, transform - 2 * psfs.radius()})
      EXPECT_LT(relative_l2(blurred(psfs, source, 3, {tile, 2, 0, true}),
                            blurred(psfs, source, 3, {tile, 2, transform})),
                5e-7)
          << tile << " of " << transform;
}

// Cells of a ring have kernels of their own: all cells, and it is the exact method; the outer half, and the
// error is the inner half's.
TEST_P(ProductAgainstExact, AgreesWhereCellsHaveKernelsOfTheirOwn) {
  const PsfField psfs(make_table(comatic_recipe(GetParam())), 550, 12.5);
  for (const SensorGeometry grid : {SensorGeometry{90, 74, 12.5}, {53, 37, 12.5}}) {
    const CellPlane source = random_plane(grid);
    const CellPlane exact = blur_exact(source, psfs, 3);
    ProductPlan plan{30, 2, 64};
    const double coarse = relative_l2(blurred(psfs, source, 3, plan), exact);
    EXPECT_GT(coarse, 1e-3);
    plan.exact = {0, 1000};
    EXPECT_LT(relative_l2(blurred(psfs, source, 3, plan), exact), 3e-7);
    plan.exact = {20, 1000};
    EXPECT_LT(relative_l2(blurred(psfs, source, 3, plan), exact), 0.8 * coarse);
  }
}

INSTANTIATE_TEST_SUITE_P(Lean, ProductAgainstExact, ::testing::Values(0.0, 0.6));

/// A table whose PSF changes from a sharp point to a strong coma over half the frame of 120 × 91 cells.
TableRecipe strong_recipe(double lean) {
  TableRecipe recipe = comatic_recipe(lean);
  recipe.fields.clear();
  for (int field = 0; field <= 20; ++field) recipe.fields.push_back(field);
  recipe.height_mm = [](double field, double) { return 1.3 * std::tan(radians(field)); };
  recipe.psf = [lean](double field, double) {
    const double share = field / 20, tail_um = 12 * share;
    return psf_of_spots({{0, 0, 3, 3, 1},
                         {lean * tail_um / 2, tail_um / 2, 3 + 2 * share, 3 + 2 * share, 0.8},
                         {lean * tail_um, tail_um, 3 + 4 * share, 3 + 3 * share, 0.5}},
                        49, 1.5);
  };
  return recipe;
}

TEST(ProductBlur, KeepsTheToleranceAskedFor) {
  for (const double lean : {0.0, 0.6}) {
    const PsfField psfs(make_table(strong_recipe(lean)), 550, grid_um);
    for (const CellPlane& source : {texture({120, 91, grid_um}), tilted_checkerboard({120, 91, grid_um})}) {
      const CellPlane exact = blur_exact(source, psfs, 0);
      for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        const auto plan = plan_product(psfs, source.grid, {tolerance});
        ASSERT_TRUE(plan) << tolerance;
        const double error = relative_l2(blurred(psfs, source, 0, *plan), exact);
        std::printf("tolerance %g: %d nodes, tiles of %d, transforms of %d, estimated %.2e, measured %.2e\n",
                    tolerance, plan->nodes, plan->tile, plan->transform, plan->estimated_error, error);
        EXPECT_LE(error, tolerance);
        EXPECT_LE(plan->estimated_error, tolerance);
      }
    }
  }
}

// Kernels go on without a jump from tile to tile, and so does the error: the difference image steps as much
// across the borders of tiles as within them.
TEST(ProductBlur, HasNoSeams) {
  const PsfField psfs(make_table(strong_recipe(0.6)), 550, grid_um);
  const CellPlane source = texture({200, 120, grid_um});
  const CellPlane exact = blur_exact(source, psfs, 0);
  constexpr int tile = 10;
  const CellPlane image = blurred(psfs, source, 0, {tile, 2, 64});
  double across = 0, inside = 0;
  int borders = 0, others = 0;
  for (int row = 0; row < 120; ++row)
    for (int column = 1; column < 200; ++column) {
      const auto at = static_cast<std::size_t>(row * 200 + column);
      const double step = (double(image.values[at]) - double(exact.values[at])) -
                          (double(image.values[at - 1]) - double(exact.values[at - 1]));
      const bool border = (column - 100) % tile == 0;  // tiles begin at the axis
      (border ? across : inside) += step * step;
      ++(border ? borders : others);
    }
  const double ratio = std::sqrt((across / borders) / (inside / others));
  std::printf("RMS step across borders / within tiles: %.3f\n", ratio);
  EXPECT_GT(inside, 0);
  EXPECT_LT(ratio, 1.5);
}

TEST(ProductBlur, KeepsTheEnergyOfLightThatStaysInside) {
  const PsfField psfs(make_table(strong_recipe(0.6)), 550, grid_um);
  CellPlane source = texture({100, 75, grid_um});
  const auto radius = static_cast<std::size_t>(psfs.radius());
  for (std::size_t row = 0; row < source.rows(); ++row)
    for (std::size_t column = 0; column < source.columns(); ++column)
      if (row < radius || column < radius || row + radius >= source.rows() ||
          column + radius >= source.columns())
        source.row(row)[column] = 0;
  // Weights and kernels sum to 1 to float rounding, at random.
  for (const int nodes : {2, 3, 5})
    EXPECT_NEAR(sum_of(blurred(psfs, source, 0, {12, nodes, 64})) / sum_of(source), 1, 1e-6) << nodes;
}

TEST(ProductBlur, GivesTheSameBytesForAnyNumberOfThreads) {
  const PsfField psfs(make_table(comatic_recipe(0.6)), 550, grid_um);
  const CellPlane source = random_plane({411, 260, grid_um});
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return blurred(psfs, source, 3, {12, 3, 64}).values;
  };
  EXPECT_EQ(with_threads(1), with_threads(2));
}

// From four lanes to sixteen, whichever this machine can: the layout of tiles and kernels follows their
// number, the image must not.
TEST(ProductBlur, IsTheSameOnEveryInstructionSet) {
  const PsfField psfs(make_table(comatic_recipe(0.6)), 550, grid_um);
  const CellPlane source = random_plane({131, 90, grid_um});
  const ProductPlan plans[] = {{12, 3, 64},   {30, 2, 64},   {50, 3, 96},   {70, 4, 128},    {130, 2, 192},
                               {100, 2, 256}, {300, 2, 384}, {300, 2, 512}, {12, 3, 0, true}};
  std::vector<CellPlane> expected;
  for (const ProductPlan& plan : plans) expected.push_back(blurred(psfs, source, 3, plan));
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    for (std::size_t i = 0; i < std::size(plans); ++i)
      EXPECT_LT(relative_l2(blurred(psfs, source, 3, plans[i]), expected[i]), 5e-7)
          << hwy::TargetName(target) << ", " << lane_count() << " lanes, transforms of "
          << plans[i].transform;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

// The plan of a band serves the next, by the error at a few places; that must be the error at all of them,
// to a tenth, even where PSFs have changed by a fifth; two places tell it to three tenths.
TEST(ProductPlan, IsKeptByANeighbourWhoseErrorIsKnown) {
  const SensorGeometry grid{411, 260, grid_um};
  TableRecipe recipe = comatic_recipe();
  recipe.wavelengths_nm = {450, 550, 650};
  recipe.psf = [](double field, double nm) { return comatic_psf(field / 20 * nm / 550); };
  const LensDataTable table = make_table(recipe);
  const PsfField here(table, 550, grid_um);
  const std::optional<ProductPlan> plan = plan_product(here, grid, {1e-3});
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->error_at_places.rms, kernel_error(here, grid, plan->tile, plan->nodes).rms);
  for (const double nm : {540.0, 500.0, 620.0}) {
    const PsfField there(table, nm, grid_um);
    const KernelError exact = kernel_error(there, grid, plan->tile, plan->nodes);
    const KernelError alike = kernel_error_like(plan->error_at_places, there, grid, plan->tile, plan->nodes);
    EXPECT_NEAR(alike.rms / exact.rms, 1, 0.1) << nm;
    EXPECT_EQ(alike.first_squares, exact.first_squares) << nm;
    const KernelError by_two =
        kernel_error_like(plan->error_at_places, there, grid, plan->tile, plan->nodes, 2);
    EXPECT_NEAR(by_two.rms / exact.rms, 1, 0.3) << nm;
  }
}

TEST(ProductBlur, LeavesWhatIsTooLargeForItsTransformsToSections) {
  const PsfField psfs(make_table(comatic_recipe()), 550, 0.085);  // kernels of 1,090 cells
  ASSERT_GT(2 * psfs.radius(), TileTransform::largest);
  const SensorGeometry grid{40, 30, 0.085};
  EXPECT_FALSE(plan_product(psfs, grid, {1e-3}));
  const ProductPlan plan = plan_blended(psfs, grid, {1e-3});
  EXPECT_EQ(plan.transform, 0);
  EXPECT_LE(plan.estimated_error, 1e-3);
}

// Transfer functions that are made for some rows of tiles at a time are those that all would be.
TEST_P(ProductAgainstExact, MakesKernelsRowByRowWhereTheyWouldTakeTooMuchMemory) {
  const PsfField psfs(make_table(comatic_recipe(GetParam())), 550, 12.5);
  const CellPlane source = random_plane({90, 174, 12.5});
  for (const auto& [tile, nodes] : {std::pair{20, 2}, {14, 3}}) {
    ProductPlan plan{tile, nodes, 64};
    const CellPlane whole = blurred(psfs, source, 3, plan);
    for (const int rows : {1, 2, 4, 100}) {
      plan.rows_held = rows;
      EXPECT_LT(relative_l2(blurred(psfs, source, 3, plan), whole), 5e-7) << rows << " rows of " << tile;
    }
  }
}

/// Large pictures through PSFs that change fast need many kernels: to make them row by row is better than
/// sections, each of which makes its own transform (five times the time for 12 megapixels at f/2).
TEST(ProductPlan, MakesKernelsRowByRowBeforeItFallsBackToSections) {
  const PsfField psfs(make_table(comatic_recipe()), 550, 0.4);
  const SensorGeometry grid{9000, 7000, 0.4};
  ASSERT_LT(2 * psfs.radius(), TileTransform::largest / 2);
  const std::optional<ProductPlan> plan = plan_product(psfs, grid, {1e-4});
  ASSERT_TRUE(plan);
  EXPECT_GT(plan->rows_held, 0) << "a grid that needs it";
  EXPECT_LE(plan->kernel_bytes, 400e6);
  EXPECT_LE(plan->estimated_error, 1e-4);
}

TEST(ProductOptions, RefusesNonsense) {
  for (const ProductOptions& options : {ProductOptions{0},
                                        {1e-7},
                                        {2},
                                        {NAN},
                                        {1e-3, 1},
                                        {1e-3, 9},
                                        {1e-3, 0, 1},
                                        {1e-3, 0, 1100},
                                        {1e-3, -2}})
    EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace petzval
