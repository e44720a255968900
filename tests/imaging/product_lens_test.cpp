// SPDX-License-Identifier: BSD-3-Clause
// Product convolution with the PSFs of real lenses: the tolerance that was asked for, against the exact
// method.
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/imaging/exact_blur.h>
#include <petzval/imaging/product_blur.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/build.h>

#include <cstdio>

namespace petzval {
namespace {

using namespace testing;

class ProductOfLens : public ::testing::TestWithParam<const char*> {};

TEST_P(ProductOfLens, KeepsTheToleranceAskedFor) {
  constexpr double nm = 550;
  TableOptions options;
  options.wavelengths_nm = {nm};
  options.largest_psf_size = 96;  // the blur is the same task with fewer samples
  const LensDataTable table = build_lens_data_table(read_lens(GetParam()).lens, options);
  // The whole field on few cells: the exact method is slow.
  constexpr int columns = 72, rows = 53;
  const double pitch_um = 2000 * table.real_image_height_mm.back() / std::hypot(columns, rows);
  const PsfField psfs(table, nm, pitch_um, PsfInterpolation::psf, LightCentres(table));
  for (const CellPlane& source :
       {texture({columns, rows, pitch_um}), tilted_checkerboard({columns, rows, pitch_um})}) {
    const CellPlane exact = blur_exact(source, psfs, 0);
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
      const auto plan = plan_product(psfs, source.grid, {tolerance});
      ASSERT_TRUE(plan) << tolerance;
      const double error = relative_l2(ProductBlur(psfs, source.grid, *plan).blur(source, 0), exact);
      std::printf("%s, tolerance %g: %d nodes, tiles of %d, exact from %.1f, estimated %.2e, measured %.2e\n",
                  GetParam(), tolerance, plan->nodes, plan->tile, plan->exact.from, plan->estimated_error,
                  error);
      EXPECT_LE(error, tolerance);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bundled, ProductOfLens,
                         ::testing::Values("edmund-54852", "dgauss-50mm", "fisheye-10mm"));

/// Just inside its last field this lens's pupil closes within a few cells. To give cells there kernels of
/// their own must not cost more than the rest of the picture: those beyond the picture count, whose light
/// reaches in.
TEST(ProductPlan, GivesFewCellsKernelsOfTheirOwn) {
  constexpr double nm = 430, least_ns_of_weight = 2, cell_um = 1.875;
  TableOptions options;
  options.wavelengths_nm = {420, nm, 440};
  options.max_image_height_mm = 3;
  Lens lens = read_lens("edmund-54852").lens;
  lens.surfaces.back().thickness_mm -= 0.015;
  const LensDataTable table = build_lens_data_table(lens, options);
  const PsfField psfs(table, nm, cell_um, PsfInterpolation::psf, LightCentres(table));
  const int margin = psfs.radius();
  const SourceGrid grid({2560 + 2 * margin, 1920 + 2 * margin, cell_um}, margin);
  const auto plan = plan_product(psfs, grid, {1e-3});
  ASSERT_TRUE(plan);
  double cells = 0;
  for (int row = 0; row < grid.cells.rows; ++row)
    for (int column = 0; column < grid.cells.columns; ++column)
      cells += plan->exact.holds(
                   std::hypot(column + 0.5 - grid.cells.columns / 2.0, row + 0.5 - grid.cells.rows / 2.0))
                   ? 1
                   : 0;
  const double weights = std::pow(2 * margin + 1, 2);
  EXPECT_LE(cells * weights * least_ns_of_weight, plan->filter_ns + plan->kernels_ns);
  EXPECT_EQ(cells > 0, plan->exact_ns > 0);
}

}  // namespace
}  // namespace petzval
