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

}  // namespace
}  // namespace petzval
