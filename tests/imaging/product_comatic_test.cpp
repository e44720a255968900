// SPDX-License-Identifier: BSD-3-Clause
// Product convolution with strong coma that leans to one side, as in no centred lens: PSFs that no symmetry
// simplifies. Coma that does not lean, through all of `petzval image`: cli/test_optics_comatic.py.
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/imaging/exact_blur.h>
#include <petzval/imaging/product_blur.h>

#include <cstdio>
#include <numbers>

namespace petzval {
namespace {

using namespace testing;

constexpr int columns = 72, rows = 53;
constexpr double cell_um = 5;

/// Third-order coma by rays: the zone ρ of the pupil lands on a circle of radius A ρ² about t = 2A ρ²
/// (Welford, Aberrations of Optical Systems, 1986, §7.3), the flare 3A long, each ray blurred to a Gaussian
/// spot. \param lean_rad  by which the flare is turned from the tangential direction.
Psf coma(double a_um, double lean_rad) {
  constexpr int zones = 12, azimuths = 32, size = 97;
  constexpr double spot_um = 1.5, spacing_um = 1;
  std::vector<Spot> rays;
  for (int zone = 0; zone < zones; ++zone)
    for (int k = 0; k < azimuths; ++k) {
      const double square = (zone + 0.5) / zones, angle = 2 * std::numbers::pi * k / azimuths;
      const double t = a_um * square * (2 + std::cos(angle)), s = a_um * square * std::sin(angle);
      rays.push_back({s * std::cos(lean_rad) + t * std::sin(lean_rad),
                      t * std::cos(lean_rad) - s * std::sin(lean_rad), spot_um, spot_um, 1});
    }
  return psf_of_spots(rays, size, spacing_um);
}

TEST(ProductOfComa, KeepsTheToleranceAskedFor) {
  constexpr double lean_rad = 0.5;
  TableRecipe recipe;
  recipe.fields = {0, 2.5, 5, 7.5, 10, 12.5, 15, 17.5, 20};
  const double corner_mm = cell_um * std::hypot(columns, rows) / 2000;
  recipe.height_mm = [&](double field, double) {
    return corner_mm * std::tan(radians(field)) / std::tan(radians(20.0));
  };
  // The flare is 45 um long in the corners: nine cells.
  recipe.psf = [](double field, double) { return coma(15 * field / 20, lean_rad); };
  const LensDataTable table = make_table(recipe);
  const PsfField psfs(table, 550, cell_um, PsfInterpolation::psf, LightCentres(table));
  for (const CellPlane& source :
       {texture({columns, rows, cell_um}), tilted_checkerboard({columns, rows, cell_um})}) {
    const CellPlane exact = blur_exact(source, psfs, 0);
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
      const auto plan = plan_product(psfs, source.grid, {tolerance});
      ASSERT_TRUE(plan) << tolerance;
      const double error = relative_l2(ProductBlur(psfs, source.grid, *plan).blur(source, 0), exact);
      std::printf("leaning coma, tolerance %g: %d nodes, tiles of %d, estimated %.2e, measured %.2e\n",
                  tolerance, plan->nodes, plan->tile, plan->estimated_error, error);
      EXPECT_LE(error, tolerance);
    }
  }
}

}  // namespace
}  // namespace petzval
